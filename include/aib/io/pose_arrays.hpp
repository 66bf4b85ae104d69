// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/io/npy.hpp>
#include <aib/io/pose_frame.hpp>
#include <aib/io/trajectory_check.hpp>
#include <aib/math/camera.hpp>
#include <aib/pose/trajectory.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace aib::io {

/// Poses of an array of N x 4 x 4 or N x 3 x 4 numbers, or of one such matrix; leading axes of
/// length 1 are dropped. `path` names the source in errors.
/// Throws format_error for another shape and a matrix that is not a pose (see pose_from_matrix).
[[nodiscard]] pose::trajectory poses_of_array(const array& matrices,
                                              const pose_frame& frame,
                                              const std::filesystem::path& path);

/// Cameras of an array of N x 3 x 3 intrinsic matrices in pixels of an image of the given size.
/// Throws format_error for another shape.
[[nodiscard]] std::vector<math::camera> cameras_of_array(const array& matrices,
                                                         std::uint64_t width,
                                                         std::uint64_t height,
                                                         const std::filesystem::path& path);

/// The poses as an array of N x 4 x 4 doubles, as they are written in `frame`.
[[nodiscard]] array array_of_poses(const pose::trajectory& t, const pose_frame& frame = {});

namespace detail {

/// The shape without its leading ones, with at least `axes` axes.
inline std::vector<std::size_t> squeezed(const std::vector<std::size_t>& shape, std::size_t axes) {
  std::vector<std::size_t> s = shape;
  while (s.size() > axes && s.front() == 1) s.erase(s.begin());
  if (s.size() + 1 == axes) s.insert(s.begin(), 1);
  return s;
}

}  // namespace detail

inline pose::trajectory poses_of_array(const array& matrices,
                                       const pose_frame& frame,
                                       const std::filesystem::path& path) {
  const auto shape = detail::squeezed(matrices.shape, 3);
  if (shape.size() != 3 || (shape[1] != 3 && shape[1] != 4) || shape[2] != 4) {
    throw format_error(path, message("poses: shape (N, 4, 4) or (N, 3, 4) expected, found ",
                                     text_of_shape(matrices.shape)));
  }
  const std::vector<double> numbers = matrices.values<double>();
  pose::trajectory t;
  for (std::size_t i = 0; i < shape[0]; ++i) {
    const pose_matrix m = matrix_of_rows(std::span(numbers).subspan(i * shape[1] * 4));
    try {
      t.world_from_camera.push_back(pose_from_matrix(m, frame));
    } catch (const argument_error& e) {
      throw format_error(path, message("poses: matrix ", i, ": ", e.what()));
    }
  }
  return checked_trajectory(std::move(t), path, "poses");
}

inline std::vector<math::camera> cameras_of_array(const array& matrices,
                                                  std::uint64_t width,
                                                  std::uint64_t height,
                                                  const std::filesystem::path& path) {
  const auto shape = detail::squeezed(matrices.shape, 3);
  if (shape.size() != 3 || shape[1] != 3 || shape[2] != 3) {
    throw format_error(path, message("intrinsics: shape (N, 3, 3) expected, found ",
                                     text_of_shape(matrices.shape)));
  }
  const std::vector<double> numbers = matrices.values<double>();
  std::vector<math::camera> cameras;
  for (std::size_t i = 0; i < shape[0]; ++i) {
    const std::span k = std::span(numbers).subspan(i * 9, 9);
    cameras.push_back(math::pinhole(width, height, k[0], k[4], k[2], k[5]));
  }
  return cameras;
}

inline array array_of_poses(const pose::trajectory& t, const pose_frame& frame) {
  std::vector<double> numbers;
  for (const math::rigid3& pose : t.world_from_camera) {
    const Eigen::Matrix<double, 4, 4, Eigen::RowMajor> m = pose_in_frame(pose, frame).matrix();
    numbers.insert(numbers.end(), m.data(), m.data() + m.size());
  }
  return make_array<double>({t.size(), 4, 4}, numbers);
}

}  // namespace aib::io
