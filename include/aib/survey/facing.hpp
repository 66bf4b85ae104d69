// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/math/camera.hpp>
#include <aib/math/rigid3.hpp>
#include <aib/mesh/ray_surface.hpp>
#include <aib/survey/footprint.hpp>
#include <aib/survey/lens.hpp>

#include <Eigen/Core>

#include <cstdint>
#include <optional>
#include <vector>

namespace aib::survey {

/// The direction that would face the surface in the middle half of an image: against the mean of
/// its normals at 3 x 3 points, of unit length. Nothing where they see no face with these labels
/// (none: all) within a distance, or the camera has no focal length.
[[nodiscard]] inline std::optional<Eigen::Vector3d> facing_direction(
    const math::rigid3& world_from_camera,
    const math::camera& camera,
    const mesh::ray_surface& surface,
    double max_distance,
    const std::vector<std::uint32_t>& labels = {}) {
  if (!camera.has_focal()) return std::nullopt;
  const wall_frame frame = frame_on_wall(camera, 1);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const double x : {-0.25, 0.0, 0.25}) {
    for (const double y : {-0.25, 0.0, 0.25}) {
      const Eigen::Vector3d in_camera(x * frame.width, y * frame.height, 1);
      const Eigen::Vector3d ray = world_from_camera.rotation * in_camera.normalized();
      const auto hit = surface.first_hit(world_from_camera.translation, ray, max_distance);
      if (!hit || !is_among(surface.label_at(hit->place), labels)) continue;
      const Eigen::Vector3d normal = surface.normal_at(hit->place);
      sum += normal.dot(ray) > 0 ? normal : Eigen::Vector3d(-normal);
    }
  }
  if (!(sum.norm() > 1e-6)) return std::nullopt;
  return sum.normalized();
}

}  // namespace aib::survey
