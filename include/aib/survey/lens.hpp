// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/math/camera.hpp>

#include <cmath>
#include <cstdint>

namespace aib::survey {

/// A camera as its data sheet tells it; the defaults are the paper's.
struct lens {
  double focal_mm = 50;
  double sensor_mm = 36;  ///< width of the sensor
  std::uint64_t width = 1920;
  std::uint64_t height = 1080;
};

/// The pinhole camera of a lens: square pixels, the principal point in the middle.
/// Throws argument_error where something is not positive.
[[nodiscard]] inline math::camera camera_of(const lens& l) {
  if (!(l.focal_mm > 0) || !(l.sensor_mm > 0) || l.width == 0 || l.height == 0) {
    throw argument_error(message("survey::camera_of: focal length, sensor and size above 0 ",
                                 "expected, found ", l.focal_mm, " mm, ", l.sensor_mm, " mm, ",
                                 l.width, "x", l.height));
  }
  const auto w = static_cast<double>(l.width), h = static_cast<double>(l.height);
  const double f = l.focal_mm / l.sensor_mm * w;
  return math::pinhole(l.width, l.height, f, f, w / 2, h / 2);
}

/// The part of a wall that a camera sees when it looks straight at it.
struct wall_frame {
  double width, height;
};
[[nodiscard]] inline wall_frame frame_on_wall(const math::camera& c, double stand_off) {
  return {stand_off * static_cast<double>(c.width) / c.fx(),
          stand_off * static_cast<double>(c.height) / c.fy()};
}

/// Ground sampling distance: the size of a pixel on a wall at a distance, in the unit of that.
[[nodiscard]] inline double ground_sampling(const math::camera& c, double stand_off) {
  return stand_off / c.fx();
}

}  // namespace aib::survey
