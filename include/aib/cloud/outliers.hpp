// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/cloud.hpp>
#include <aib/cloud/neighbours.hpp>
#include <aib/cloud/positions.hpp>
#include <aib/cloud/select.hpp>
#include <aib/core/error.hpp>
#include <aib/core/executor.hpp>
#include <aib/core/random.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

namespace aib::cloud {

struct statistical_options {
  std::size_t neighbours = 20;  ///< the point itself included
  double ratio = 2;             ///< standard deviations above the mean that are kept
  unsigned threads = 0;         ///< 0: all
  aib::control control = {};
};

struct radius_options {
  double radius = 0;
  std::size_t neighbours = 2;  ///< more points than this, the point itself included, are kept
  unsigned threads = 0;        ///< 0: all
  aib::control control = {};
};

namespace detail {

/// A number for each point, of NaN where the point is not finite.
template <class Measure>
std::vector<double> measure_points(const cloud& c,
                                   unsigned threads,
                                   const control& control,
                                   Measure&& measure) {
  std::vector<double> values(c.size(), std::numeric_limits<double>::quiet_NaN());
  for_each_chunk(c.size(), 1024, threads, control, [&](const chunk& part) {
    for (std::size_t i = part.begin; i < part.end; ++i) {
      if (is_finite(c.points[i])) values[i] = measure(c.position(i));
    }
  });
  return values;
}

}  // namespace detail

/// The points whose mean distance to their nearest neighbours is not far above that of all: below
/// mean + ratio * standard deviation (ddof 1). Duplicates, whose mean distance is 0, go as well.
/// Source: Rusu et al., RAS 2008; the rule is Open3D's remove_statistical_outlier.
[[nodiscard]] inline cloud without_statistical_outliers(const cloud& c,
                                                        const statistical_options& options = {}) {
  if (options.neighbours == 0 || !(options.ratio > 0)) {
    throw argument_error("cloud::without_statistical_outliers: neighbours > 0, ratio > 0 expected");
  }
  const neighbours search(c, options.control);
  const auto spread =
      detail::measure_points(c, options.threads, options.control, [&](const Eigen::Vector3d& p) {
        const auto found = search.nearest(p, options.neighbours);
        double sum = 0;
        for (const neighbour& n : found) sum += n.distance;
        return sum / static_cast<double>(found.size());
      });
  double sum = 0, squares = 0, n = 0;
  for (const double s : spread) {
    if (s > 0) sum += s, ++n;
  }
  const double mean = n > 0 ? sum / n : 0;
  for (const double s : spread) {
    if (s > 0) squares += (s - mean) * (s - mean);
  }
  const double limit = mean + options.ratio * (n > 1 ? std::sqrt(squares / (n - 1)) : 0);
  return select_where(c, [&](std::size_t i) { return spread[i] > 0 && spread[i] < limit; });
}

/// The points that have more than so many points, themselves included, nearer than a radius.
[[nodiscard]] inline cloud without_radius_outliers(const cloud& c, const radius_options& options) {
  if (!(options.radius > 0)) {
    throw argument_error(
        message("cloud::without_radius_outliers: radius > 0 expected, found ", options.radius));
  }
  const neighbours search(c, options.control);
  const auto count =
      detail::measure_points(c, options.threads, options.control, [&](const Eigen::Vector3d& p) {
        return static_cast<double>(search.count_within(p, options.radius));
      });
  const auto least = static_cast<double>(options.neighbours);
  return select_where(c, [&](std::size_t i) { return count[i] > least; });
}

/// n points chosen at random, each subset equally likely, in their order; all where there are
/// fewer.
[[nodiscard]] inline cloud random_subset(const cloud& c, std::size_t n, std::uint64_t seed = 1) {
  std::vector<std::size_t> index(c.size());
  std::iota(index.begin(), index.end(), std::size_t{0});
  n = std::min(n, index.size());
  random_engine random(seed);
  for (std::size_t i = 0; i < n; ++i)
    std::swap(index[i], index[i + random.below(index.size() - i)]);
  index.resize(n);
  std::sort(index.begin(), index.end());
  return select(c, index);
}

}  // namespace aib::cloud
