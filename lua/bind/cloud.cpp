// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include "cloud.hpp"

#include <aib/cloud/cloud.hpp>
#include <aib/cloud/compare.hpp>
#include <aib/cloud/crop.hpp>
#include <aib/cloud/distances.hpp>
#include <aib/cloud/join.hpp>
#include <aib/cloud/normals.hpp>
#include <aib/cloud/outliers.hpp>
#include <aib/cloud/positions.hpp>
#include <aib/cloud/transform.hpp>
#include <aib/io/npy.hpp>
#include <aib/stats/histogram.hpp>

#include "kit.hpp"
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace aib::bind {

using cloud::comparison;
using cloud::distances;

std::string grouped(std::size_t n) {
  std::string digits = std::to_string(n);
  for (std::size_t i = digits.size(); i > 3; i -= 3) digits.insert(i - 3, 1, ' ');
  return digits;
}

std::string extent_text(const cloud::box& box) {
  if (box.empty()) return "";
  const auto metres = [](double length) {
    char text[32];
    const auto end =
        std::to_chars(text, text + sizeof text, length, std::chars_format::fixed, 1).ptr;
    return std::string(text, end);
  };
  const Eigen::Vector3d size = box.size().cwiseMin(1e12);
  return message(", bbox ", metres(size.x()), " x ", metres(size.y()), " x ", metres(size.z()),
                 " m");
}

record as_record(lua_State* state, const cloud::box& box) {
  record r(state);
  if (!box.empty()) r.set("min", box.low).set("max", box.high);
  return r;
}

threshold_columns::threshold_columns(const std::vector<cloud::threshold_scores>& scores) {
  for (const auto& s : scores) {
    tau.push_back(s.tau);
    precision.push_back(s.precision);
    recall.push_back(s.recall);
    f_score.push_back(s.f_score);
  }
}

record as_record(lua_State* state, const comparison& c) {
  const threshold_columns at(c.scores);
  record r(state);
  r.set("accuracy", c.accuracy).set("completeness", c.completeness);
  r.set("chamfer", c.chamfer).set("chamfer_mean", c.chamfer_mean);
  r.set("f1_distance", c.f1_distance).set("hausdorff", c.hausdorff);
  r.set("accuracy_median", c.accuracy_median).set("completeness_median", c.completeness_median);
  r.set("accuracy_rmse", c.accuracy_rmse).set("completeness_rmse", c.completeness_rmse);
  r.set("precision", keyed(state, at.tau, at.precision));
  r.set("recall", keyed(state, at.tau, at.recall)).set("f_score", keyed(state, at.tau, at.f_score));
  r.set("n_estimate", c.n_estimate).set("n_reference", c.n_reference);
  r.set("n_dropped", c.n_dropped);
  r.set("estimate_beyond", c.estimate_beyond).set("reference_beyond", c.reference_beyond);
  return r;
}

cloud::distance_options distance_options(options& o, const session& s) {
  using enum cloud::maximum_rule;
  return {.max_distance = o.get<double>("max_distance"),
          .rule = o.choice("rule", drop, {{"drop", drop}, {"clamp", clamp}}),
          .threads = s.threads,
          .control = s.control};
}

namespace {

std::string print_cloud(const cloud::cloud& c) {
  return message("cloud(", grouped(c.size()), " points", c.normals.empty() ? "" : ", normals",
                 c.colors.empty() ? "" : ", colors", c.labels.empty() ? "" : ", labels",
                 extent_text(cloud::bounds(c)), ")");
}

std::size_t bytes_of_cloud(const cloud::cloud& c) {
  return (c.points.size() + c.normals.size()) * sizeof(Eigen::Vector3f) +
         c.colors.size() * sizeof(cloud::color) + c.labels.size() * sizeof(std::uint32_t);
}

std::string print_distances(const distances& d) {
  if (d.n_finite() == d.n_beyond()) return message("distances(", grouped(d.size()), " values)");
  return message("distances(", grouped(d.size()), " values, mean ", d.mean(), ", max ", d.max(),
                 ")");
}

std::size_t bytes_of_distances(const distances& d) { return d.size() * sizeof(float); }

template <class Vector>
Vector vector_in(const sol::table& volume, const char* name, const char* expected) {
  const auto found = read_if<Vector>(volume.get<sol::object>(name));
  if (!found) {
    throw argument_error(message("aib.cloud.crop: ", expected, " expected; '", name,
                                 "' is missing or something else"));
  }
  return *found;
}

cloud::box box_from(const sol::table& t) {
  constexpr auto expected = "a box { min = {x, y, z}, max = {x, y, z} }";
  const cloud::box box{vector_in<Eigen::Vector3d>(t, "min", expected),
                       vector_in<Eigen::Vector3d>(t, "max", expected)};
  if (!(box.low.array() <= box.high.array()).all())
    throw argument_error("aib.cloud.crop: a box with min at or below max expected");
  return box;
}

cloud::oriented_box oriented_box_from(const sol::table& t) {
  constexpr auto expected =
      "an oriented box { centre = {x, y, z}, size = {x, y, z}, rotation = {three rows} }";
  return {vector_in<Eigen::Vector3d>(t, "centre", expected),
          vector_in<Eigen::Matrix3d>(t, "rotation", expected),
          vector_in<Eigen::Vector3d>(t, "size", expected)};
}

cloud::polygon_volume polygon_from(const sol::table& t) {
  constexpr auto expected =
      "a polygon volume { orthogonal_axis = \"X\"|\"Y\"|\"Z\", axis_min =, axis_max =, "
      "bounding_polygon = {{x, y, z}, ...} }";
  const auto axis = vector_in<std::string>(t, "orthogonal_axis", expected);
  const auto place = std::string("XYZ").find(axis);
  if (axis.size() != 1 || place == std::string::npos) {
    throw argument_error(
        message("aib.cloud.crop: orthogonal_axis \"X\", \"Y\" or \"Z\" expected, "
                "found '",
                axis, "'"));
  }
  return {static_cast<int>(place), vector_in<double>(t, "axis_min", expected),
          vector_in<double>(t, "axis_max", expected),
          vector_in<std::vector<Eigen::Vector3d>>(t, "bounding_polygon", expected)};
}

cloud::half_space half_space_from(const sol::table& t) {
  return {vector_in<Eigen::Vector4d>(t, "plane", "a plane { plane = {a, b, c, d} }")};
}

/// Whether each number is not 0.
std::vector<std::uint8_t> is_set(const io::array& cells) {
  std::vector<std::uint8_t> set;
  for (const float v : cells.values<float>()) set.push_back(v != 0);
  return set;
}

cloud::occupancy_grid grid_from(const sol::table& t) {
  constexpr auto expected = "a grid { grid = array, min = {x, y, z}, resolution = number }";
  const auto* cells = get_if<io::array>(t.get<sol::object>("grid"));
  if (!cells || cells->shape.size() != 3)
    throw argument_error(
        message("aib.cloud.crop: ", expected, " expected, the array of X x Y x Z"));
  return {vector_in<Eigen::Vector3d>(t, "min", expected),
          vector_in<double>(t, "resolution", expected),
          {cells->shape[0], cells->shape[1], cells->shape[2]},
          is_set(*cells)};
}

cloud::cloud crop(const cloud::cloud& c, const sol::table& volume) {
  const auto has = [&](const char* name) {
    return volume.get<sol::object>(name).get_type() != sol::type::lua_nil;
  };
  if (has("grid")) return cloud::crop(c, grid_from(volume));
  if (has("plane")) return cloud::crop(c, half_space_from(volume));
  if (has("min") || has("max")) return cloud::crop(c, box_from(volume));
  if (has("centre") || has("size")) return cloud::crop(c, oriented_box_from(volume));
  if (has("bounding_polygon")) return cloud::crop(c, polygon_from(volume));
  throw argument_error(
      "aib.cloud.crop: a box (min, max), an oriented box (centre, size, rotation), a polygon "
      "volume "
      "(bounding_polygon ...), a plane or a grid expected");
}

record summary_of(lua_State* state, const cloud::cloud& c) {
  const auto finite = std::count_if(c.points.begin(), c.points.end(),
                                    [](const Eigen::Vector3f& p) { return p.allFinite(); });
  record r = as_record(state, cloud::bounds(c));
  r.set("n", c.size()).set("n_finite", finite).set("has_normals", !c.normals.empty());
  return r.set("has_colors", !c.colors.empty()).set("has_labels", !c.labels.empty());
}

record summary_of(lua_State* state, const distances& d) {
  record r(state);
  r.set("n", d.size()).set("n_dropped", d.n_dropped()).set("n_beyond", d.n_beyond());
  if (d.n_finite() == d.n_beyond()) return r;
  return r.set("mean", d.mean())
      .set("median", d.median())
      .set("rmse", d.rmse())
      .set("max", d.max());
}

void bind_cloud_type(lua_State* state) {
  type<cloud::cloud>(state, "cloud", print_cloud, bytes_of_cloud)
      .length([](const cloud::cloud& c) { return c.size(); })
      .element([](const cloud::cloud& c, std::size_t i) { return c.position(i); })
      .field("has_normals", [](const cloud::cloud& c) { return !c.normals.empty(); })
      .field("has_colors", [](const cloud::cloud& c) { return !c.colors.empty(); })
      .field("has_labels", [](const cloud::cloud& c) { return !c.labels.empty(); })
      .field("origin", [](const cloud::cloud& c) { return c.origin; })
      .field("warnings", [](const cloud::cloud& c) { return c.warnings; })
      .method("bounds", {},
              [](lua_State* l, const cloud::cloud& c) { return as_record(l, cloud::bounds(c)); })
      .method("summary", {}, [](lua_State* l, const cloud::cloud& c) { return summary_of(l, c); })
      .method("label", {"index"},
              [](const cloud::cloud& c, std::size_t index) {
                if (index == 0 || index > c.labels.size()) {
                  throw argument_error(message("cloud:label: index 1..", c.labels.size(),
                                               " expected, found ", index));
                }
                return c.labels[index - 1];
              })
      .method("transformed", {"transform"},
              [](const cloud::cloud& c, const math::sim3& b_from_a) { return b_from_a * c; });
}

void bind_distances_type(lua_State* state) {
  type<distances>(state, "distances", print_distances, bytes_of_distances)
      .length([](const distances& d) { return d.size(); })
      .element([](const distances& d, std::size_t i) { return d[i]; })
      .field("n_dropped", [](const distances& d) { return d.n_dropped(); })
      .field("n_beyond", [](const distances& d) { return d.n_beyond(); })
      .method("summary", {}, [](lua_State* l, const distances& d) { return summary_of(l, d); })
      .method("mean", {}, [](const distances& d) { return d.mean(); })
      .method("median", {}, [](const distances& d) { return d.median(); })
      .method("rmse", {}, [](const distances& d) { return d.rmse(); })
      .method("max", {}, [](const distances& d) { return d.max(); })
      .method("quantile", {"q"}, [](const distances& d, double q) { return d.quantile(q); })
      .method("histogram", {"options"},
              [](lua_State* l, const distances& d, options& o) {
                const double high = o.number("max", 0);
                const auto bins = o.count("bins", 100);
                o.done();
                const stats::histogram counts = d.histogram(high, bins);
                record r(l);
                r.set("counts", counts.counts()).set("above", counts.above());
                return r.set("width", high / static_cast<double>(bins));
              })
      .method("share_below", {"tau"},
              [](const distances& d, double tau) { return d.share_below(tau); })
      .method("share_beyond", {}, [](const distances& d) { return d.share_beyond(); });
}

/// The clouds of a list.
cloud::cloud joined(const sol::table& list) {
  std::vector<const cloud::cloud*> clouds;
  for (std::size_t i = 1; i <= list.size(); ++i) {
    const auto* c = get_if<cloud::cloud>(list.get<sol::object>(i));
    if (!c) throw argument_error(message("aib.cloud.joined: element ", i, ": cloud expected"));
    clouds.push_back(c);
  }
  return cloud::joined(clouds);
}

void bind_preparation(module& m) {
  m.function("joined", {"clouds"}, [](const sol::table& list) { return joined(list); });
  m.function("crop", {"cloud", "volume"},
             [](const cloud::cloud& c, const sol::table& volume) { return crop(c, volume); })
      .function("without_statistical_outliers", {"cloud", "options"},
                [](session& s, const cloud::cloud& c, options& o) {
                  cloud::statistical_options how{.threads = s.threads, .control = s.control};
                  how.neighbours = o.count("neighbours", how.neighbours);
                  how.ratio = o.number("ratio", how.ratio);
                  o.done();
                  return cloud::without_statistical_outliers(c, how);
                })
      .function("without_radius_outliers", {"cloud", "options"},
                [](session& s, const cloud::cloud& c, options& o) {
                  cloud::radius_options how{.threads = s.threads, .control = s.control};
                  how.radius = o.number("radius", how.radius);
                  how.neighbours = o.count("neighbours", how.neighbours);
                  o.done();
                  return cloud::without_radius_outliers(c, how);
                })
      .function("random_subset", {"cloud", "n", "options"},
                [](const cloud::cloud& c, std::size_t n, options& o) {
                  const auto seed = o.count("seed", 1);
                  o.done();
                  return cloud::random_subset(c, n, seed);
                })
      .function("with_normals", {"cloud", "options"},
                [](session& s, const cloud::cloud& c, options& o) {
                  cloud::normal_options how{.threads = s.threads, .control = s.control};
                  how.neighbours = o.count("neighbours", how.neighbours);
                  o.done();
                  return cloud::with_normals(c, how);
                });
}

void bind_metrics(module& m) {
  m.function("distances", {"from", "to", "options"},
             [](session& s, const cloud::cloud& from, const cloud::cloud& to, options& o) {
               const auto search = distance_options(o, s);
               o.done();
               return distances(from, to, search);
             })
      .function("compare", {"est", "ref", "options"},
                [](lua_State* l, session& s, const cloud::cloud& est, const cloud::cloud& ref,
                   options& o) {
                  const auto search = distance_options(o, s);
                  const auto tau = o.numbers("tau", {});
                  o.done();
                  const auto both = cloud::distances_both_ways(est, ref, search);
                  return as_record(l, cloud::score(both.to_reference, both.to_estimate, tau));
                })
      .function("normal_consistency", {"est", "ref"},
                [](lua_State* l, session& s, const cloud::cloud& est, const cloud::cloud& ref) {
                  const auto n = cloud::normal_consistency(est, ref, s.threads, s.control);
                  record r(l);
                  r.set("estimate_mean", n.estimate_mean).set("estimate_median", n.estimate_median);
                  r.set("reference_mean", n.reference_mean);
                  return r.set("reference_median", n.reference_median);
                });
}

}  // namespace

void bind_cloud(lua_State* state) {
  bind_cloud_type(state);
  bind_distances_type(state);
  module m(state, "cloud");
  m.function("from_points", {"points"},
             [](const std::vector<Eigen::Vector3d>& points) { return cloud::from_points(points); });
  bind_preparation(m);
  bind_metrics(m);
}

}  // namespace aib::bind
