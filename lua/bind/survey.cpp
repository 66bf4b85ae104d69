// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/io/image.hpp>
#include <aib/io/waypoints.hpp>
#include <aib/math/rotation.hpp>
#include <aib/mesh/distances.hpp>
#include <aib/raster/color.hpp>
#include <aib/stats/quantiles.hpp>
#include <aib/stream/noisy_image.hpp>
#include <aib/survey/facade.hpp>
#include <aib/survey/fly.hpp>
#include <aib/survey/linear.hpp>
#include <aib/survey/measure.hpp>
#include <aib/survey/orbit.hpp>
#include <aib/survey/perturb.hpp>
#include <aib/survey/sensor_noise.hpp>

#include "kit.hpp"
#include "views.hpp"
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace aib::bind {

namespace {

namespace fs = std::filesystem;
using survey::flight_path;

std::string print_path(const flight_path& p) {
  return message("flight_path(", std::round(1000 * p.length()) / 1000, " m, ", p.legs.size(),
                 " legs, ", p.n_rows, " rows)");
}

double angle_option(options& o, const char* name, double fallback_deg) {
  return math::radians(o.number(name, fallback_deg));
}

Eigen::Vector3d vector_option(options& o, const char* name) {
  return o.get<Eigen::Vector3d>(name).value_or(Eigen::Vector3d::Zero());
}

/// Three deviations, or one for all.
Eigen::Vector3d deviations_option(options& o, const char* name) {
  const auto numbers = o.numbers(name, {0});
  if (numbers.size() == 1) return Eigen::Vector3d::Constant(numbers[0]);
  if (numbers.size() != 3) o.reject(name, "a number or a list of 3 expected");
  return {numbers[0], numbers[1], numbers[2]};
}

survey::path_options path_options(options& o, double stand_off = 0) {
  survey::path_options p;
  if (const auto* camera = o.object<math::camera>("camera")) p.camera = *camera;
  p.overlap_across = o.number("overlap_across", p.overlap_across);
  const auto gsd_mm = o.get<double>("gsd_mm");
  const auto given = o.get<double>("stand_off");
  if (gsd_mm && given) o.reject("gsd_mm", "stand_off is given: one of the two expected");
  p.stand_off = gsd_mm ? *gsd_mm / 1000 * p.camera.fx() : given.value_or(stand_off);
  return p;
}

survey::footprint footprint_option(options& o) {
  const auto* m = o.object<mesh::mesh>("mesh");
  const auto corners = o.get<std::vector<Eigen::Vector2d>>("footprint");
  const auto names = o.get<std::vector<std::string>>("labels");
  if ((m != nullptr) == corners.has_value()) o.reject("footprint", "it or a mesh expected");
  survey::footprint plan;
  if (m) {
    plan = survey::footprint_of(
        *m, survey::labels_of(m->label_names, names.value_or(std::vector<std::string>())));
  } else {
    plan.corners = *corners;
    if (!o.has("low") || !o.has("high")) o.reject("low", "it and high expected for a footprint");
  }
  plan.low = o.number("low", plan.low);
  plan.high = o.number("high", plan.high);
  return plan;
}

flight_path facade(options& o) {
  const survey::footprint plan = footprint_option(o);
  survey::facade_options how{.path = path_options(o)};
  how.path.pitch = angle_option(o, "pitch", 0);
  if (const auto sides = o.get<std::vector<std::size_t>>("sides")) {
    if (sides->size() != 2 || sides->front() < 1 || sides->back() < 1)
      o.reject("sides", "{ first, last } expected, counted from 1");
    how.sides = survey::side_range{sides->front() - 1, sides->back() - 1};
  }
  o.done();
  return survey::facade(plan, how);
}

flight_path orbit(options& o) {
  survey::orbit_options how;
  how.radius = o.number("radius", 0);
  how.path = path_options(o, how.radius);
  how.path.pitch = angle_option(o, "pitch", 0);
  how.centre = o.get<Eigen::Vector2d>("centre").value_or(Eigen::Vector2d::Zero());
  how.low = o.number("low", 0);
  how.high = o.number("high", how.low);
  how.look_at = o.get<double>("look_at");
  if (how.look_at && o.has("pitch")) o.reject("pitch", "look_at is given: one of the two expected");
  how.start = angle_option(o, "start", 0);
  how.sweep = angle_option(o, "sweep", 360);
  o.done();
  return survey::orbit(how);
}

flight_path linear(options& o) {
  survey::linear_options how;
  how.path = path_options(o);
  how.path.pitch = angle_option(o, "pitch", 0);
  how.from = vector_option(o, "from");
  how.to = vector_option(o, "to");
  how.views = o.get<std::vector<Eigen::Vector3d>>("views").value_or(how.views);
  how.width = o.number("width", 0);
  how.radius = o.number("radius", 0);
  o.done();
  return survey::linear(how);
}

flight_path along(options& o) {
  using points = std::vector<Eigen::Vector3d>;
  const auto how = path_options(o);
  const auto at = o.get<points>("points").value_or(points());
  const auto views = o.get<points>("views").value_or(points());
  o.done();
  return survey::along(at, views, how);
}

/// Image names by a format as "%06d.png": one %d, with a width or none.
std::function<std::string(std::size_t)> name_option(options& o) {
  const std::string text = o.text("name", "%06d.png");
  const std::size_t sign = text.find('%');
  const std::size_t d = text.find_first_not_of("0123456789", sign + 1);
  const bool good = sign != std::string::npos && d != std::string::npos && text[d] == 'd' &&
                    d - sign <= 3 && text.find('%', d) == std::string::npos;
  if (!good) o.reject("name", message("a name with one %06d expected, found '", text, "'"));
  const std::string digits = text.substr(sign + 1, d - sign - 1);
  const std::size_t width = digits.empty() ? 0 : std::stoul(digits);
  return [before = text.substr(0, sign), behind = text.substr(d + 1), width](std::size_t i) {
    const std::string number = std::to_string(i);
    return before + std::string(width > number.size() ? width - number.size() : 0, '0') + number +
           behind;
  };
}

survey::fly_options fly_options(options& o) {
  using survey::aim_rule;
  using survey::clearance_rule;
  using survey::gimbal_rule;
  survey::fly_options f;
  f.frames = o.get<std::size_t>("frames");
  if (f.frames && o.has("overlap")) o.reject("frames", "overlap is given: one of the two expected");
  f.overlap = o.number("overlap", f.overlap);
  f.min_distance = o.number("min_distance", 0);
  f.clearance = o.choice("clearance", f.clearance,
                         {{"push", clearance_rule::push}, {"refuse", clearance_rule::refuse}});
  f.aim = o.choice("aim", f.aim, {{"path", aim_rule::path}, {"normal", aim_rule::normal}});
  f.speed = o.number("speed", f.speed);
  f.gimbal_rate = angle_option(o, "gimbal_rate", 60);
  f.gimbal = o.choice("gimbal", f.gimbal, {{"slow", gimbal_rule::slow}, {"lag", gimbal_rule::lag}});
  f.name = name_option(o);
  return f;
}

std::vector<double> in_degrees(std::vector<double> angles) {
  for (double& angle : angles) angle = math::degrees(angle);
  return angles;
}

record as_record(lua_State* state, survey::flight_plan plan) {
  camera_map cameras;
  for (const std::string& name : plan.trajectory.names) cameras.emplace(name, plan.camera);
  record r(state);
  r.set("camera", plan.camera).set("cameras", cameras).set("n_frames", plan.trajectory.size());
  r.set("step", plan.step).set("overlap", plan.overlap).set("length", plan.length);
  r.set("overlap_across", plan.overlap_across).set("duration", plan.duration_s);
  r.set("gsd_mm", 1000 * plan.gsd).set("n_pushed", plan.n_pushed);
  r.set("largest_push", plan.largest_push).set("n_gimbal_limited", plan.n_gimbal_limited);
  const auto lags = in_degrees(std::move(plan.view_lag));
  r.set("gimbal_delay", plan.gimbal_delay_s).set("view_lags", lags);
  r.set("largest_view_lag", *std::max_element(lags.begin(), lags.end()));
  if (plan.min_distance) {
    r.set("min_distance", *plan.min_distance);
    r.set("min_distance_frame", plan.trajectory.names[plan.min_distance_frame]);
  }
  return r.set("trajectory", std::move(plan.trajectory));
}

record fly(lua_State* state, session& s, const flight_path& path, options& o) {
  const auto how = fly_options(o);
  const auto mesh = o.get<sol::object>("mesh");
  o.done();
  if (!mesh || (how.min_distance == 0 && how.aim == survey::aim_rule::path))
    return as_record(state, survey::fly(path, how));
  const scene_argument scene(*mesh, "aib.survey.fly", s);
  const mesh::surface_index distance(scene->mesh, s.threads, s.control);
  const survey::flight_space space{distance, scene->surface};
  return as_record(state, survey::fly(path, how, &space));
}

template <class Values>
record spread_record(lua_State* state, const Values& values, std::initializer_list<double> shares) {
  std::vector<double> finite;
  for (const auto v : values)
    if (std::isfinite(v)) finite.push_back(static_cast<double>(v));
  record r(state);
  if (finite.empty()) return r;
  double sum = 0;
  for (const double v : finite) sum += v;
  r.set("mean", sum / static_cast<double>(finite.size()));
  for (const double q : shares) {
    const int percent = static_cast<int>(std::lround(100 * q));
    const std::string name = percent == 0     ? "min"
                             : percent == 50  ? "median"
                             : percent == 100 ? "max"
                                              : message(percent < 10 ? "p0" : "p", percent);
    r.set(name.c_str(), stats::quantile_in_place<double>(finite, q));
  }
  return r;
}

record as_record(lua_State* state, const survey::flight_report& report) {
  record r(state);
  std::vector<float> gsd_mm = report.gsd;
  for (float& g : gsd_mm) g *= 1000;
  const auto n_blind = std::count_if(report.overlap.begin(), report.overlap.end(),
                                     [](double o) { return std::isnan(o); });
  record overlap = spread_record(state, report.overlap, {0, 0.1, 0.5});
  overlap.set("n_pairs", report.overlap.size()).set("n_blind", n_blind);
  r.set("overlap", overlap).set("overlaps", report.overlap);
  r.set("gsd_mm", spread_record(state, gsd_mm, {0.05, 0.5, 0.95, 1}));
  const auto off_normals = in_degrees(report.off_normal);
  r.set("off_normal", spread_record(state, off_normals, {0.5, 0.95, 1}));
  r.set("off_normals", off_normals);
  r.set("hit_share", static_cast<double>(report.gsd.size()) / static_cast<double>(report.n_rays));
  sol::table coverage(state, sol::create), incidence(state, sol::create);
  for (const std::uint32_t n : {1u, 2u, 3u, 5u, 10u}) coverage[n] = report.seen_by(n);
  for (const int deg : {15, 30, 45, 60, 75})
    incidence[deg] = report.seen_within(math::radians(static_cast<double>(deg)));
  cloud::cloud unseen;
  if (!report.samples.empty())
    unseen.origin = cloud::natural_origin(report.samples.front().position);
  double views = 0;
  for (const survey::seen_sample& s : report.samples) {
    views += s.n_views;
    if (s.n_views == 0) unseen.points.push_back((s.position - unseen.origin).cast<float>());
  }
  r.set("coverage", coverage).set("incidence", incidence).set("area", report.area);
  r.set("unseen_area", report.area * (1 - report.seen_by(1)));
  r.set("n_views_mean", views / static_cast<double>(report.samples.size()));
  return r.set("unseen", std::move(unseen));
}

record measure(lua_State* state,
               session& s,
               const pose::trajectory& t,
               const sol::object& cameras,
               const sol::object& mesh,
               options& o) {
  constexpr const char* function = "aib.survey.measure";
  const scene_argument scene(mesh, function, s);
  survey::measure_options how;
  const auto names = o.get<std::vector<std::string>>("labels");
  if (names) how.labels = survey::labels_of(scene->mesh.label_names, *names);
  how.samples = o.count("samples", how.samples);
  how.columns = o.count("columns", how.columns);
  how.rows = o.count("rows", how.rows);
  how.max_incidence = angle_option(o, "max_incidence", 75);
  how.max_distance = o.number("max_distance", how.max_distance);
  how.tolerance = o.number("tolerance", how.tolerance);
  how.seed = static_cast<std::uint64_t>(o.integer("seed", 1));
  how.threads = s.threads;
  how.control = s.control;
  o.done();
  return as_record(
      state, survey::measure(views_of(cameras, t, function), scene->mesh, scene->surface, how));
}

survey::sensor_noise_options noise_options(options& o, const session& s) {
  survey::sensor_noise_options n;
  n.a = o.number("a", n.a);
  n.b = o.number("b", n.b);
  n.seed = static_cast<std::uint64_t>(o.integer("seed", 1));
  n.frame = static_cast<std::uint64_t>(o.integer("frame", 0));
  using survey::transfer;
  n.transfer =
      o.choice("transfer", n.transfer, {{"srgb", transfer::srgb}, {"linear", transfer::linear}});
  n.threads = s.threads;
  n.control = s.control;
  o.done();
  return n;
}

survey::perturb_options perturb_options(options& o) {
  survey::perturb_options p;
  p.seed = static_cast<std::uint64_t>(o.integer("seed", 1));
  p.position_noise = deviations_option(o, "position_noise");
  p.position_walk = o.number("position_walk", 0);
  p.position_bias = vector_option(o, "position_bias");
  p.yaw_bias = angle_option(o, "yaw_bias", 0);
  p.yaw_noise = angle_option(o, "yaw_noise", 0);
  p.gimbal_bias = vector_option(o, "gimbal_bias") / math::degrees_per_radian;
  p.gimbal_noise = deviations_option(o, "gimbal_noise") / math::degrees_per_radian;
  p.lever_arm = vector_option(o, "lever_arm");
  p.time_offset = o.number("time_offset", 0);
  p.dropout = o.number("dropout", 0);
  p.dropout_length = o.number("dropout_length", 1);
  o.done();
  return p;
}

camera_map perturb_cameras(const math::camera& camera,
                           const std::vector<std::string>& names,
                           options& o) {
  survey::intrinsics_drift d;
  d.seed = static_cast<std::uint64_t>(o.integer("seed", 1));
  d.focal_bias = o.number("focal_bias", 0);
  d.focal_noise = o.number("focal_noise", 0);
  d.focal_walk = o.number("focal_walk", 0);
  d.centre_noise = o.number("centre_noise", 0);
  d.centre_walk = o.number("centre_walk", 0);
  o.done();
  const auto cameras = survey::perturb_camera(camera, names.size(), d);
  camera_map by_name;
  for (std::size_t i = 0; i < names.size(); ++i) by_name.insert_or_assign(names[i], cameras[i]);
  return by_name;
}

void bind_paths(lua_State* state) {
  type<flight_path>(state, "flight_path", print_path)
      .field("length", [](const flight_path& p) { return p.length(); })
      .field("stand_off", [](const flight_path& p) { return p.stand_off; })
      .field("camera", [](const flight_path& p) { return p.camera; })
      .field("overlap_across", [](const flight_path& p) { return p.overlap_across; })
      .field("n_rows", [](const flight_path& p) { return p.n_rows; })
      .method("at", {"share"}, [](const flight_path& p, double share) { return p.at(share); })
      .method("reversed", {}, [](const flight_path& p) { return p.reversed(); });
  module(state, "survey")
      .function("camera", {"options"},
                [](options& o) {
                  survey::lens l;
                  l.focal_mm = o.number("focal_mm", l.focal_mm);
                  l.sensor_mm = o.number("sensor_mm", l.sensor_mm);
                  l.width = o.count("width", l.width);
                  l.height = o.count("height", l.height);
                  o.done();
                  return survey::camera_of(l);
                })
      .function("facade", {"options"}, [](options& o) { return facade(o); })
      .function("orbit", {"options"}, [](options& o) { return orbit(o); })
      .function("linear", {"options"}, [](options& o) { return linear(o); })
      .function("along", {"options"}, [](options& o) { return along(o); })
      .function("join", {"paths"},
                [](const std::vector<flight_path>& paths) { return survey::join(paths); })
      .function("fly", {"path", "options"},
                [](lua_State* l, session& s, const flight_path& path, options& o) {
                  return fly(l, s, path, o);
                })
      .function(
          "measure", {"trajectory", "camera", "mesh", "options"},
          [](lua_State* l, session& s, const pose::trajectory& t, const sol::object& cameras,
             const sol::object& mesh, options& o) { return measure(l, s, t, cameras, mesh, o); });
}

}  // namespace

void bind_survey(lua_State* state) {
  bind_paths(state);
  module(state, "survey")
      .function("sensor_noise", {"image", "options"},
                [](session& s, const raster::color_image& image, options& o) {
                  return survey::sensor_noise<raster::rgb>(image, noise_options(o, s));
                })
      .function("sensor_noise_file", {"from", "to", "options"},
                [](session& s, const fs::path& from, const fs::path& to, options& o) {
                  stream::noisy_image(from, to, noise_options(o, s));
                })
      .function("perturb", {"trajectory", "options"},
                [](const pose::trajectory& t, options& o) {
                  return survey::perturb(t, perturb_options(o));
                })
      .function("perturb_cameras", {"camera", "names", "options"},
                [](const math::camera& camera, const std::vector<std::string>& names, options& o) {
                  return perturb_cameras(camera, names, o);
                });
  module(state, "io")
      .function(
          "write_waypoints", {"path", "trajectory", "options"},
          [](const fs::path& path, const pose::trajectory& t, options& o) {
            const auto origin = o.get<Eigen::Vector3d>("origin");
            if (!origin)
              o.reject("origin", "{ latitude, longitude, altitude } of 0, 0, 0 expected");
            const io::waypoint_options how{
                .origin = {math::radians(origin->x()), math::radians(origin->y()), origin->z()},
                .speed = o.number("speed", 2)};
            o.done();
            io::write_waypoints(path, t, how);
          });
}

}  // namespace aib::bind
