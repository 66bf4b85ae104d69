// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

namespace aib::search {

/// Where rays come from and how their own axes lie: rows are right, down, forward, of unit length.
struct ray_frame {
  Eigen::Vector3d origin;
  Eigen::Matrix3d axes;

  /// Axes about a direction of sight, which is not zero.
  static ray_frame towards(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
    const Eigen::Vector3d forward = direction.normalized();
    Eigen::Index least = 0;
    forward.cwiseAbs().minCoeff(&least);
    const Eigen::Vector3d right = forward.cross(Eigen::Vector3d::Unit(least)).normalized();
    ray_frame frame{origin, {}};
    frame.axes.row(0) = right;
    frame.axes.row(1) = forward.cross(right);
    frame.axes.row(2) = forward;
    return frame;
  }
};

/// Up to 64 rays from one point in eight groups of eight. A ray is (slope[0], slope[1], 1) in a
/// ray_frame. The fan holds for every place and attitude of the frame.
struct alignas(32) ray_fan {
  static constexpr std::size_t groups = 8;
  static constexpr std::size_t lanes = 64;

  float slope[2][lanes];
  /// Limits of the slopes of each group and of all, widened for rounding. A group without rays has
  /// empty limits.
  float group_low[2][groups], group_high[2][groups];
  float low[2], high[2];
  bool used[lanes];  ///< whether there is a ray

  /// slopes   64; NaN where there is no ray
  static ray_fan of(std::span<const Eigen::Vector2d, lanes> slopes);
  [[nodiscard]] bool empty() const { return !(low[0] <= high[0]); }
};

/// Boxes and triangles are placed in floats: what misses a fan by less than this slope is tried.
inline constexpr float slope_margin = 2e-6f;

inline ray_fan ray_fan::of(std::span<const Eigen::Vector2d, lanes> slopes) {
  ray_fan fan;
  for (int a = 0; a < 2; ++a) {
    fan.low[a] = HUGE_VALF;
    fan.high[a] = -HUGE_VALF;
    for (std::size_t g = 0; g < groups; ++g) {
      float low = HUGE_VALF, high = -HUGE_VALF;
      for (std::size_t i = 8 * g; i < 8 * g + 8; ++i) {
        fan.used[i] = slopes[i].allFinite();
        fan.slope[a][i] = fan.used[i] ? static_cast<float>(slopes[i][a]) : 0;
        if (!fan.used[i]) continue;
        low = std::min(low, fan.slope[a][i]);
        high = std::max(high, fan.slope[a][i]);
      }
      fan.group_low[a][g] = low - slope_margin;
      fan.group_high[a][g] = high + slope_margin;
      fan.low[a] = std::min(fan.low[a], fan.group_low[a][g]);
      fan.high[a] = std::max(fan.high[a], fan.group_high[a][g]);
    }
  }
  return fan;
}

}  // namespace aib::search
