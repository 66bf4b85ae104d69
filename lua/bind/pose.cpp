// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/pose/ape.hpp>
#include <aib/pose/associate.hpp>
#include <aib/pose/auc.hpp>
#include <aib/pose/auc_breakdown.hpp>
#include <aib/pose/focal.hpp>
#include <aib/pose/intrinsics.hpp>
#include <aib/pose/kitti_odometry.hpp>
#include <aib/pose/pair_histogram.hpp>
#include <aib/pose/registration.hpp>
#include <aib/pose/relative_angles.hpp>
#include <aib/pose/rpe.hpp>
#include <aib/pose/sub_trajectory.hpp>
#include <aib/pose/trajectory.hpp>
#include <aib/pose/worst_pairs.hpp>

#include "camera.hpp"
#include "kit.hpp"
#include "stats.hpp"
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace aib::bind {

namespace {

using pose::trajectory;

std::string print_trajectory(const trajectory& t) {
  const auto posed = std::count_if(t.world_from_camera.begin(), t.world_from_camera.end(),
                                   [](const math::rigid3& p) { return p.is_finite(); });
  std::string text = message("trajectory(", t.size(), " poses");
  if (static_cast<std::size_t>(posed) < t.size()) text += message(", ", posed, " registered");
  if (!t.names.empty()) text += message(", names ", t.names.front(), " .. ", t.names.back());
  if (!t.stamps_s.empty())
    text += message(", stamps ", t.stamps_s.front(), " .. ", t.stamps_s.back(), " s");
  return text + ")";
}

std::size_t bytes_of_trajectory(const trajectory& t) {
  std::size_t bytes = t.size() * sizeof(math::rigid3) + t.stamps_s.size() * sizeof(double);
  for (const std::string& name : t.names) bytes += sizeof(name) + name.capacity();
  return bytes;
}

/// Rules of names, for functions that compare them.
void read_name_rules(options& o, pose::associate_options& rules) {
  rules.ignore_case = o.flag("ignore_case", false);
  rules.ignore_extension = o.flag("ignore_extension", false);
  rules.ignore_folder = o.flag("ignore_folder", false);
}

pose::associate_options association_options(options& o) {
  using pose::association_rule;
  using pose::match_by;
  pose::associate_options a;
  a.by =
      o.choice("by", a.by,
               {{"name", match_by::name}, {"stamp", match_by::stamp}, {"index", match_by::index}});
  a.max_gap_s = o.number("max_gap", a.max_gap_s);
  a.offset_s = o.number("offset", a.offset_s);
  a.rule = o.choice("convention", a.rule,
                    {{"one_to_one", association_rule::one_to_one}, {"evo", association_rule::evo}});
  read_name_rules(o, a);
  o.done();
  return a;
}

pose::pose_relation relation_option(options& o) {
  using enum pose::pose_relation;
  return o.choice("relation", translation,
                  {{"translation", translation},
                   {"rotation_part", rotation_part},
                   {"full", full},
                   {"angle_deg", angle_deg},
                   {"angle_rad", angle_rad},
                   {"point_distance", point_distance},
                   {"point_distance_ratio", point_distance_ratio}});
}

pose::auc_convention convention_option(options& o) {
  using enum pose::auc_convention;
  return o.choice("convention", paper,
                  {{"paper", paper},
                   {"vggt", vggt},
                   {"posediffusion", posediffusion},
                   {"pi3", posediffusion},
                   {"posediffusion_torch", posediffusion_torch},
                   {"da3", da3},
                   {"colmap", colmap},
                   {"exact", exact}});
}

unsigned degrees_option(options& o) {
  const std::size_t max_deg = o.count("max_deg", 30);
  if (max_deg < 1 || max_deg > 180) o.reject("max_deg", "1..180 expected");
  return static_cast<unsigned>(max_deg);
}

record as_record(lua_State* state, const pose::pose_errors& e) {
  return bind::as_record(state, e.summary).set("errors", e.errors).set("index", one_based(e.index));
}

pose::auc_options read_auc_options(options& o, const session& s) {
  pose::auc_options a;
  a.max_deg = degrees_option(o);
  a.convention = convention_option(o);
  a.position_accuracy = o.number("position_accuracy", a.position_accuracy);
  a.threads = s.threads;
  a.control = s.control;
  return a;
}

std::vector<double> degrees_up_to(std::size_t n) {
  std::vector<double> out(n);
  std::iota(out.begin(), out.end(), 1.0);
  return out;
}

record as_record(lua_State* state, const pose::auc_result& a) {
  const std::vector<double> tau = degrees_up_to(a.max_deg);
  record r(state);
  r.set("auc", a.auc).set("auc_signed", a.auc_signed).set("convention", name(a.convention));
  r.set("max_deg", a.max_deg).set("n_pairs", a.n_pairs);
  r.set("n_zero_baseline", a.n_zero_baseline).set("n_unregistered", a.n_unregistered);
  return r.set("rra", keyed(state, tau, a.rra)).set("rta", keyed(state, tau, a.rta));
}

/// auc, auc_signed, rra and rta are nil where no pair has a direction.
record as_record(lua_State* state, const pose::partial_auc& p) {
  record r(state);
  r.set("n_pairs", p.n_pairs).set("n_zero_baseline", p.n_zero_baseline);
  if (!p.value) return r;
  const std::vector<double> tau = degrees_up_to(p.value->rra.size());
  r.set("auc", p.value->auc).set("auc_signed", p.value->auc_signed);
  return r.set("rra", keyed(state, tau, p.value->rra)).set("rta", keyed(state, tau, p.value->rta));
}

record as_record(lua_State* state, const pose::segment_errors& e) {
  record r(state);
  r.set("translation_percent", e.translation_percent);
  return r.set("rotation_deg_per_m", e.rotation_deg_per_m).set("n", e.n);
}

record as_record(lua_State* state, const pose::sub_trajectory_errors& e) {
  record r(state);
  r.set("length", e.length).set("translation", bind::as_record(state, e.translation));
  r.set("translation_percent", bind::as_record(state, e.translation_percent));
  r.set("rotation_deg", bind::as_record(state, e.rotation_deg));
  r.set("rotation_deg_per_m", bind::as_record(state, e.rotation_deg_per_m));
  r.set("yaw_deg", bind::as_record(state, e.yaw_deg));
  return r.set("gravity_deg", bind::as_record(state, e.gravity_deg));
}

record as_record(lua_State* state, const pose::worst_pair& w) {
  record r(state);
  r.set("first", w.first).set("second", w.second).set("rotation_deg", w.rotation_deg);
  return r.set("translation_deg", w.translation_deg);
}

std::vector<pose::gap_range> gap_ranges(const std::vector<std::vector<std::size_t>>& gaps) {
  std::vector<pose::gap_range> out;
  for (const auto& g : gaps) {
    if (g.size() != 2)
      throw argument_error(
          "aib.pose.auc_by_gap: argument 3 (gaps): list of {first, last} expected");
    out.push_back({g[0], g[1]});
  }
  return out;
}

record as_record(lua_State* state, const pose::registration& g) {
  record r(state);
  r.set("rate", g.rate).set("n_registered", g.n_registered).set("n_total", g.n_total);
  return r.set("missing", g.missing);
}

/// Views with a camera on both sides, in the order of their names.
struct named_views {
  std::vector<std::string> names = {};
  std::vector<pose::camera_pair> pairs = {};

  void add(const std::string& name, const math::camera& estimate, const math::camera& reference) {
    names.push_back(name);
    pairs.push_back({estimate, reference});
  }
};

record by_name(lua_State* state,
               const std::vector<std::string>& names,
               const std::vector<double>& values) {
  record out(state);
  for (std::size_t i = 0; i < names.size(); ++i) out.set(names[i].c_str(), values[i]);
  return out;
}

named_views paired_views(const camera_map& cameras, const camera_map& reference) {
  named_views views;
  for (const auto& [name, camera] : cameras) {
    const auto at = reference.find(name);
    if (at != reference.end()) views.add(name, camera, at->second);
  }
  return views;
}

/// The same; a number is the focal length of every reference camera.
named_views paired_views(const camera_map& cameras, const sol::object& reference) {
  if (const auto known = read_if<camera_map>(reference)) return paired_views(cameras, *known);
  const auto focal = read_if<double>(reference);
  if (!focal || !(*focal > 0)) {
    throw argument_error(
        "aib.pose.focal_error: argument 2 (ref): table of cameras by image name, or a focal length "
        "in pixels, expected");
  }
  named_views views;
  for (const auto& [name, camera] : cameras)
    views.add(name, camera, math::pinhole(camera.width, camera.height, *focal, *focal, 0, 0));
  return views;
}

double path_length(const trajectory& t) {
  return t.empty() ? 0.0 : pose::path_lengths(t.world_from_camera).back();
}

/// Box of the centres, number of the registered poses, length of the path.
record summary_of(lua_State* state, const trajectory& t) {
  record r(state);
  Eigen::Array3d low = Eigen::Array3d::Constant(HUGE_VAL), high = -low;
  std::size_t n_registered = 0;
  for (const math::rigid3& p : t.world_from_camera) {
    if (!p.is_finite()) continue;
    ++n_registered;
    low = low.min(p.translation.array());
    high = high.max(p.translation.array());
  }
  r.set("n", t.size()).set("n_registered", n_registered).set("path_length", path_length(t));
  if (n_registered > 0) r.set("min", Eigen::Vector3d(low)).set("max", Eigen::Vector3d(high));
  if (t.stamps_s.empty()) return r;
  return r.set("first_stamp", t.stamps_s.front()).set("last_stamp", t.stamps_s.back());
}

void bind_trajectory(lua_State* state) {
  type<trajectory>(state, "trajectory", print_trajectory, bytes_of_trajectory)
      .length([](const trajectory& t) { return t.size(); })
      .element([](const trajectory& t, std::size_t i) { return t.world_from_camera[i]; })
      .field("names", [](const trajectory& t) { return t.names; })
      .field("stamps", [](const trajectory& t) { return t.stamps_s; })
      .field("warnings", [](const trajectory& t) { return t.warnings; })
      .method("positions", {}, [](const trajectory& t) { return positions(t); })
      .method("path_length", {}, [](const trajectory& t) { return path_length(t); })
      .method("summary", {}, [](lua_State* l, const trajectory& t) { return summary_of(l, t); })
      .method("select", {"indices"},
              [](const trajectory& t, std::vector<std::size_t> indices) {
                for (std::size_t& i : indices) {
                  if (i == 0 || i > t.size()) {
                    throw argument_error(message("trajectory:select: indices 1..", t.size(),
                                                 " expected, found ", i));
                  }
                  --i;
                }
                return select(t, indices);
              })
      .method("transformed", {"transform"},
              [](const trajectory& t, const math::sim3& b_from_a) { return b_from_a * t; });
}

void bind_association(module& m) {
  m.function("trajectory", {"poses", "options"},
             [](const std::vector<math::rigid3>& poses, options& o) {
               trajectory t{poses,
                            o.get<std::vector<std::string>>("names").value_or(trajectory{}.names),
                            o.get<std::vector<double>>("stamps").value_or(trajectory{}.stamps_s),
                            {}};
               o.done();
               check(t);
               return t;
             })
      .function("associate", {"est", "ref", "options"},
                [](lua_State* l, const trajectory& est, const trajectory& ref, options& o) {
                  pose::association a = associate(est, ref, association_options(o));
                  record info(l);
                  info.set("n_matched", a.n_matched).set("n_estimate_only", a.n_estimate_only);
                  info.set("n_reference_only", a.n_reference_only);
                  info.set("estimate_index", one_based(a.estimate_index));
                  info.set("reference_index", one_based(a.reference_index));
                  return results(std::move(a.estimate), std::move(a.reference), std::move(info));
                })
      .function("registration_rate", {"est", "ref", "options"},
                [](lua_State* l, const sol::object& est, const trajectory& ref, options& o) {
                  pose::associate_options rules;
                  read_name_rules(o, rules);
                  o.done();
                  if (const auto* one = get_if<trajectory>(est))
                    return as_record(l, pose::registration_rate(*one, ref, rules));
                  if (const auto several = read_if<std::vector<trajectory>>(est))
                    return as_record(l, pose::registration_rate(*several, ref, rules));
                  throw argument_error(
                      "aib.pose.registration_rate: argument 1 (est): trajectory or list of "
                      "trajectories expected");
                });
}

void bind_errors(module& m) {
  m.function("ape", {"est", "ref", "options"},
             [](lua_State* l, const trajectory& est, const trajectory& ref, options& o) {
               const pose::ape_options a{relation_option(o)};
               o.done();
               return as_record(l, pose::ape(est, ref, a));
             })
      .function("rpe", {"est", "ref", "options"},
                [](lua_State* l, const trajectory& est, const trajectory& ref, options& o) {
                  using pose::delta_unit;
                  using pose::pairs_from;
                  pose::rpe_options r;
                  r.relation = relation_option(o);
                  r.pairs.delta = o.number("delta", r.pairs.delta);
                  r.pairs.unit = o.choice("unit", r.pairs.unit,
                                          {{"frames", delta_unit::frames},
                                           {"m", delta_unit::m},
                                           {"deg", delta_unit::deg},
                                           {"rad", delta_unit::rad}});
                  r.pairs.all_pairs = o.flag("all_pairs", r.pairs.all_pairs);
                  r.pairs.tolerance = o.number("tolerance", r.pairs.tolerance);
                  r.from = o.choice(
                      "pairs_from", r.from,
                      {{"estimate", pairs_from::estimate}, {"reference", pairs_from::reference}});
                  o.done();
                  return as_record(l, pose::rpe(est, ref, r));
                })
      .function(
          "relative_angles", {"est", "ref", "options"},
          [](lua_State* l, session& s, const trajectory& est, const trajectory& ref, options& o) {
            pose::relative_angles_options a;
            a.tau_deg = o.numbers("tau", a.tau_deg);
            a.threads = s.threads;
            a.control = s.control;
            o.done();
            const auto r = pose::relative_angles(est, ref, a);
            record out(l);
            out.set("rra", keyed(l, r.tau_deg, r.rra)).set("rta", keyed(l, r.tau_deg, r.rta));
            out.set("n_pairs", r.n_pairs).set("n_zero_baseline", r.n_zero_baseline);
            return out.set("n_unregistered", r.n_unregistered);
          })
      .function(
          "auc", {"est", "ref", "options"},
          [](lua_State* l, session& s, const trajectory& est, const trajectory& ref, options& o) {
            const pose::auc_options a = read_auc_options(o, s);
            o.done();
            return as_record(l, pose::auc(est, ref, a));
          });
}

record as_record(lua_State* state, const pose::pair_histogram_result& h) {
  record r(state);
  r.set("rotation", h.rotation_deg).set("translation", h.translation_deg);
  r.set("counts", h.counts).set("without_direction", h.without_direction);
  r.set("n_pairs", h.n_pairs).set("n_zero_baseline", h.n_zero_baseline);
  return r.set("n_unregistered", h.n_unregistered);
}

void bind_breakdown(module& m) {
  m.function("auc_by_batch", {"est", "ref", "batch", "options"},
             [](lua_State* l, session& s, const trajectory& est, const trajectory& ref,
                const std::vector<std::size_t>& batch, options& o) {
               const pose::auc_options a = read_auc_options(o, s);
               o.done();
               const auto r = pose::auc_by_batch(est, ref, batch, a);
               record out(l);
               out.set("intra", as_record(l, r.intra)).set("cross", as_record(l, r.cross));
               return out;
             })
      .function(
          "auc_by_gap", {"est", "ref", "gaps", "options"},
          [](lua_State* l, session& s, const trajectory& est, const trajectory& ref,
             const std::vector<std::vector<std::size_t>>& gaps, options& o) {
            const pose::auc_options a = read_auc_options(o, s);
            o.done();
            std::vector<record> out;
            for (const auto& r : pose::auc_by_gap(est, ref, gap_ranges(gaps), a))
              out.push_back(as_record(l, r.part).set("first", r.gap.first).set("last", r.gap.last));
            return out;
          })
      .function(
          "pair_histogram", {"est", "ref", "options"},
          [](lua_State* l, session& s, const trajectory& est, const trajectory& ref, options& o) {
            pose::pair_histogram_options h;
            h.rotation_deg = o.numbers("rotation", h.rotation_deg);
            h.translation_deg = o.numbers("translation", h.translation_deg);
            h.threads = s.threads;
            h.control = s.control;
            o.done();
            return as_record(l, pose::pair_histogram(est, ref, h));
          })
      .function(
          "worst_pairs", {"est", "ref", "options"},
          [](lua_State* l, session& s, const trajectory& est, const trajectory& ref, options& o) {
            const pose::worst_pairs_options w{o.count("n", 10), s.threads, s.control};
            o.done();
            std::vector<record> out;
            for (const auto& pair : pose::worst_pairs(est, ref, w))
              out.push_back(as_record(l, pair));
            return out;
          });
}

void bind_odometry(module& m) {
  m.function("kitti_odometry", {"est", "ref", "options"},
             [](lua_State* l, const trajectory& est, const trajectory& ref, options& o) {
               pose::kitti_odometry_options k;
               k.lengths_m = o.numbers("lengths", k.lengths_m);
               k.step = o.count("step", k.step);
               o.done();
               const auto r = pose::kitti_odometry(est, ref, k);
               std::vector<record> by_length;
               for (std::size_t i = 0; i < r.lengths_m.size(); ++i)
                 by_length.push_back(as_record(l, r.by_length[i]).set("length", r.lengths_m[i]));
               return as_record(l, r.all).set("by_length", by_length);
             })
      .function("sub_trajectories", {"est", "ref", "options"},
                [](lua_State* l, const trajectory& est, const trajectory& ref, options& o) {
                  pose::sub_trajectory_options s;
                  s.lengths = o.numbers("lengths", {});
                  s.tolerance = o.number("tolerance", s.tolerance);
                  o.done();
                  std::vector<record> out;
                  for (const auto& e : pose::sub_trajectories(est, ref, s))
                    out.push_back(as_record(l, e));
                  return out;
                });
}

void bind_intrinsics(module& m) {
  m.function("focal_error", {"cameras", "ref", "options"},
             [](lua_State* l, const camera_map& cameras, const sol::object& ref, options& o) {
               using pose::focal_over;
               const focal_over over =
                   o.choice("over", focal_over::views,
                            {{"views", focal_over::views}, {"cameras", focal_over::cameras}});
               o.done();
               const named_views views = paired_views(cameras, ref);
               const auto r = pose::focal_error(views.pairs, over);
               record out(l);
               out.set("mre", r.mre).set("n", r.n);
               if (over == focal_over::views) out.set("each", by_name(l, views.names, r.each));
               return out;
             })
      .function("intrinsics_error", {"cameras", "ref"},
                [](lua_State* l, const camera_map& cameras, const camera_map& ref) {
                  const auto r = pose::intrinsics_error(paired_views(cameras, ref).pairs);
                  record out(l);
                  out.set("focal_mre", r.focal.mre).set("focal_spread", r.focal_spread);
                  out.set("principal_point_px", r.principal_point_px).set("n", r.focal.n);
                  out.set("reprojection_px", r.reprojection_px);
                  out.set("reprojection_max_px", r.reprojection_max_px);
                  return out;
                })
      .function("reprojection_difference", {"est", "ref"},
                [](lua_State* l, const math::camera& est, const math::camera& ref) {
                  const auto r = pose::reprojection_difference(est, ref);
                  record out(l);
                  out.set("mean", r.mean).set("max", r.max).set("n", r.n).set("n_lost", r.n_lost);
                  return out;
                });
}

}  // namespace

void bind_pose(lua_State* state) {
  bind_trajectory(state);
  module m(state, "pose");
  bind_association(m);
  bind_errors(m);
  bind_breakdown(m);
  bind_odometry(m);
  bind_intrinsics(m);
}

}  // namespace aib::bind
