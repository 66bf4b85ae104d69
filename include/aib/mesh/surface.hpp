// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/mesh/mesh.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <cstddef>

namespace aib::mesh {

/// Corners of a triangle, counted from the origin of its mesh.
[[nodiscard]] inline std::array<Eigen::Vector3d, 3> corners(const mesh& m, std::size_t t) {
  const auto& [a, b, c] = m.triangles[t];
  return {m.vertices[a].cast<double>(), m.vertices[b].cast<double>(), m.vertices[c].cast<double>()};
}

/// Area of a triangle; 0 where a corner is not finite.
[[nodiscard]] inline double area(const mesh& m, std::size_t t) {
  const auto [a, b, c] = corners(m, t);
  const Eigen::Vector3d ab = b - a;
  const Eigen::Vector3d ac = c - a;
  const double twice = ab.cross(ac).norm();
  return std::isfinite(twice) ? twice / 2 : 0;
}

/// Area of all triangles.
[[nodiscard]] inline double area(const mesh& m) {
  double total = 0;
  for (std::size_t t = 0; t < m.triangles.size(); ++t) total += area(m, t);
  return total;
}

}  // namespace aib::mesh
