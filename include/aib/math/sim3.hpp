// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/math/rigid3.hpp>

#include <Eigen/Core>

namespace aib::math {

/// Similarity of space: `p_in_b = scale * rotation * p_in_a + translation`.
struct sim3 {
  double scale = 1;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  [[nodiscard]] sim3 inverse() const {
    const Eigen::Matrix3d r = rotation.transpose();
    return {1 / scale, r, -(r * translation) / scale};
  }
  [[nodiscard]] Eigen::Matrix4d matrix() const {
    Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
    m.topLeftCorner<3, 3>() = scale * rotation;
    m.topRightCorner<3, 1>() = translation;
    return m;
  }

  friend sim3 operator*(const sim3& c_from_b, const sim3& b_from_a) {
    return {c_from_b.scale * b_from_a.scale, c_from_b.rotation * b_from_a.rotation,
            c_from_b * b_from_a.translation};
  }
  friend Eigen::Vector3d operator*(const sim3& b_from_a, const Eigen::Vector3d& p_in_a) {
    return b_from_a.scale * (b_from_a.rotation * p_in_a) + b_from_a.translation;
  }
  /// Moves a pose: its position as a point, its axes by the rotation alone.
  friend rigid3 operator*(const sim3& b_from_a, const rigid3& a_from_camera) {
    return {b_from_a.rotation * a_from_camera.rotation, b_from_a * a_from_camera.translation};
  }
};

}  // namespace aib::math
