// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/cloud.hpp>
#include <aib/core/executor.hpp>
#include <aib/core/isa.hpp>
#include <aib/math/camera.hpp>
#include <aib/math/projection.hpp>
#include <aib/math/rigid3.hpp>
#include <aib/mesh/ray_surface.hpp>
#include <aib/render/hits.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace aib::render {

/// A camera where it stands.
struct view {
  math::camera camera;
  math::rigid3 world_from_camera;
};

/// Whether a point lies in the image of a view, whatever may be before it. A pose that is not
/// finite sees nothing.
[[nodiscard]] inline bool is_in_image(const view& v, const Eigen::Vector3d& point) {
  const Eigen::Vector3d offset = point - v.world_from_camera.translation;
  const auto pixel = math::project(v.camera, v.world_from_camera.rotation.transpose() * offset);
  return pixel && pixel->x() >= 0 && pixel->y() >= 0 &&
         pixel->x() <= static_cast<double>(v.camera.width) &&
         pixel->y() <= static_cast<double>(v.camera.height);
}

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
  for_each_chunk(points.size(), 64, options.cast.threads, options.cast.control,
                 [&](const chunk& c) {
                   for (std::size_t i = c.begin; i < c.end; ++i) {
                     const Eigen::Vector3d p = points.position(i);
                     for (const view& v : views) {
                       if (!is_in_image(v, p)) continue;
                       const Eigen::Vector3d& from = v.world_from_camera.translation;
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
  const auto looks_through = [&](const view& v, const Eigen::Vector3d& p) {
    return is_in_image(v, p) && surface.sees(v.world_from_camera.translation, p, 0);
  };
  std::vector<space_verdict> verdicts(points.size(), space_verdict::hidden);
  for_each_chunk(points.size(), 64, options.cast.threads, options.cast.control,
                 [&](const chunk& c) {
                   for (std::size_t i = c.begin; i < c.end; ++i) {
                     const Eigen::Vector3d p = points.position(i);
                     if (static_cast<double>(distances[i]) <= options.tolerance)
                       verdicts[i] = space_verdict::surface;
                     else if (std::any_of(views.begin(), views.end(),
                                          [&](const view& v) { return looks_through(v, p); }))
                       verdicts[i] = space_verdict::free;
                   }
                 });
  return verdicts;
}

}  // namespace AIB_ISA
}  // namespace aib::render
