// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/core/isa.hpp>
#include <aib/depth/depth_map.hpp>
#include <aib/math/rigid3.hpp>
#include <aib/mesh/ray_surface.hpp>
#include <aib/raster/color.hpp>
#include <aib/raster/image.hpp>
#include <aib/render/depth.hpp>
#include <aib/render/hits.hpp>
#include <aib/render/view_rays.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>

namespace aib::render {

/// Everything that a camera sees of a surface, h x w each.
struct frame {
  depth::depth_map depth;  ///< planar, 0 where nothing is seen
  depth::depth_map range;  ///< from the camera's centre, 0 where nothing is seen
  raster::image<Eigen::Vector3f>
      normals;                 ///< unit, in the camera, towards it; 0 where there is none
  raster::label_image labels;  ///< of the faces; `background` where nothing is seen

  [[nodiscard]] std::size_t n_seen() const;
};

struct frame_options {
  std::uint16_t background = 65535;  ///< label where nothing is seen
  cast_options cast = {};
};

inline std::size_t frame::n_seen() const {
  std::size_t n = 0;
  for (const float r : range.values) n += r > 0 ? 1u : 0u;
  return n;
}

inline namespace AIB_ISA {

/// Depth, range, normals and labels of one cast.
/// Throws argument_error if a label that is seen is above 65535.
[[nodiscard]] inline frame cast_frame(const mesh::ray_surface& surface,
                                      const view_rays& rays,
                                      const math::rigid3& world_from_camera,
                                      const frame_options& options = {}) {
  const std::size_t w = rays.width(), h = rays.height();
  frame f{{raster::image<float>(w, h)},
          {raster::image<float>(w, h)},
          raster::image<Eigen::Vector3f>(w, h, Eigen::Vector3f::Zero()),
          raster::label_image(w, h, options.background)};
  const Eigen::Matrix3d camera_from_world = world_from_camera.rotation.transpose();
  for_each_hit(surface, rays, world_from_camera, options.cast, [&](const pixel_hit& hit) {
    const Eigen::Vector3d& p = hit.point_in_camera;
    f.depth.values(hit.x, hit.y) = planar_depth(p);
    f.range.values(hit.x, hit.y) = static_cast<float>(p.norm());
    const Eigen::Vector3d normal = camera_from_world * surface.normal_at(hit.place);
    const double side = normal.dot(p) > 0 ? -1 : 1;
    f.normals(hit.x, hit.y) = (side * normal).cast<float>();
    const std::uint32_t label = surface.label_at(hit.place);
    if (label > 65535)
      throw argument_error(message("render::cast_frame: label ", label, " is above 65535"));
    f.labels(hit.x, hit.y) = static_cast<std::uint16_t>(label);
  });
  return f;
}

}  // namespace AIB_ISA
}  // namespace aib::render
