// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/io/file.hpp>
#include <aib/io/kitti.hpp>
#include <aib/io/number_lines.hpp>
#include <aib/io/pose_frame.hpp>
#include <aib/io/posed_images.hpp>
#include <aib/math/camera.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace aib::io {

/// Cameras of a text file with `fx fy cx cy` (pixels) a line. The images' size is not in the file:
/// width and height are 0.
/// Throws format_error for a line without 4 numbers.
[[nodiscard]] inline std::vector<math::camera> read_intrinsic_lines(
    const std::filesystem::path& path) {
  const std::string text = read_file(path);
  number_lines lines(text, path, "intrinsics");
  std::vector<math::camera> cameras;
  while (lines.next()) {
    lines.expect(4, "fx fy cx cy");
    const std::vector<double>& n = lines.numbers();
    cameras.push_back(math::pinhole(0, 0, n[0], n[1], n[2], n[3]));
  }
  return cameras;
}

/// What Depth Anything 3's streaming leaves in a folder: camera_poses.txt (see read_matrix_lines)
/// and, where it is there, intrinsic.txt with a line a pose. `path` is the folder or
/// camera_poses.txt.
/// Throws format_error where the two files differ in length.
/// Source: Depth-Anything-3, da3_streaming.
[[nodiscard]] inline posed_images read_da3_streaming(const std::filesystem::path& path,
                                                     const pose_frame& frame = {}) {
  const bool folder = is_folder(path);
  const std::filesystem::path poses = folder ? path / "camera_poses.txt" : path;
  const std::filesystem::path intrinsics = poses.parent_path() / "intrinsic.txt";
  posed_images images{read_matrix_lines(poses, frame), {}};
  if (!is_there(intrinsics)) return images;
  images.cameras = read_intrinsic_lines(intrinsics);
  if (images.cameras.size() != images.trajectory.size()) {
    throw format_error(intrinsics, message("a line for each of the ", images.trajectory.size(),
                                           " poses expected, found ", images.cameras.size()));
  }
  return images;
}

}  // namespace aib::io
