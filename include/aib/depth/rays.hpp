// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/math/camera.hpp>
#include <aib/math/projection.hpp>
#include <aib/raster/image.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <limits>

namespace aib::depth {

/// Where the pixels of a map look: (x / z, y / z) in the camera, NaN where it sees nothing in
/// front. The point of a pixel is `depth * (ray.x, ray.y, 1)`.
using ray_image = raster::image<Eigen::Vector2d>;

/// The rays through the pixel centres of a map of width x height. Where the camera says another
/// size, pixels are scaled to it.
[[nodiscard]] inline ray_image rays(const math::camera& camera,
                                    std::size_t width,
                                    std::size_t height) {
  const auto per_pixel = [](std::uint64_t of_camera, std::size_t of_map) {
    return of_camera > 0 ? static_cast<double>(of_camera) / static_cast<double>(of_map) : 1;
  };
  const double scale_x = per_pixel(camera.width, width), scale_y = per_pixel(camera.height, height);
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  ray_image image(width, height, Eigen::Vector2d(nan, nan));
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      const Eigen::Vector2d pixel((static_cast<double>(x) + 0.5) * scale_x,
                                  (static_cast<double>(y) + 0.5) * scale_y);
      const auto direction = math::unproject(camera, pixel);
      if (direction && direction->z() > 0) image(x, y) = direction->head<2>() / direction->z();
    }
  }
  return image;
}

/// The point of a pixel, in the camera.
[[nodiscard]] inline Eigen::Vector3d point_at(const Eigen::Vector2d& ray, double depth) {
  return {ray.x() * depth, ray.y() * depth, depth};
}

}  // namespace aib::depth
