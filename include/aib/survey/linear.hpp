// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/math/rotation.hpp>
#include <aib/survey/flight_path.hpp>
#include <aib/survey/lens.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace aib::survey {

struct linear_options {
  path_options path = {};
  Eigen::Vector3d from = Eigen::Vector3d::Zero();  ///< the axis of a truss, deck, cable or mast
  Eigen::Vector3d to = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> views = {};  ///< directions of sight; their part across the axis
  double width = 0;   ///< of the surface across the axis, as it is seen: flown in lanes
  double radius = 0;  ///< from the axis to the surface
};

/// Passes along an axis, for each view in turn, to and fro; between two views an arc about the
/// axis.
///
/// The first image has its up as near to z as may be; the camera turns about the axis from view to
/// view. A pitch looks down in the image and flies as much higher. Throws argument_error where the
/// axis has no length, there is no view or one lies along the axis, or an option is out of its
/// range.
[[nodiscard]] flight_path linear(const linear_options& options);

/// A path through points, straight between them, the direction of sight given at each and turned
/// evenly between. Throws argument_error unless there are two points or more and a view for each.
[[nodiscard]] flight_path along(const std::vector<Eigen::Vector3d>& points,
                                const std::vector<Eigen::Vector3d>& views,
                                const path_options& options);

namespace detail {

/// The part of a view across an axis, of unit length.
inline Eigen::Vector3d across(const Eigen::Vector3d& view, const Eigen::Vector3d& axis) {
  const Eigen::Vector3d part = view - axis.dot(view) * axis;
  if (!(part.norm() > 1e-6 * view.norm()))
    throw argument_error("survey::linear: views across the axis expected, found one along it");
  return part.normalized();
}

/// How far a frame reaches across the direction of flight.
inline double extent_across(const Eigen::Matrix3d& attitude,
                            const Eigen::Vector3d& aside,
                            const wall_frame& frame) {
  const double right = std::abs(attitude.col(0).dot(aside));
  const double down = std::abs(attitude.col(1).dot(aside));
  return 1 / std::max({right / frame.width, down / frame.height, 1e-12});
}

}  // namespace detail

inline flight_path linear(const linear_options& options) {
  check(options.path);
  const Eigen::Vector3d way = options.to - options.from;
  if (!(way.norm() > 0) || !way.allFinite() || options.views.empty() || !(options.radius >= 0) ||
      !(options.width >= 0)) {
    throw argument_error(
        "survey::linear: an axis of some length, a view or more, radius and width from 0 expected");
  }
  const Eigen::Vector3d axis = way.normalized();
  const double away = options.path.stand_off + options.radius;
  flight_path path{.camera = options.path.camera, .stand_off = options.path.stand_off, .n_rows = 0};
  const wall_frame frame = frame_on_wall(path.camera, path.stand_off);
  Eigen::Vector3d view = detail::across(options.views.front(), axis);
  Eigen::Matrix3d attitude =
      looking(view, std::abs(view.z()) < 0.99 ? Eigen::Vector3d::UnitZ() : axis.cross(view));
  Eigen::Vector3d up = -attitude.col(1);
  const double rise = options.path.stand_off * std::tan(options.path.pitch);
  const Eigen::Vector3d down(-options.path.pitch, 0, 0);
  attitude = attitude * math::rotation_from(down);
  bool is_back = false;     // flown from `to` to `from`
  bool from_right = false;  // lanes from the positive side
  for (const Eigen::Vector3d& wanted : options.views) {
    const Eigen::Vector3d next = detail::across(wanted, axis);
    const double angle = std::atan2(axis.dot(view.cross(next)), view.dot(next));
    if (!path.legs.empty() && angle != 0) {
      const math::rigid3 here = path.legs.back().at(1);
      const Eigen::Vector3d end = is_back ? options.to : options.from;
      path.legs.push_back(arc(here, end, axis, angle));
    }
    const Eigen::Vector3d swing = angle * axis;
    attitude = math::rotation_from(swing) * attitude;
    up = math::rotation_from(swing) * up;
    view = next;
    const Eigen::Vector3d aside = axis.cross(view);
    const row_places lanes =
        place_rows(-options.width / 2, options.width / 2,
                   detail::extent_across(attitude, aside, frame), options.path.overlap_across);
    for (std::size_t i = 0; i < lanes.offset.size(); ++i) {
      const double lane = lanes.offset[from_right ? lanes.offset.size() - 1 - i : i];
      const Eigen::Vector3d offset = lane * aside - away * view + rise * up;
      const math::rigid3 first{attitude, options.from + offset},
          last{attitude, options.to + offset};
      go_to(path, is_back ? last : first);
      path.legs.push_back(is_back ? line(last, first) : line(first, last));
      is_back = !is_back;
    }
    from_right = !from_right;
    path.n_rows += lanes.offset.size();
    path.overlap_across = std::min(path.overlap_across, lanes.overlap);
  }
  return path;
}

inline flight_path along(const std::vector<Eigen::Vector3d>& points,
                         const std::vector<Eigen::Vector3d>& views,
                         const path_options& options) {
  check(options);
  if (points.size() < 2 || points.size() != views.size()) {
    throw argument_error(
        message("survey::along: two points or more and a view each expected, found ", points.size(),
                " points and ", views.size(), " views"));
  }
  flight_path path{.camera = options.camera, .stand_off = options.stand_off};
  for (std::size_t i = 1; i < points.size(); ++i) {
    const leg l = line({looking(views[i - 1]), points[i - 1]}, {looking(views[i]), points[i]});
    if (l.length() > 0) path.legs.push_back(l);
  }
  return path;
}

}  // namespace aib::survey
