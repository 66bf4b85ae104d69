// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/stats/bootstrap.hpp>
#include <aib/stats/moments.hpp>
#include <aib/stats/summary.hpp>

#include "kit.hpp"
#include <vector>

namespace aib::bind {

/// Adds mean, std, min and max; nothing where there is no value.
inline record& set_moments(record& r, const stats::moments& m) {
  if (m.count() == 0) return r;
  return r.set("mean", m.mean()).set("std", m.deviation()).set("min", m.min()).set("max", m.max());
}

inline record as_record(lua_State* state, const stats::summary& s) {
  record r(state);
  r.set("count", s.count).set("rmse", s.rmse).set("mean", s.mean).set("median", s.median);
  return r.set("std", s.std).set("min", s.min).set("max", s.max).set("sse", s.sse);
}

/// The bootstrap interval of a mean: reads the options, which end with it.
inline record bootstrap_record(lua_State* state, const std::vector<double>& values, options& o) {
  stats::bootstrap_options b;
  b.block = o.count("block", b.block);
  b.resamples = o.count("resamples", b.resamples);
  b.level = o.number("level", b.level);
  b.seed = o.count("seed", b.seed);
  b.control = session::of(state).control;
  o.done();
  const auto i = stats::bootstrap_mean(values, b);
  return record(state)
      .set("mean", i.mean)
      .set("low", i.low)
      .set("high", i.high)
      .set("deviation", i.deviation);
}

}  // namespace aib::bind
