// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/cloud.hpp>

#include <Eigen/Core>

#include <limits>
#include <span>

namespace aib::cloud {

/// A box along the axes, both ends included. Empty until something is added.
struct box {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d high = Eigen::Vector3d::Constant(-std::numeric_limits<double>::infinity());

  [[nodiscard]] bool empty() const { return !(low.array() <= high.array()).all(); }
  [[nodiscard]] Eigen::Vector3d size() const { return high - low; }
  [[nodiscard]] Eigen::Vector3d centre() const { return (low + high) / 2; }
  [[nodiscard]] bool contains(const Eigen::Vector3d& p) const {
    return (p.array() >= low.array()).all() && (p.array() <= high.array()).all();
  }
  void add(const Eigen::Vector3d& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
};

/// Box of the finite points among `points`, which are counted from `origin`.
[[nodiscard]] inline box bounds(std::span<const Eigen::Vector3f> points,
                                const Eigen::Vector3d& origin) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  Eigen::Vector3f low = Eigen::Vector3f::Constant(infinity);
  Eigen::Vector3f high = -low;
  for (const Eigen::Vector3f& p : points) {
    if (!p.allFinite()) continue;
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return {origin + low.cast<double>(), origin + high.cast<double>()};
}

/// Box of the finite points of a cloud.
[[nodiscard]] inline box bounds(const cloud& c) { return bounds(c.points, c.origin); }

}  // namespace aib::cloud
