// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

namespace aib::math {

inline constexpr double degrees_per_radian = 180 / std::numbers::pi;

/// Angle in degrees of an angle in radians.
[[nodiscard]] constexpr double degrees(double radians) { return radians * degrees_per_radian; }

/// Angle in radians of an angle in degrees.
[[nodiscard]] constexpr double radians(double degrees) { return degrees / degrees_per_radian; }

/// Unit quaternion, Hamilton convention, scalar first. Has no alignment demands, unlike Eigen's.
struct quaternion {
  double w = 1;
  double x = 0;
  double y = 0;
  double z = 0;
};

/// Rotation matrix of a quaternion of any length > 0.
/// Throws argument_error if the quaternion is zero or not finite.
Eigen::Matrix3d rotation_from(const quaternion& q);

/// Unit quaternion of a rotation matrix, w >= 0.
quaternion quaternion_from(const Eigen::Matrix3d& rotation);

/// Rotation by the length of `axis_angle` (radians) about its direction.
Eigen::Matrix3d rotation_from(const Eigen::Vector3d& axis_angle);

/// Axis times angle in radians, angle in [0, pi].
Eigen::Vector3d axis_angle_from(const Eigen::Matrix3d& rotation);

/// Geodesic angle of a rotation in radians, [0, pi]; accurate near 0 and near pi.
double rotation_angle(const Eigen::Matrix3d& rotation);

inline Eigen::Matrix3d rotation_from(const quaternion& q) {
  const double norm = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  if (!(norm > 0) || !std::isfinite(norm)) {
    throw argument_error(message("math::rotation_from: quaternion (", q.w, ", ", q.x, ", ", q.y,
                                 ", ", q.z, ") has no direction"));
  }
  return Eigen::Quaterniond(q.w / norm, q.x / norm, q.y / norm, q.z / norm).toRotationMatrix();
}

inline quaternion quaternion_from(const Eigen::Matrix3d& rotation) {
  Eigen::Quaterniond q(rotation);
  q.normalize();
  const double sign = q.w() < 0 ? -1 : 1;
  return {sign * q.w(), sign * q.x(), sign * q.y(), sign * q.z()};
}

inline Eigen::Matrix3d rotation_from(const Eigen::Vector3d& axis_angle) {
  const double angle = axis_angle.norm();
  if (angle == 0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, axis_angle / angle).toRotationMatrix();
}

inline Eigen::Vector3d axis_angle_from(const Eigen::Matrix3d& rotation) {
  const quaternion q = quaternion_from(rotation);
  const Eigen::Vector3d v(q.x, q.y, q.z);
  const double length = v.norm();
  if (length == 0) return Eigen::Vector3d::Zero();
  return v * (2 * std::atan2(length, q.w) / length);
}

inline double rotation_angle(const Eigen::Matrix3d& rotation) {
  const quaternion q = quaternion_from(rotation);
  return 2 * std::atan2(std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z), q.w);
}

}  // namespace aib::math
