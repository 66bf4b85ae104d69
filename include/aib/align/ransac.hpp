// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/align/pose_fit.hpp>
#include <aib/core/error.hpp>
#include <aib/core/random.hpp>
#include <aib/stats/quantiles.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace aib::align {

struct ransac_options {
  double distance = 0;  ///< inliers lie within it, unit of the reference; 0: told from the data
  std::size_t iterations = 1000;
  std::uint64_t seed = 1;
};

namespace detail {

/// Diagonal of the box of the points.
inline double extent(std::span<const Eigen::Vector3d> points) {
  Eigen::Vector3d low = points.front(), high = points.front();
  for (const Eigen::Vector3d& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return (high - low).norm();
}

}  // namespace detail

/// The poses among `chosen` that agree with one transform, ascending.
///
/// With `distance` the transform of three poses that most poses agree with (RANSAC); without, the
/// one with the least median residual, whose inliers lie within 2.5 robust standard deviations,
/// or within a billionth of the extent where nothing but rounding is left.
/// Then fit and inliers in turns until they no longer change.
/// Throws undefined_error if no three poses tell a transform.
/// Source: Fischler and Bolles, CACM 1981; Rousseeuw, "Least median of squares regression", 1984.
inline std::vector<std::size_t> consensus(const pose_fit& fit,
                                          std::span<const std::size_t> chosen,
                                          const ransac_options& options = {}) {
  const auto residuals = [&](const math::sim3& ref_from_est) {
    std::vector<double> out;
    for (const std::size_t i : chosen) out.push_back(fit.residual(ref_from_est, i));
    return out;
  };
  const auto cost = [&](std::vector<double> r) {
    if (options.distance > 0) {
      return -static_cast<double>(
          std::count_if(r.begin(), r.end(), [&](double d) { return d <= options.distance; }));
    }
    return stats::quantile_in_place<double>(r, 0.5, stats::quantile_rule::lower);
  };
  random_engine random(options.seed);
  math::sim3 best;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < options.iterations && chosen.size() >= 3; ++k) {
    std::array<std::size_t, 3> sample;
    for (std::size_t& s : sample) s = chosen[random.below(chosen.size())];
    if (sample[0] == sample[1] || sample[0] == sample[2] || sample[1] == sample[2]) continue;
    try {
      const math::sim3 candidate = fit(sample);
      const double c = cost(residuals(candidate));
      if (c < least) {
        least = c;
        best = candidate;
      }
    } catch (const undefined_error&) {  // three poses on a line
    }
  }
  if (!std::isfinite(least))
    throw undefined_error("align: robust: no three poses tell a transform");
  const double n = static_cast<double>(chosen.size());
  const double sigma = 1.4826 * (1 + 5 / std::max(1.0, n - 3)) * least;  // Rousseeuw, Eq. (1.3)
  const double rounding = 1e-9 * detail::extent(fit.reference(chosen));
  const double limit = options.distance > 0 ? options.distance : std::max(2.5 * sigma, rounding);
  std::vector<std::size_t> inliers;
  for (int round = 0; round < 20; ++round) {
    std::vector<std::size_t> next;
    for (const std::size_t i : chosen) {
      if (fit.residual(best, i) <= limit) next.push_back(i);
    }
    if (next == inliers || next.size() < 3) break;
    inliers = std::move(next);
    best = fit(inliers);
  }
  return inliers;
}

}  // namespace aib::align
