// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/io/file.hpp>
#include <aib/io/number_lines.hpp>
#include <aib/io/pose_frame.hpp>
#include <aib/io/trajectory_check.hpp>
#include <aib/pose/trajectory.hpp>

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace aib::io {

/// Poses of a KITTI odometry text file: the 12 numbers of [R | t] by rows a line,
/// world_from_camera. Neither names nor stamps: line k is frame k. Poses that are not finite stay,
/// unregistered.
///
/// Throws format_error for a line without 12 numbers, a matrix that is not a rotation (see
/// pose_from_matrix) and a file without a pose.
/// Source: Geiger, Lenz, Urtasun, "Are we ready for autonomous driving?", CVPR 2012.
[[nodiscard]] pose::trajectory read_kitti(const std::filesystem::path& path,
                                          const pose_frame& frame = {});

/// Writes a KITTI file, numbers in their shortest exact form. Throws argument_error where there is
/// no pose or one is not registered, which the format cannot say.
void write_kitti(const std::filesystem::path& path, const pose::trajectory& t);

/// Poses of a text file with the 16 numbers of a 4 x 4 matrix by rows a line, world_from_camera:
/// what Depth Anything 3's streaming writes as camera_poses.txt. Else as read_kitti.
[[nodiscard]] pose::trajectory read_matrix_lines(const std::filesystem::path& path,
                                                 const pose_frame& frame = {});

namespace detail {

inline pose::trajectory read_pose_rows(const std::filesystem::path& path,
                                       std::string_view format,
                                       std::size_t n,
                                       const pose_frame& frame) {
  const std::string text = read_file(path);
  number_lines lines(text, path, format);
  pose::trajectory t;
  while (lines.next()) {
    lines.expect(n, n == 12 ? "3 x 4 matrix by rows" : "4 x 4 matrix by rows");
    t.world_from_camera.push_back(
        lines.checked([&] { return pose_from_matrix(matrix_of_rows(lines.numbers()), frame); }));
  }
  return checked_trajectory(std::move(t), path, format);
}

}  // namespace detail

inline pose::trajectory read_kitti(const std::filesystem::path& path, const pose_frame& frame) {
  return detail::read_pose_rows(path, "kitti", 12, frame);
}

inline pose::trajectory read_matrix_lines(const std::filesystem::path& path,
                                          const pose_frame& frame) {
  return detail::read_pose_rows(path, "matrix lines", 16, frame);
}

inline void write_kitti(const std::filesystem::path& path, const pose::trajectory& t) {
  if (t.empty()) throw argument_error("write_kitti: no pose to write");
  std::string text;
  for (std::size_t i = 0; i < t.size(); ++i) {
    if (!t.world_from_camera[i].is_finite()) {
      throw argument_error(
          message("write_kitti: pose ", i, " is not registered, which the format cannot say"));
    }
    const Eigen::Matrix4d m = t.world_from_camera[i].matrix();
    for (Eigen::Index k = 0; k < 12; ++k) text += message(m(k / 4, k % 4), k == 11 ? '\n' : ' ');
  }
  write_file(path, text);
}

}  // namespace aib::io
