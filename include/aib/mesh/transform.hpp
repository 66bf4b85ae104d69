// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/positions.hpp>
#include <aib/math/rigid3.hpp>
#include <aib/math/sim3.hpp>
#include <aib/mesh/mesh.hpp>

#include <cstddef>
#include <utility>

namespace aib::mesh {

/// The mesh in frame b. Vertices are moved in double and counted from their new natural origin.
[[nodiscard]] inline mesh operator*(const math::sim3& b_from_a, const mesh& in_a) {
  cloud::placed_points placed = cloud::place(
      in_a.vertices.size(), [&](std::size_t i) { return b_from_a * in_a.position(i); });
  mesh in_b = in_a;
  in_b.origin = placed.origin;
  in_b.vertices = std::move(placed.points);
  return in_b;
}

[[nodiscard]] inline mesh operator*(const math::rigid3& b_from_a, const mesh& in_a) {
  return math::sim3{1, b_from_a.rotation, b_from_a.translation} * in_a;
}

}  // namespace aib::mesh
