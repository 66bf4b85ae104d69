// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/math/camera.hpp>
#include <aib/raster/view.hpp>

#include <cmath>
#include <cstddef>

namespace aib::io {

/// Turns distances along the rays of pixel centres into planar depth, in place.
///
/// camera   intrinsics without distortion; where its size is another than that of the map, they are
///          scaled with each side
///
/// Throws argument_error for a camera with distortion or without a size.
inline void planar_from_range(raster::view<float> range, const math::camera& camera) {
  using enum math::camera_model;
  if (camera.model != pinhole && camera.model != simple_pinhole)
    throw argument_error(message("range: a pinhole camera expected, found ",
                                 math::info(camera.model).name, "; undistort the map first"));
  if (camera.width == 0 || camera.height == 0 || !(camera.fx() > 0) || !(camera.fy() > 0))
    throw argument_error("range: a camera with a size and focal lengths > 0 expected");
  const double scale_x = static_cast<double>(camera.width) / static_cast<double>(range.width);
  const double scale_y = static_cast<double>(camera.height) / static_cast<double>(range.height);
  for (std::size_t y = 0; y < range.height; ++y) {
    const double v = ((static_cast<double>(y) + 0.5) * scale_y - camera.cy()) / camera.fy();
    for (std::size_t x = 0; x < range.width; ++x) {
      const double u = ((static_cast<double>(x) + 0.5) * scale_x - camera.cx()) / camera.fx();
      float& value = range(x, y);
      value = static_cast<float>(static_cast<double>(value) / std::sqrt(1 + u * u + v * v));
    }
  }
}

}  // namespace aib::io
