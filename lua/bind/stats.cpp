// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include "stats.hpp"

#include <aib/stats/moments.hpp>
#include <aib/stats/quantiles.hpp>

#include "kit.hpp"
#include <string>
#include <vector>

namespace aib::bind {

namespace {

std::string print(const stats::moments& m) {
  return message("moments(", m.count(), " values, mean ", m.mean(), ", std ", m.deviation(), ")");
}

void bind_moments(lua_State* state) {
  type<stats::moments>(state, "moments", print)
      .length([](const stats::moments& m) { return m.count(); })
      .field("mean", [](const stats::moments& m) { return m.mean(); })
      .field("std", [](const stats::moments& m) { return m.deviation(); })
      .field("min", [](const stats::moments& m) { return m.min(); })
      .field("max", [](const stats::moments& m) { return m.max(); })
      .method("summary", {},
              [](lua_State* l, const stats::moments& m) {
                record r(l);
                return set_moments(r.set("count", m.count()), m);
              })
      .method("add", {"value"},
              [](stats::moments& m, double value) {
                m.add(value);
                return self{};
              })
      .method("merge", {"other"}, [](stats::moments& m, const stats::moments& other) {
        m += other;
        return self{};
      });
}

}  // namespace

void bind_stats(lua_State* state) {
  bind_moments(state);
  module(state, "stats")
      .function("moments", {}, [] { return stats::moments(); })
      .function("summary", {"values"},
                [](lua_State* l, const std::vector<double>& values) {
                  return as_record(l, stats::summarize(values));
                })
      .function("quantile", {"values", "q", "options"},
                [](std::vector<double> values, double q, options& o) {
                  using enum stats::quantile_rule;
                  const auto rule =
                      o.choice("rule", linear,
                               {{"linear", linear}, {"lower", lower}, {"midpoint", midpoint}});
                  o.done();
                  return stats::quantile_in_place<double>(values, q, rule);
                })
      .function("bootstrap", {"values", "options"},
                [](lua_State* l, const std::vector<double>& values, options& o) {
                  return bootstrap_record(l, values, o);
                });
}

}  // namespace aib::bind
