// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/isa.hpp>
#include <aib/depth/depth_map.hpp>
#include <aib/math/rigid3.hpp>
#include <aib/mesh/ray_surface.hpp>
#include <aib/render/hits.hpp>
#include <aib/render/view_rays.hpp>

namespace aib::render {

/// What the pixels of a depth map hold.
enum class depth_kind {
  planar,  ///< distance along the optical axis
  range,   ///< distance from the centre of the camera
};

/// Planar depth of a point; 0, which is no depth, beside and behind a camera of more than 180
/// degrees.
[[nodiscard]] inline float planar_depth(const Eigen::Vector3d& point_in_camera) {
  return point_in_camera.z() > 0 ? static_cast<float>(point_in_camera.z()) : 0;
}

inline namespace AIB_ISA {

/// The depth that a camera sees of a surface, sampled at pixel centres, 0 where it sees none.
/// Equals Blender's Z pass to the rounding of floats.
[[nodiscard]] inline depth::depth_map depth(const mesh::ray_surface& surface,
                                            const view_rays& rays,
                                            const math::rigid3& world_from_camera,
                                            depth_kind kind = depth_kind::planar,
                                            const cast_options& options = {}) {
  depth::depth_map map{raster::image<float>(rays.width(), rays.height())};
  for_each_hit(surface, rays, world_from_camera, options, [&](const pixel_hit& hit) {
    map.values(hit.x, hit.y) = kind == depth_kind::planar
                                   ? planar_depth(hit.point_in_camera)
                                   : static_cast<float>(hit.point_in_camera.norm());
  });
  return map;
}

}  // namespace AIB_ISA
}  // namespace aib::render
