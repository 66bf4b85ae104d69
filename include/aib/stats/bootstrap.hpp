// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/core/executor.hpp>
#include <aib/core/random.hpp>
#include <aib/stats/moments.hpp>
#include <aib/stats/quantiles.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace aib::stats {

struct bootstrap_options {
  std::size_t block = 10;  ///< neighbours drawn together; 1: independent values
  std::size_t resamples = 2000;
  double level = 0.95;  ///< share of the resampled means inside the interval
  std::uint64_t seed = 1;
  aib::control control = {};
};

/// A mean and how far it may be off.
struct interval {
  double mean;
  double low;
  double high;
  double deviation;  ///< of the resampled means: the standard error
};

/// Percentile interval of the mean of a series whose neighbours are alike, as frames of a flight
/// that overlap by 80 % are: blocks of consecutive values are drawn with replacement, the series
/// taken as a ring. With independent draws (block = 1) the interval of such a series is too narrow.
/// A difference of two conditions: pass the differences frame by frame.
///
/// A block longer than the series is the series, and the interval a point. Throws undefined_error
/// if there is no value, argument_error if block or resamples is 0 or level outside (0, 1).
/// Source: Politis, Romano, "A circular block-resampling procedure for stationary data", 1992.
[[nodiscard]] inline interval bootstrap_mean(std::span<const double> values,
                                             const bootstrap_options& options = {}) {
  if (values.empty()) throw undefined_error("stats::bootstrap_mean: no values");
  if (options.block == 0 || options.resamples == 0 || !(options.level > 0 && options.level < 1)) {
    throw argument_error(
        message("stats::bootstrap_mean: block and resamples > 0 and level in "
                "(0, 1) expected, found ",
                options.block, ", ", options.resamples, " and ", options.level));
  }
  const std::size_t n = values.size();
  random_engine random(options.seed);
  std::vector<double> means(options.resamples);
  for (double& mean : means) {
    demand_go(options.control);
    moments sample;
    while (sample.count() < n) {
      const std::size_t first = random.below(n);
      const std::size_t length = std::min(options.block, n - sample.count());
      for (std::size_t i = 0; i < length; ++i) sample.add(values[(first + i) % n]);
    }
    mean = sample.mean();
  }
  moments of_values, of_means;
  for (const double v : values) of_values.add(v);
  for (const double m : means) of_means.add(m);
  const double tail = (1 - options.level) / 2;
  return {.mean = of_values.mean(),
          .low = quantile<double>(means, tail),
          .high = quantile<double>(means, 1 - tail),
          .deviation = of_means.deviation()};
}

}  // namespace aib::stats
