// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/align/batches.hpp>
#include <aib/align/icp.hpp>
#include <aib/align/trajectory.hpp>
#include <aib/align/umeyama.hpp>

#include "kit.hpp"
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace aib::bind {

namespace {

using align::rank_rule;

rank_rule rank_option(options& o) {
  return o.choice("convention", rank_rule::relative,
                  {{"relative", rank_rule::relative}, {"evo", rank_rule::evo}});
}

/// `robust = true`, or a table of its own options.
std::optional<align::ransac_options> robust_options(options& o) {
  align::ransac_options r;
  const bool asked = o.flag("robust", false);
  r.distance = o.number("robust_distance", r.distance);
  r.iterations = o.count("robust_iterations", r.iterations);
  r.seed = o.count("seed", r.seed);
  if (!asked) return std::nullopt;
  return r;
}

align::trajectory_options trajectory_options(options& o) {
  using align::align_mode;
  align::trajectory_options t;
  t.fit.mode = o.choice("mode", t.fit.mode,
                        {{"sim3", align_mode::sim3},
                         {"se3", align_mode::se3},
                         {"yaw", align_mode::yaw},
                         {"yaw_scale", align_mode::yaw_scale},
                         {"scale", align_mode::scale},
                         {"first", align_mode::first}});
  t.fit.rotation_weight = o.number("rotation_weight", 0);
  t.fit.up = o.get<Eigen::Vector3d>("up").value_or(t.fit.up);
  t.fit.convention = rank_option(o);
  t.n = o.count("n", 0);
  t.outliers.factor = o.get<double>("outlier_factor");
  t.outliers.distance = o.get<double>("outlier_distance");
  t.robust = robust_options(o);
  t.stand_off = o.number("stand_off", t.stand_off);
  return t;
}

/// The positions of a trajectory, or the points themselves.
std::vector<Eigen::Vector3d> points_of(const sol::object& object, const char* argument) {
  if (const auto* t = get_if<pose::trajectory>(object)) return positions(*t);
  if (auto points = read_if<std::vector<Eigen::Vector3d>>(object)) return std::move(*points);
  throw argument_error(message("aib.align.umeyama: argument ", argument,
                               ": trajectory or list of points {x, y, z} expected"));
}

record as_record(lua_State* state, const align::alignment& a) {
  record r(state);
  r.set("transform", a.transform).set("n_inliers", a.n_inliers);
  r.set("outliers", one_based(a.outliers)).set("rmse", a.rmse).set("half_rmse", a.half_rmse);
  r.set("condition", a.condition).set("warnings", a.warnings);
  if (a.turn) r.set("turn_deg", a.turn->deg).set("turn_error", a.turn->error);
  return r;
}

/// What `trajectory` gives, with the frames and what is told of batches alone; `degenerate` says
/// why there is no transform.
record as_record(lua_State* state, const align::batch_alignment& b) {
  record r = b.fit ? as_record(state, *b.fit) : record(state);
  r.set("frames", one_based(b.frames)).set("missing", b.missing).set("seam", b.seam);
  if (!b.frames.empty()) r.set("first", b.frames.front() + 1).set("last", b.frames.back() + 1);
  if (!b.fit) r.set("degenerate", b.degenerate);
  return r;
}

align::batches_options batches_options(options& o) {
  align::batches_options b;
  b.size = o.count("size", b.size);
  b.sizes = o.get<std::vector<std::size_t>>("sizes").value_or(b.sizes);
  b.names = o.get<std::vector<std::vector<std::string>>>("names").value_or(b.names);
  b.frames = o.get<std::vector<std::vector<std::size_t>>>("frames").value_or(b.frames);
  for (auto& batch : b.frames) {
    for (std::size_t& i : batch) {
      if (i == 0) o.reject("frames", "frames from 1 on expected, found 0");
      --i;
    }
  }
  b.align = trajectory_options(o);
  return b;
}

align::icp_options icp_options(options& o, const session& s) {
  using align::icp_metric;
  align::icp_options i;
  i.max_distance = o.numbers("max_distance", {});
  i.metric =
      o.choice("metric", i.metric, {{"point", icp_metric::point}, {"plane", icp_metric::plane}});
  i.with_scale = o.flag("with_scale", i.with_scale);
  if (const auto* init = o.object<math::sim3>("init")) i.init = *init;
  i.max_iterations = o.count("max_iterations", i.max_iterations);
  i.relative_change = o.number("relative_change", i.relative_change);
  i.threads = s.threads;
  i.control = s.control;
  return i;
}

record as_record(lua_State* state, const align::icp_result& i) {
  record r(state);
  r.set("transform", i.transform).set("rmse", i.rmse).set("fitness", i.fitness);
  r.set("converged", i.converged).set("n_pairs", i.n_pairs);
  return r.set("n_iterations", i.n_iterations);
}

}  // namespace

void bind_align(lua_State* state) {
  module(state, "align")
      .function("icp", {"est", "ref", "options"},
                [](lua_State* l, session& s, const cloud::cloud& est, const cloud::cloud& ref,
                   options& o) {
                  const auto how = icp_options(o, s);
                  o.done();
                  return as_record(l, align::icp(est, ref, how));
                })
      .function("umeyama", {"est", "ref", "options"},
                [](const sol::object& est, const sol::object& ref, options& o) {
                  const align::umeyama_options u{o.flag("scale", true), rank_option(o)};
                  o.done();
                  const auto x = points_of(est, "1 (est)"), y = points_of(ref, "2 (ref)");
                  return align::umeyama(x, y, u);
                })
      .function(
          "trajectory", {"est", "ref", "options"},
          [](lua_State* l, const pose::trajectory& est, const pose::trajectory& ref, options& o) {
            const align::trajectory_options t = trajectory_options(o);
            o.done();
            return as_record(l, align::trajectory(est, ref, t));
          })
      .function(
          "batches", {"est", "ref", "options"},
          [](lua_State* l, const pose::trajectory& est, const pose::trajectory& ref, options& o) {
            const align::batches_options b = batches_options(o);
            o.done();
            const auto batches = align::batches(est, ref, b);
            std::vector<record> list;
            for (const auto& batch : batches) list.push_back(as_record(l, batch));
            return results(std::move(list), transformed(batches, est));
          });
}

}  // namespace aib::bind
