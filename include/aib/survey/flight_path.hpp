// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/math/camera.hpp>
#include <aib/math/rigid3.hpp>
#include <aib/math/rotation.hpp>
#include <aib/survey/lens.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace aib::survey {

/// Attitude of a camera that looks along `forward`, the image's up as near to `up` as may be. Where
/// the two are parallel, x (else y) of the world takes the place of `up`.
[[nodiscard]] inline Eigen::Matrix3d looking(const Eigen::Vector3d& forward,
                                             const Eigen::Vector3d& up = Eigen::Vector3d::UnitZ()) {
  const Eigen::Vector3d ahead = forward.normalized();
  Eigen::Vector3d right = ahead.cross(up.normalized());
  if (!(right.norm() > 1e-6)) right = ahead.cross(Eigen::Vector3d::UnitX());
  if (!(right.norm() > 1e-6)) right = ahead.cross(Eigen::Vector3d::UnitY());
  right.normalize();
  Eigen::Matrix3d attitude;
  attitude << right, ahead.cross(right), ahead;
  return attitude;
}

/// A piece of a path: a line, an arc or a helix, on which the camera turns evenly.
///
/// At a share u the camera is at centre + R(u angle about axis) arm + u shift.
struct leg {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Vector3d arm = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< of unit length
  double angle = 0;                                 ///< radians
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
  Eigen::Matrix3d attitude = Eigen::Matrix3d::Identity();  ///< world from camera, at the beginning
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();          ///< axis times angle, over the leg

  [[nodiscard]] math::rigid3 at(double share) const {
    const Eigen::Vector3d swing = share * angle * axis, part = share * turn;
    return {math::rotation_from(part) * attitude,
            centre + math::rotation_from(swing) * arm + share * shift};
  }
  [[nodiscard]] double length() const {
    return std::hypot(angle * (arm - axis.dot(arm) * axis).norm(), shift.norm());
  }
  /// The part between two shares.
  [[nodiscard]] leg part(double from, double to) const {
    const double share = to - from;
    const Eigen::Vector3d swing = from * angle * axis;
    return {centre + from * shift,
            math::rotation_from(swing) * arm,
            axis,
            share * angle,
            share * shift,
            at(from).rotation,
            share * turn};
  }
  [[nodiscard]] leg reversed() const {
    const math::rigid3 end = at(1);
    const Eigen::Vector3d swing = angle * axis;
    return {centre + shift, math::rotation_from(swing) * arm, axis, -angle, -shift, end.rotation,
            -turn};
  }
};

/// A straight leg between two poses.
[[nodiscard]] inline leg line(const math::rigid3& from, const math::rigid3& to) {
  leg l;
  l.centre = from.translation;
  l.shift = to.translation - from.translation;
  l.attitude = from.rotation;
  l.turn = math::axis_angle_from(to.rotation * from.rotation.transpose());
  return l;
}

/// An arc on which the camera keeps its attitude to the axis.
[[nodiscard]] inline leg arc(const math::rigid3& from,
                             const Eigen::Vector3d& centre,
                             const Eigen::Vector3d& axis,
                             double angle) {
  leg l;
  l.centre = centre;
  l.arm = from.translation - centre;
  l.axis = axis.normalized();
  l.angle = angle;
  l.attitude = from.rotation;
  l.turn = angle * l.axis;
  return l;
}

/// Where a camera flies and looks, before frames are placed on it.
struct flight_path {
  std::vector<leg> legs = {};
  math::camera camera = {};
  double stand_off = 0;       ///< planned distance to the surface
  double overlap_across = 1;  ///< of neighbouring rows as planned; 1 where there is one row
  std::size_t n_rows = 1;
  bool is_closed = false;  ///< the end is the beginning: the last frame comes before it

  [[nodiscard]] double length() const {
    double sum = 0;
    for (const leg& l : legs) sum += l.length();
    return sum;
  }
  /// The pose at a share of the length.
  [[nodiscard]] math::rigid3 at(double share) const {
    if (legs.empty()) throw argument_error("survey::flight_path: an empty path");
    double left = std::clamp(share, 0.0, 1.0) * length();
    for (const leg& l : legs) {
      const double n = l.length();
      if (left <= n && n > 0) return l.at(left / n);
      left -= n;
    }
    return legs.back().at(1);
  }
  [[nodiscard]] flight_path reversed() const {
    flight_path back = *this;
    back.legs.clear();
    for (auto l = legs.rbegin(); l != legs.rend(); ++l) back.legs.push_back(l->reversed());
    return back;
  }
};

/// Adds a leg from the path's end to a pose; none where they are the same place.
inline void go_to(flight_path& path, const math::rigid3& to) {
  if (path.legs.empty()) return;
  const leg way = line(path.legs.back().at(1), to);
  if (way.length() > 1e-9) path.legs.push_back(way);
}

/// What every path is planned with.
struct path_options {
  math::camera camera = camera_of({});
  double stand_off = 0;         ///< distance to the surface, above 0
  double overlap_across = 0.8;  ///< of neighbouring rows, 0 .. 1
  double pitch = 0;             ///< radians, positive looks down
};

/// Throws argument_error where an option is out of its range.
inline void check(const path_options& o) {
  if (!(o.stand_off > 0) || !std::isfinite(o.stand_off))
    throw argument_error(message("survey: a stand-off above 0 expected, found ", o.stand_off));
  if (!(o.overlap_across >= 0 && o.overlap_across < 1)) {
    throw argument_error(
        message("survey: an overlap of 0 to below 1 expected, found ", o.overlap_across));
  }
  if (!(std::abs(o.pitch) < 1.5))
    throw argument_error("survey: a pitch between -86 and 86 degrees expected");
}

/// Places of rows: offsets of frames of an extent that cover a range with at least an overlap.
struct row_places {
  std::vector<double> offset;
  double overlap = 1;  ///< as it comes out; 1 where there is one row
};
[[nodiscard]] inline row_places place_rows(double low, double high, double extent, double overlap) {
  const double free = high - low - extent;
  if (!(free > 1e-9 * extent)) return {{(low + high) / 2}, 1};
  const double n = std::ceil(free / ((1 - overlap) * extent) - 1e-9);
  if (!(n < 1e6)) throw argument_error("survey: more than a million rows");
  row_places rows{{}, 1 - free / n / extent};
  for (double i = 0; i <= n; ++i) rows.offset.push_back(low + extent / 2 + i / n * free);
  return rows;
}

/// Paths one after another, joined by straight legs on which the view turns evenly. Camera and
/// stand-off are those of the first, the overlap the least of all.
[[nodiscard]] inline flight_path join(const std::vector<flight_path>& paths) {
  if (paths.empty()) throw argument_error("survey::join: at least one path expected");
  flight_path all = paths.front();
  if (paths.size() > 1) all.is_closed = false;
  for (std::size_t i = 1; i < paths.size(); ++i) {
    const flight_path& next = paths[i];
    if (next.legs.empty()) continue;
    go_to(all, next.legs.front().at(0));
    all.legs.insert(all.legs.end(), next.legs.begin(), next.legs.end());
    all.overlap_across = std::min(all.overlap_across, next.overlap_across);
    all.n_rows += next.n_rows;
  }
  return all;
}

}  // namespace aib::survey
