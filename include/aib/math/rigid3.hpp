// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/math/rotation.hpp>

#include <Eigen/Core>

namespace aib::math {

/// Rigid motion of space: `b_from_a * p_in_a = p_in_b`.
struct rigid3 {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  [[nodiscard]] rigid3 inverse() const {
    return {rotation.transpose(), -(rotation.transpose() * translation)};
  }
  [[nodiscard]] bool is_finite() const { return rotation.allFinite() && translation.allFinite(); }
  [[nodiscard]] Eigen::Matrix4d matrix() const {
    Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
    m.topLeftCorner<3, 3>() = rotation;
    m.topRightCorner<3, 1>() = translation;
    return m;
  }

  /// c_from_a = c_from_b * b_from_a
  friend rigid3 operator*(const rigid3& c_from_b, const rigid3& b_from_a) {
    return {c_from_b.rotation * b_from_a.rotation,
            c_from_b.rotation * b_from_a.translation + c_from_b.translation};
  }
  friend Eigen::Vector3d operator*(const rigid3& b_from_a, const Eigen::Vector3d& p_in_a) {
    return b_from_a.rotation * p_in_a + b_from_a.translation;
  }
};

}  // namespace aib::math
