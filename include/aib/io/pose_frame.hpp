// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/math/nearest_rotation.hpp>
#include <aib/math/rigid3.hpp>
#include <aib/math/rotation.hpp>

#include <Eigen/Core>
#include <Eigen/LU>

#include <limits>
#include <optional>
#include <span>

namespace aib::io {

/// Which way a written pose maps points.
enum class pose_convention { world_from_camera, camera_from_world };

/// Axes of a camera. opencv: x right, y down, z forward. opengl: x right, y up, z backward.
enum class camera_axes { opencv, opengl };

/// How a file writes its poses; the defaults are the house's own frame.
struct pose_frame {
  pose_convention convention = pose_convention::world_from_camera;
  camera_axes axes = camera_axes::opencv;
};

/// [A | t], the upper rows of a 4 x 4 pose matrix.
using pose_matrix = Eigen::Matrix<double, 3, 4>;

/// The upper rows of a matrix written by rows, of which the first 12 numbers are used.
[[nodiscard]] inline pose_matrix matrix_of_rows(std::span<const double> numbers) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(numbers.data());
}

/// A written rotation further than this from a rotation (Frobenius norm) is refused.
inline constexpr double max_rotation_residual = 1e-2;

/// A pose that says "not registered".
[[nodiscard]] math::rigid3 unregistered_pose();

/// The pose that a matrix written in `frame` stands for, in the house's frame.
///
/// The camera centre is taken from the matrix as written (t, or -A^T t), then A is replaced by the
/// nearest rotation. A matrix that is not finite gives an unregistered pose.
/// Throws argument_error where A is mirrored or further than `max_rotation_residual` from a
/// rotation.
[[nodiscard]] math::rigid3 pose_from_matrix(const pose_matrix& matrix,
                                            const pose_frame& frame = {});

/// The same for a quaternion of any length and a translation.
/// Throws argument_error where the quaternion is zero.
[[nodiscard]] math::rigid3 pose_from_quaternion(const math::quaternion& rotation,
                                                const Eigen::Vector3d& translation,
                                                const pose_frame& frame = {});

/// The pose as it is written in `frame`.
[[nodiscard]] math::rigid3 pose_in_frame(const math::rigid3& world_from_camera,
                                         const pose_frame& frame);

namespace detail {

/// Turns y and z of the camera about: OpenGL's axes become OpenCV's and the reverse.
inline void flip_axes(math::rigid3& world_from_camera) {
  world_from_camera.rotation.rightCols<2>() *= -1;
}

}  // namespace detail

inline math::rigid3 unregistered_pose() {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  return {Eigen::Matrix3d::Constant(nan), Eigen::Vector3d::Constant(nan)};
}

inline math::rigid3 pose_from_matrix(const pose_matrix& matrix, const pose_frame& frame) {
  if (!matrix.allFinite()) return unregistered_pose();
  const Eigen::Matrix3d written = matrix.leftCols<3>();
  const auto nearest = math::nearest_rotation(written);
  if (!nearest) {
    throw argument_error(
        message("the rotation part has determinant ", written.determinant(), ", 1 expected"));
  }
  if (nearest->residual > max_rotation_residual) {
    throw argument_error(message("the rotation part lies ", nearest->residual,
                                 " from a rotation, at most ", max_rotation_residual, " expected"));
  }
  math::rigid3 pose{nearest->rotation, matrix.col(3)};
  if (frame.convention == pose_convention::camera_from_world) {
    pose.rotation.transposeInPlace();
    pose.translation = -(written.transpose() * matrix.col(3));
  }
  if (frame.axes == camera_axes::opengl) detail::flip_axes(pose);
  return pose;
}

inline math::rigid3 pose_from_quaternion(const math::quaternion& q,
                                         const Eigen::Vector3d& translation,
                                         const pose_frame& frame) {
  const Eigen::Vector4d parts(q.w, q.x, q.y, q.z);
  if (!parts.allFinite() || !translation.allFinite()) return unregistered_pose();
  if (!(parts.squaredNorm() > 0)) throw argument_error("the quaternion is zero");
  math::rigid3 pose{math::rotation_from(q), translation};
  if (frame.convention == pose_convention::camera_from_world) pose = pose.inverse();
  if (frame.axes == camera_axes::opengl) detail::flip_axes(pose);
  return pose;
}

inline math::rigid3 pose_in_frame(const math::rigid3& world_from_camera, const pose_frame& frame) {
  math::rigid3 pose = world_from_camera;
  if (frame.axes == camera_axes::opengl) detail::flip_axes(pose);
  return frame.convention == pose_convention::camera_from_world ? pose.inverse() : pose;
}

}  // namespace aib::io
