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

/// A point of a triangle, uniform by area for two numbers uniform in [0, 1].
/// Source: Osada et al., "Shape distributions", ACM TOG 2002, equation 1.
[[nodiscard]] inline Eigen::Vector3d point_in(const std::array<Eigen::Vector3d, 3>& corner,
                                              double u,
                                              double v) {
  const double root = std::sqrt(u);
  return (1 - root) * corner[0] + root * (1 - v) * corner[1] + root * v * corner[2];
}

}  // namespace aib::mesh
