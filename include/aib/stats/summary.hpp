// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/stats/moments.hpp>
#include <aib/stats/quantiles.hpp>

#include <cmath>
#include <cstdint>
#include <span>

namespace aib::stats {

/// Statistics of a set of errors, named as evo names them.
struct summary {
  std::uint64_t count;
  double rmse;
  double mean;
  double median;
  double std;  ///< population (ddof 0)
  double min;
  double max;
  double sse;  ///< sum of squares
};

/// Throws undefined_error if there is no value.
inline summary summarize(std::span<const double> errors) {
  if (errors.empty()) throw undefined_error("stats::summarize: no values");
  moments m;
  double sse = 0;
  for (const double e : errors) {
    m.add(e);
    sse += e * e;
  }
  return {.count = m.count(),
          .rmse = std::sqrt(sse / static_cast<double>(m.count())),
          .mean = m.mean(),
          .median = median(errors),
          .std = m.deviation(),
          .min = m.min(),
          .max = m.max(),
          .sse = sse};
}

}  // namespace aib::stats
