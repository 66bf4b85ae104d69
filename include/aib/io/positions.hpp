// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/cloud.hpp>
#include <aib/core/message.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace aib::io {

/// Positions as clouds and meshes keep them: `origin + points[i]`.
struct float_positions {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3f> points = {};
};

/// Double positions as floats from the natural origin of their finite ones.
[[nodiscard]] inline float_positions to_floats(std::span<const Eigen::Vector3d> positions) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  Eigen::Vector3d low = Eigen::Vector3d::Constant(infinite);
  Eigen::Vector3d high = -low;
  for (const Eigen::Vector3d& p : positions) {
    if (!p.allFinite()) continue;
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  float_positions result;
  if (low[0] <= high[0]) result.origin = cloud::natural_origin(low, high);
  result.points.reserve(positions.size());
  for (const Eigen::Vector3d& p : positions)
    result.points.emplace_back((p - result.origin).cast<float>());
  return result;
}

/// How many points have a coordinate that is NaN or infinite.
[[nodiscard]] inline std::size_t count_non_finite(std::span<const Eigen::Vector3f> points) {
  // All exponent bits set: looked for in one flat loop without branches, since most files have
  // none.
  const float* flat = points.empty() ? nullptr : points.front().data();
  std::uint32_t any = 0;
  for (std::size_t i = 0; i < 3 * points.size(); ++i)
    any |= (std::bit_cast<std::uint32_t>(flat[i]) & 0x7f800000u) == 0x7f800000u ? 1u : 0u;
  if (any == 0) return 0;
  return static_cast<std::size_t>(std::count_if(
      points.begin(), points.end(), [](const Eigen::Vector3f& p) { return !p.allFinite(); }));
}

/// The sentence that a reader leaves about non-finite points; nothing where all are finite.
[[nodiscard]] inline std::optional<std::string> non_finite_warning(
    std::span<const Eigen::Vector3f> points, std::string_view name) {
  const std::size_t n = count_non_finite(points);
  if (n == 0) return std::nullopt;
  return message(n, " of ", points.size(), " ", name, " are not finite");
}

}  // namespace aib::io
