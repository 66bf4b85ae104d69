// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/cloud.hpp>
#include <aib/core/executor.hpp>
#include <aib/core/isa.hpp>
#include <aib/math/view.hpp>
#include <aib/mesh/ray_surface.hpp>
#include <aib/render/hits.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace aib::render {

using math::is_in_image;
using math::view;

struct visible_options {
  double tolerance = 0.001;  ///< what is nearer than a point by a smaller share of its distance
                             ///< does not hide it
  cast_options cast = {};
};

/// What views say of a point beside a surface.
enum class space_verdict : std::uint8_t {
  surface,  ///< it lies on the surface
  free,     ///< a view looks through it: nothing is there
  hidden,   ///< no view can tell
};

struct free_space_options {
  double tolerance = 0.05;  ///< on the surface is what is not farther from it, its unit
  cast_options cast = {};
};

inline namespace AIB_ISA {

/// How many views see each point: it lies in their image and the surface does not hide it.
[[nodiscard]] inline std::vector<std::uint32_t> n_views(const mesh::ray_surface& surface,
                                                        const cloud::cloud& points,
                                                        std::span<const view> views,
                                                        const visible_options& options = {}) {
  std::vector<std::uint32_t> n(points.size());
  const std::vector<math::view_cone> cones(views.begin(), views.end());
  for_each_chunk(points.size(), 64, options.cast.threads, options.cast.control,
                 [&](const chunk& c) {
                   for (std::size_t i = c.begin; i < c.end; ++i) {
                     const Eigen::Vector3d p = points.position(i);
                     for (std::size_t k = 0; k < views.size(); ++k) {
                       if (!cones[k].may_contain(p) || !is_in_image(views[k], p)) continue;
                       const Eigen::Vector3d& from = views[k].world_from_camera.translation;
                       const double tolerance = options.tolerance * (p - from).norm();
                       n[i] += surface.sees(from, p, tolerance) ? 1u : 0u;
                     }
                   }
                 });
  return n;
}

/// The verdict on each point of a cloud: points that hang in free space are phantoms.
///
/// distances   of the points to the surface, see mesh::distances
///
/// A point that is not finite is hidden. Throws argument_error unless there is a distance a point.
[[nodiscard]] inline std::vector<space_verdict> free_space(const mesh::ray_surface& surface,
                                                           const cloud::cloud& points,
                                                           std::span<const float> distances,
                                                           std::span<const view> views,
                                                           const free_space_options& options = {}) {
  if (distances.size() != points.size()) {
    throw argument_error(message("render::free_space: ", points.size(), " points, ",
                                 distances.size(), " distances: one of each expected"));
  }
  const std::vector<math::view_cone> cones(views.begin(), views.end());
  const auto is_looked_through = [&](const Eigen::Vector3d& p) {
    for (std::size_t k = 0; k < views.size(); ++k) {
      if (cones[k].may_contain(p) && is_in_image(views[k], p) &&
          surface.sees(views[k].world_from_camera.translation, p, 0)) {
        return true;
      }
    }
    return false;
  };
  std::vector<space_verdict> verdicts(points.size(), space_verdict::hidden);
  for_each_chunk(points.size(), 64, options.cast.threads, options.cast.control,
                 [&](const chunk& c) {
                   for (std::size_t i = c.begin; i < c.end; ++i) {
                     const Eigen::Vector3d p = points.position(i);
                     if (static_cast<double>(distances[i]) <= options.tolerance)
                       verdicts[i] = space_verdict::surface;
                     else if (is_looked_through(p))
                       verdicts[i] = space_verdict::free;
                   }
                 });
  return verdicts;
}

}  // namespace AIB_ISA
}  // namespace aib::render
