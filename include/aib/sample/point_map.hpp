// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/origin.hpp>
#include <aib/core/error.hpp>
#include <aib/core/executor.hpp>
#include <aib/depth/depth_map.hpp>
#include <aib/math/rigid3.hpp>
#include <aib/sample/unproject.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <span>
#include <utility>

namespace aib::sample {

/// The points of a point map, as pi3 and DUSt3R predict them, in world frame.
///
/// xyz                height * width points in the frame of the camera, row by row; one is valid
///                    where its z is a valid depth and x and y are finite
/// world_from_camera  the identity for maps in world frame, whose z is above 0 then
/// options            confidence, min_confidence, rule and stride; the others have no meaning
///
/// Throws argument_error as unproject does, and where the numbers are not that many.
[[nodiscard]] inline unprojected place_point_map(std::span<const float> xyz,
                                                 std::size_t width,
                                                 std::size_t height,
                                                 const math::rigid3& world_from_camera,
                                                 const unproject_options& options = {}) {
  if (xyz.size() != width * height * 3) {
    throw argument_error(message("sample::place_point_map: ", width, "x", height,
                                 " points expected, found ", xyz.size(), " numbers"));
  }
  depth::depth_map z{raster::image<float>(width, height)};
  for (std::size_t k = 0; k < width * height; ++k) z.values.data()[k] = xyz[3 * k + 2];
  detail::check(z, world_from_camera, options);
  std::optional<double> threshold;
  if (options.confidence.data) threshold = detail::confidence_threshold(z, options);
  const Eigen::Vector3d& centre = world_from_camera.translation;
  unprojected made{};
  made.points.origin = cloud::natural_origin(centre);
  for (std::size_t y = 0; y < height; y += options.stride) {
    demand_go(options.control);
    for (std::size_t x = 0; x < width; x += options.stride) {
      const float* at = xyz.data() + 3 * (y * width + x);
      const Eigen::Vector3d p_in_camera = Eigen::Map<const Eigen::Vector3f>(at).cast<double>();
      if (!depth::is_valid(at[2]) || !p_in_camera.allFinite()) continue;
      ++made.n_valid;
      if (threshold && !(options.confidence(x, y) > *threshold)) {
        ++made.n_unsure;
        continue;
      }
      const Eigen::Vector3d p = world_from_camera * p_in_camera - made.points.origin;
      made.points.points.push_back(p.cast<float>());
    }
  }
  return made;
}

}  // namespace aib::sample
