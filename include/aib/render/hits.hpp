// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/executor.hpp>
#include <aib/core/isa.hpp>
#include <aib/math/rigid3.hpp>
#include <aib/mesh/ray_surface.hpp>
#include <aib/render/view_rays.hpp>
#include <aib/search/ray_fan.hpp>
#include <aib/search/ray_trace.hpp>
#include <aib/search/ray_triangles.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>

namespace aib::render {

/// How frames are cast. The result is the same for any number of threads.
struct cast_options {
  unsigned threads = 0;  ///< 0: all
  aib::control control = {};
};

/// What the ray of a pixel hits.
struct pixel_hit {
  std::size_t x, y;
  std::uint32_t place;              ///< of the triangle, see mesh::ray_surface
  Eigen::Vector3d point_in_camera;  ///< x right, y down, z forward
};

inline namespace AIB_ISA {

/// Calls `visit(const pixel_hit&)` for every pixel that sees the surface, from several threads at
/// once and in any order. The triangle is found in floats, the point on it calculated in doubles.
///
/// Throws stopped_error when `control.stop` was requested.
template <class Visit>
void for_each_hit(const mesh::ray_surface& surface,
                  const view_rays& rays,
                  const math::rigid3& world_from_camera,
                  const cast_options& options,
                  Visit&& visit) {
  const search::ray_tree& tree = surface.tree();
  const Eigen::Vector3d origin = world_from_camera.translation - surface.origin();
  const Eigen::Matrix3d camera_from_world = world_from_camera.rotation.transpose();
  for_each_chunk(rays.squares().size(), 256, options.threads, options.control, [&](const chunk& c) {
    for (std::size_t i = c.begin; i < c.end; ++i) {
      const view_rays::square& square = rays.squares()[i];
      const search::ray_frame frame{origin, square.axes * camera_from_world};
      const search::fan_hits hits = search::trace(tree, frame, square.fan);
      for (std::size_t lane = 0; lane < search::ray_fan::lanes; ++lane) {
        const std::uint32_t place = hits.place[lane];
        if (place == search::fan_hits::none) continue;
        const Eigen::Vector3d ray(static_cast<double>(square.fan.slope[0][lane]),
                                  static_cast<double>(square.fan.slope[1][lane]), 1);
        const Eigen::Vector3d in_world = frame.axes.transpose() * ray;
        const Eigen::Vector3d in_camera = square.axes.transpose() * ray;
        const double distance = search::forward_distance(frame, in_world, tree.triangle(place));
        visit(pixel_hit{square.x + view_rays::square::column(lane),
                        square.y + view_rays::square::row(lane), place, distance * in_camera});
      }
    }
  });
  for (const view_rays::stray& s : rays.strays()) {
    const Eigen::Vector3d in_world = world_from_camera.rotation * s.direction;
    const auto hit = search::first_hit(tree, origin, in_world);
    if (hit) visit(pixel_hit{s.x, s.y, hit->place, hit->distance * s.direction});
  }
}

}  // namespace AIB_ISA
}  // namespace aib::render
