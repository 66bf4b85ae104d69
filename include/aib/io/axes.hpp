// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/cloud.hpp>
#include <aib/core/error.hpp>
#include <aib/mesh/mesh.hpp>

#include <Eigen/Core>

#include <string_view>

namespace aib::io {

/// The axis that points up in a file. Blender's OBJ and glTF exports are Y up by default, its PLY
/// and STL exports Z up.
enum class up_axis { z, y };

/// "z" or "y". Throws argument_error for another name.
[[nodiscard]] inline up_axis parse_up_axis(std::string_view name) {
  if (name == "z") return up_axis::z;
  if (name == "y") return up_axis::y;
  throw argument_error(message("up: \"z\" or \"y\" expected, found \"", name, "\""));
}

namespace detail {

/// (x, y, z) of a Y-up frame in the Z-up frame: (x, -z, y).
template <class Scalar>
Eigen::Matrix<Scalar, 3, 1> z_up_from_y_up(const Eigen::Matrix<Scalar, 3, 1>& v) {
  return {v[0], -v[2], v[1]};
}

}  // namespace detail

/// Turns a cloud so that z points up, with its normals.
inline void turn_z_up(cloud::cloud& cloud, up_axis from) {
  if (from == up_axis::z) return;
  cloud.origin = detail::z_up_from_y_up(cloud.origin);
  for (Eigen::Vector3f& p : cloud.points) p = detail::z_up_from_y_up(p);
  for (Eigen::Vector3f& n : cloud.normals) n = detail::z_up_from_y_up(n);
}

/// Turns a mesh so that z points up.
inline void turn_z_up(mesh::mesh& mesh, up_axis from) {
  if (from == up_axis::z) return;
  mesh.origin = detail::z_up_from_y_up(mesh.origin);
  for (Eigen::Vector3f& v : mesh.vertices) v = detail::z_up_from_y_up(v);
}

}  // namespace aib::io
