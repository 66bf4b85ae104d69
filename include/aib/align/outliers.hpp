// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/stats/quantiles.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace aib::align {

struct outlier_options {
  std::optional<double> factor = {};    ///< of the median distance, e.g. 3
  std::optional<double> distance = {};  ///< absolute, unit of the positions
};

/// Distances of positions from their component-wise median, and those that are kept.
struct outlier_split {
  Eigen::Vector3d median_position;
  double median_distance;
  std::vector<std::size_t> kept;     ///< distance <= every limit that is set
  std::vector<std::size_t> removed;  ///< ascending, as kept
};

/// One pass. Throws undefined_error if there is no position.
inline outlier_split split_outliers(std::span<const Eigen::Vector3d> positions,
                                    const outlier_options& options) {
  outlier_split out;
  std::vector<double> values(positions.size());
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < positions.size(); ++i) values[i] = positions[i][axis];
    out.median_position[axis] = stats::quantile_in_place<double>(values, 0.5);
  }
  std::vector<double> distances;
  for (const Eigen::Vector3d& p : positions) distances.push_back((p - out.median_position).norm());
  out.median_distance = stats::median<double>(distances);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const double limit = std::min(options.factor ? *options.factor * out.median_distance : infinity,
                                options.distance.value_or(infinity));
  for (std::size_t i = 0; i < positions.size(); ++i)
    (distances[i] <= limit ? out.kept : out.removed).push_back(i);
  return out;
}

}  // namespace aib::align
