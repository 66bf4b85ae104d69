// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/math/rigid3.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <mutex>
#include <span>
#include <vector>

namespace aib::pose {

/// The camera centres of a trajectory and which of their differences have a direction: those longer
/// than 1e-9 of the longest and than 1e-12 of the largest coordinate.
///
/// Centres are divided by a power of two near their largest coordinate, so that no square
/// overflows; lengths below are in that unit. The longest baseline is bounded by a ball and is
/// searched for only when a baseline lies between the bounds.
class baselines {
 public:
  /// poses     finite
  /// padding   NaN entries behind the centres, for blocks that read over the end
  explicit baselines(std::span<const math::rigid3> poses, std::size_t padding = 0);

  [[nodiscard]] Eigen::Vector3d between(std::size_t i, std::size_t j) const {
    return {x[j] - x[i], y[j] - y[i], z[j] - z[i]};
  }

  /// Any longer baseline has a direction.
  [[nodiscard]] double certain() const { return std::max(2e-9 * radius_, smallest_); }

  [[nodiscard]] bool has_direction(std::size_t i, std::size_t j) const {
    const double length = between(i, j).norm();
    if (length > certain()) return true;
    if (!(length > std::max(1e-9 * radius_, smallest_))) return false;
    return length > std::max(1e-9 * longest(), smallest_);
  }

  std::vector<double> x, y, z;

 private:
  [[nodiscard]] double longest() const;

  std::size_t size_;
  double smallest_;    // 1e-12 of the largest coordinate
  double radius_ = 0;  // of a ball about all centres, and at most the longest baseline
  mutable std::once_flag searched_;
  mutable double longest_ = 0;
};

inline baselines::baselines(std::span<const math::rigid3> poses, std::size_t padding)
    : size_(poses.size()) {
  double largest = 0;
  for (const math::rigid3& p : poses)
    largest = std::max(largest, p.translation.cwiseAbs().maxCoeff());
  const int exponent = largest > 0 ? std::ilogb(largest) : 0;
  smallest_ = 1e-12 * std::scalbn(largest, -exponent);
  for (auto* axis : {&x, &y, &z})
    axis->resize(size_ + padding, std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < size_; ++i) {
    x[i] = std::scalbn(poses[i].translation.x(), -exponent);
    y[i] = std::scalbn(poses[i].translation.y(), -exponent);
    z[i] = std::scalbn(poses[i].translation.z(), -exponent);
    radius_ = std::max(radius_, between(0, i).norm());  // about the first centre
  }
}

inline double baselines::longest() const {
  std::call_once(searched_, [&] {
    for (std::size_t i = 0; i < size_; ++i) {
      for (std::size_t j = i + 1; j < size_; ++j)
        longest_ = std::max(longest_, between(i, j).norm());
    }
  });
  return longest_;
}

}  // namespace aib::pose
