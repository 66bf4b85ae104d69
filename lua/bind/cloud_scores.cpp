// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/cloud/by_label.hpp>
#include <aib/cloud/colored.hpp>
#include <aib/cloud/eth3d.hpp>
#include <aib/cloud/offsets.hpp>

#include "cloud.hpp"
#include "kit.hpp"
#include <cstddef>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace aib::bind {

using cloud::distances;
using cloud::offsets;

std::vector<record> as_records(lua_State* state,
                               const std::vector<cloud::label_distances>& labels,
                               const std::vector<double>& tau) {
  std::vector<record> list;
  for (const auto& d : labels) {
    record r(state);
    if (d.to_reference.n_finite() > d.to_reference.n_beyond() &&
        d.to_estimate.n_finite() > d.to_estimate.n_beyond()) {
      r = as_record(state, cloud::score(d.to_reference, d.to_estimate, tau));
    } else {
      r.set("n_estimate", d.to_reference.n_finite()).set("n_reference", d.to_estimate.n_finite());
    }
    list.push_back(r.set("label", d.label));
  }
  return list;
}

std::optional<std::vector<float>> values_in(const sol::object& values) {
  if (const auto* d = get_if<distances>(values))
    return std::vector<float>(d->values().begin(), d->values().end());
  if (const auto* o = get_if<offsets>(values))
    return std::vector<float>(o->values().begin(), o->values().end());
  return read_if<std::vector<float>>(values);
}

std::vector<float> values_of(const sol::object& values, const char* function) {
  if (auto numbers = values_in(values)) return std::move(*numbers);
  throw argument_error(message(function, ": distances, offsets or a list of numbers expected"));
}

namespace {

std::string print_offsets(const offsets& o) {
  if (o.n_finite() == 0) return message("offsets(", grouped(o.size()), " values)");
  return message("offsets(", grouped(o.size()), " values, mean ", o.mean(), ", deviation ",
                 o.deviation(), ")");
}

std::size_t bytes_of_offsets(const offsets& o) { return o.size() * sizeof(float); }

record summary_of(lua_State* state, const offsets& o) {
  record r(state);
  r.set("n", o.size()).set("n_dropped", o.n_dropped());
  if (o.n_finite() == 0) return r;
  r.set("mean", o.mean()).set("mean_absolute", o.mean_absolute()).set("median", o.median());
  return r.set("deviation", o.deviation());
}

void bind_offsets_type(lua_State* state) {
  type<offsets>(state, "offsets", print_offsets, bytes_of_offsets)
      .length([](const offsets& o) { return o.size(); })
      .element([](const offsets& o, std::size_t i) { return o[i]; })
      .field("n_dropped", [](const offsets& o) { return o.n_dropped(); })
      .method("summary", {}, [](lua_State* l, const offsets& o) { return summary_of(l, o); })
      .method("mean", {}, [](const offsets& o) { return o.mean(); })
      .method("mean_absolute", {}, [](const offsets& o) { return o.mean_absolute(); })
      .method("median", {}, [](const offsets& o) { return o.median(); })
      .method("deviation", {}, [](const offsets& o) { return o.deviation(); })
      .method("quantile", {"q"}, [](const offsets& o, double q) { return o.quantile(q); });
}

/// Values that have a colour: distances, offsets, or a list of numbers.
struct scale {
  std::vector<float> values;
  double high;
  cloud::color_scale colors;
};

scale scale_of(const sol::object& values, options& o, const char* function) {
  using enum cloud::color_scale;
  scale s{values_of(values, function), o.number("max", 0),
          get_if<offsets>(values) ? diverging : sequential};
  s.colors = o.choice("scale", s.colors, {{"sequential", sequential}, {"diverging", diverging}});
  o.done();
  return s;
}

record as_curve(lua_State* state, const std::vector<cloud::threshold_scores>& scores) {
  const threshold_columns at(scores);
  record r(state);
  r.set("tau", at.tau).set("precision", at.precision).set("recall", at.recall);
  return r.set("f_score", at.f_score);
}

/// steps thresholds up to max.
std::vector<double> thresholds(options& o) {
  const double high = o.number("max", 0);
  const auto steps = o.count("steps", 100);
  o.done();
  if (!(high > 0)) o.reject("max", "a number > 0 expected");
  std::vector<double> tau;
  for (std::size_t i = 1; i <= steps; ++i)
    tau.push_back(high * static_cast<double>(i) / static_cast<double>(steps));
  return tau;
}

void bind_parts(module& m) {
  m.function("distances_both_ways", {"est", "ref", "options"},
             [](session& s, const cloud::cloud& est, const cloud::cloud& ref, options& o) {
               const auto search = distance_options(o, s);
               o.done();
               auto both = cloud::distances_both_ways(est, ref, search);
               return results(std::move(both.to_reference), std::move(both.to_estimate));
             })
      .function("score", {"to_reference", "to_estimate", "options"},
                [](lua_State* l, const distances& to_reference, const distances& to_estimate,
                   options& o) {
                  const auto tau = o.numbers("tau", {});
                  o.done();
                  return as_record(l, cloud::score(to_reference, to_estimate, tau));
                })
      .function("curve", {"to_reference", "to_estimate", "options"},
                [](lua_State* l, const distances& to_reference, const distances& to_estimate,
                   options& o) {
                  return as_curve(l, cloud::scores_at(to_reference, to_estimate, thresholds(o)));
                })
      .function("compare_by_label", {"est", "ref", "options"},
                [](lua_State* l, session& s, const cloud::cloud& est, const cloud::cloud& ref,
                   options& o) {
                  const auto search = distance_options(o, s);
                  const auto tau = o.numbers("tau", {});
                  o.done();
                  const auto labels = cloud::nearest_labels(est, ref, s.threads, s.control);
                  const auto both = cloud::distances_both_ways(est, ref, search);
                  return as_records(l, cloud::by_label(both, labels, ref.labels, search), tau);
                });
}

void bind_values(module& m) {
  m.function("offsets", {"from", "ref"},
             [](session& s, const cloud::cloud& from, const cloud::cloud& ref) {
               return cloud::offsets_along_normals(from, ref, s.threads, s.control);
             })
      .function("colored", {"cloud", "values", "options"},
                [](const cloud::cloud& c, const sol::object& values, options& o) {
                  const scale s = scale_of(values, o, "aib.cloud.colored");
                  return cloud::colored(c, s.values, s.high, s.colors);
                })
      .function("colors_of", {"values", "options"}, [](const sol::object& values, options& o) {
        const scale s = scale_of(values, o, "aib.cloud.colors_of");
        std::vector<std::vector<int>> colors;
        for (const auto& c : cloud::colors_of(s.values, s.high, s.colors))
          colors.emplace_back(c.begin(), c.end());
        return colors;
      });
}

std::vector<cloud::laser_scan> scans_of(const sol::table& list) {
  std::vector<cloud::laser_scan> scans;
  for (std::size_t i = 1; i <= list.size(); ++i) {
    const auto scan = read_if<sol::table>(list.get<sol::object>(i));
    const auto* points = scan ? get_if<cloud::cloud>(scan->get<sol::object>("points")) : nullptr;
    const auto scanner = scan ? read_if<Eigen::Vector3d>(scan->get<sol::object>("scanner"))
                              : std::optional<Eigen::Vector3d>();
    if (!points || !scanner) {
      throw argument_error(message("aib.cloud.eth3d: scan ", i,
                                   ": { points = cloud, scanner = {x, y, z} } expected"));
    }
    scans.push_back({*points, *scanner});
  }
  return scans;
}

cloud::eth3d_options eth3d_options(options& o, const session& s) {
  using enum cloud::eth3d_rule;
  cloud::eth3d_options e;
  e.tolerances = o.numbers("tolerances", {});
  e.voxel = o.number("voxel", e.voxel);
  e.beam.start_radius = o.number("beam_radius", e.beam.start_radius);
  e.beam.half_angle = o.number("beam_half_angle_deg", 0.011) * std::numbers::pi / 180;
  e.rule = o.choice("rule", e.rule, {{"official", official}, {"within", within}, {"below", below}});
  e.threads = s.threads;
  e.control = s.control;
  return e;
}

/// By tolerance; accuracy and F-score are nil where nothing was observed.
record as_record(lua_State* state, const cloud::eth3d_result& e) {
  std::vector<double> tolerance, completeness, observed, accuracy, f_score, unobserved;
  for (std::size_t t = 0; t < e.scores.size(); ++t) {
    const auto& s = e.scores[t];
    tolerance.push_back(s.tolerance);
    completeness.push_back(s.completeness);
    unobserved.push_back(static_cast<double>(e.n_unobserved[t]));
    if (!s.accuracy) continue;
    observed.push_back(s.tolerance);
    accuracy.push_back(*s.accuracy);
    f_score.push_back(*s.f_score);
  }
  record r(state);
  r.set("completeness", keyed(state, tolerance, completeness));
  r.set("accuracy", keyed(state, observed, accuracy))
      .set("f_score", keyed(state, observed, f_score));
  r.set("n_unobserved", keyed(state, tolerance, unobserved));
  return r.set("n_estimate", e.n_reconstruction).set("n_reference", e.n_scanned);
}

}  // namespace

void bind_cloud_scores(lua_State* state) {
  bind_offsets_type(state);
  module m(state, "cloud");
  bind_parts(m);
  bind_values(m);
  m.function(
      "eth3d", {"est", "scans", "options"},
      [](lua_State* l, session& s, const cloud::cloud& est, const sol::table& scans, options& o) {
        const auto how = eth3d_options(o, s);
        o.done();
        return as_record(l, cloud::eth3d(est, scans_of(scans), how));
      });
}

}  // namespace aib::bind
