// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/survey/facade.hpp>
#include <aib/survey/flight_path.hpp>
#include <aib/survey/lens.hpp>

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <utility>

namespace aib::survey {

struct orbit_options {
  path_options path = {};  ///< stand_off counts for the rows and for frames, not for the circle
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double radius = 0;
  double low = 0, high = 0;             ///< heights of the lowest and of the highest circle
  std::optional<double> look_at = {};   ///< height on the axis; else by the pitch
  double start = 0;                     ///< radians, azimuth of the first pose, 0 = +x
  double sweep = 2 * std::numbers::pi;  ///< radians, anticlockwise from above
};

/// Circles about a vertical axis, flown to and fro, looking at the axis.
/// Throws argument_error where an option is out of its range.
[[nodiscard]] inline flight_path orbit(const orbit_options& options) {
  check(options.path);
  if (!(options.radius > 0) || !(options.low <= options.high) || !(options.sweep > 0) ||
      options.sweep > 2 * std::numbers::pi + 1e-9)
    throw argument_error(
        "survey::orbit: a radius above 0, low <= high and a sweep of up to 360 degrees expected");
  const double height = frame_on_wall(options.path.camera, options.path.stand_off).height;
  const row_places rows = place_rows(options.low - height / 2, options.high + height / 2, height,
                                     options.path.overlap_across);
  flight_path path{
      .camera = options.path.camera,
      .stand_off = options.path.stand_off,
      .overlap_across = rows.overlap,
      .n_rows = rows.offset.size(),
      .is_closed = rows.offset.size() == 1 && options.sweep > 2 * std::numbers::pi - 1e-9};
  const Eigen::Vector3d outwards(std::cos(options.start), std::sin(options.start), 0);
  double from = 0, sweep = options.sweep;
  for (const double z : rows.offset) {
    const Eigen::Vector3d axis_point(options.centre.x(), options.centre.y(), z);
    const double drop =
        options.look_at ? std::atan2(z - *options.look_at, options.radius) : options.path.pitch;
    const Eigen::Vector3d view =
        -std::cos(drop) * outwards - std::sin(drop) * Eigen::Vector3d::UnitZ();
    const math::rigid3 first{looking(view), axis_point + options.radius * outwards};
    leg circle = arc(first, axis_point, Eigen::Vector3d::UnitZ(), options.sweep);
    if (from > 0) circle = circle.reversed();
    go_to(path, circle.at(0));
    path.legs.push_back(circle);
    std::swap(from, sweep);
  }
  return path;
}

}  // namespace aib::survey
