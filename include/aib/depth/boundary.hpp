// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/depth/error_sums.hpp>
#include <aib/raster/view.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace aib::depth {

struct boundary_options {
  double t_min = 1.05;  ///< least ratio of two neighbours' depths at a boundary
  double t_max = 1.25;  ///< the largest of the thresholds
  std::size_t n = 10;   ///< thresholds, evenly spaced, weighted by their size
};

/// Boundary F1 of Depth Pro: do occluding contours lie at the same two neighbours, facing the same
/// of four ways? It does not see the scale. 0..1, higher is better.
///
/// What to know of the definition, which is kept: a contour one pixel off is a miss; the mean is
/// over the four ways even where the reference has contours facing one alone, so that a perfect
/// estimate of a vertical step scores 0.25; without any contour it is 0. Depths below 1e-6 become
/// 1e-6 (a hole in either map is a contour around it); a pair with NaN is none.
///
/// Throws argument_error if the sizes differ or n is 0.
/// Source: Bochkovskii et al., "Depth Pro: sharp monocular metric depth in less than a second",
/// 2024.
[[nodiscard]] double boundary_f1(raster::view<const float> estimate,
                                 raster::view<const float> reference,
                                 const boundary_options& options = {});

namespace detail {

/// Contours that face one way: of the estimate, of the reference, of both.
struct contour_counts {
  std::uint64_t estimate = 0;
  std::uint64_t reference = 0;
  std::uint64_t both = 0;
};

/// NaN stays NaN, as in NumPy's clip.
inline double inverse_depth(float depth) {
  return 1 / (depth < 1e-6f ? 1e-6 : static_cast<double>(depth));
}

inline void count_pair(double e_ratio, double r_ratio, double t, contour_counts& to) {
  const bool e = e_ratio > t, r = r_ratio > t;
  to.estimate += e;
  to.reference += r;
  to.both += e && r;
}

/// Left, right, top, bottom.
inline std::array<contour_counts, 4> count_contours(raster::view<const float> estimate,
                                                    raster::view<const float> reference,
                                                    double t) {
  std::array<contour_counts, 4> counts{};
  const auto count = [&](std::size_t x, std::size_t y, std::size_t next_x, std::size_t next_y,
                         std::size_t way) {
    const double e = inverse_depth(estimate(x, y)), r = inverse_depth(reference(x, y));
    const double next_e = inverse_depth(estimate(next_x, next_y));
    const double next_r = inverse_depth(reference(next_x, next_y));
    count_pair(e / next_e, r / next_r, t, counts[way]);
    count_pair(next_e / e, next_r / r, t, counts[way + 1]);
  };
  for (std::size_t y = 0; y < estimate.height; ++y) {
    for (std::size_t x = 0; x < estimate.width; ++x) {
      if (x + 1 < estimate.width) count(x, y, x + 1, y, 0);
      if (y + 1 < estimate.height) count(x, y, x, y + 1, 2);
    }
  }
  return counts;
}

inline double f1_of(const std::array<contour_counts, 4>& counts) {
  const auto share = [](std::uint64_t part, std::uint64_t whole) {
    return static_cast<double>(part) / static_cast<double>(std::max<std::uint64_t>(whole, 1));
  };
  double recall = 0, precision = 0;
  for (const contour_counts& c : counts) {
    recall += share(c.both, c.reference) / 4;
    precision += share(c.both, c.estimate) / 4;
  }
  return recall + precision > 0 ? 2 * recall * precision / (recall + precision) : 0;
}

}  // namespace detail

inline double boundary_f1(raster::view<const float> estimate,
                          raster::view<const float> reference,
                          const boundary_options& options) {
  check_sizes("depth::boundary_f1", estimate, reference);
  if (options.n == 0) throw argument_error("depth::boundary_f1: n >= 1 expected, found 0");
  const double intervals = static_cast<double>(std::max<std::size_t>(options.n - 1, 1));
  const double step = (options.t_max - options.t_min) / intervals;
  double total = 0, weights = 0;
  for (std::size_t k = 0; k < options.n; ++k) {
    const double t = options.t_min + static_cast<double>(k) * step;
    total += t * detail::f1_of(detail::count_contours(estimate, reference, t));
    weights += t;
  }
  return total / weights;
}

}  // namespace aib::depth
