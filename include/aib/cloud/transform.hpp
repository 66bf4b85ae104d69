// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/cloud.hpp>
#include <aib/cloud/positions.hpp>
#include <aib/math/rigid3.hpp>
#include <aib/math/sim3.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <utility>

namespace aib::cloud {

/// The cloud in frame b. Points are moved in double and counted from their new natural origin,
/// normals are turned.
[[nodiscard]] inline cloud operator*(const math::sim3& b_from_a, const cloud& in_a) {
  placed_points placed =
      place(in_a.size(), [&](std::size_t i) { return b_from_a * in_a.position(i); });
  cloud in_b = in_a;
  in_b.origin = placed.origin;
  in_b.points = std::move(placed.points);
  const Eigen::Matrix3f rotation = b_from_a.rotation.cast<float>();
  for (Eigen::Vector3f& normal : in_b.normals) normal = (rotation * normal).eval();
  return in_b;
}

[[nodiscard]] inline cloud operator*(const math::rigid3& b_from_a, const cloud& in_a) {
  return math::sim3{1, b_from_a.rotation, b_from_a.translation} * in_a;
}

}  // namespace aib::cloud
