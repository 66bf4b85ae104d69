// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/io/colmap_write.hpp>
#include <aib/io/file_kind.hpp>
#include <aib/io/kitti.hpp>
#include <aib/io/npy.hpp>
#include <aib/io/pose_arrays.hpp>
#include <aib/io/pose_format.hpp>
#include <aib/io/pose_frame.hpp>
#include <aib/io/posed_images.hpp>
#include <aib/io/tum.hpp>

#ifdef AIB_WITH_JSON
#include <aib/io/transforms.hpp>
#endif

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

namespace aib::io {

/// How poses are written. What is left out is told from the path or is the format's own.
struct trajectory_write_options {
  std::optional<pose_format> format = {};
  pose_frame frame = {};  ///< TUM and NPY only
  colmap_encoding encoding = colmap_encoding::binary;
};

/// Writes poses (and cameras, where the format holds them): tum, kitti, colmap (needs names and
/// cameras), transforms (needs names) or npy (N x 4 x 4).
///
/// Without a format: .json is transforms, .npy npy, .kitti kitti, .txt and .tum tum; a path without
/// an extension is the folder of a COLMAP model.
/// Throws argument_error where the format is not told or not written, or as the writers do.
void write_trajectory(const std::filesystem::path& path,
                      const posed_images& images,
                      const trajectory_write_options& options = {});

namespace detail {

inline pose_format format_to_write(const std::filesystem::path& path) {
  const std::string extension = extension_of(path);
  if (extension == ".json") return pose_format::transforms;
  if (extension == ".npy") return pose_format::npy;
  if (extension == ".kitti") return pose_format::kitti;
  if (extension == ".txt" || extension == ".tum") return pose_format::tum;
  if (extension.empty()) return pose_format::colmap;
  throw argument_error(message("write_trajectory: ", path.string(),
                               ": the extension .txt, .tum, .kitti, .json or .npy expected, or a "
                               "format"));
}

}  // namespace detail

inline void write_trajectory(const std::filesystem::path& path,
                             const posed_images& images,
                             const trajectory_write_options& options) {
  const pose_format format = options.format ? *options.format : detail::format_to_write(path);
  const pose::trajectory& t = images.trajectory;
  const bool own_frame = options.frame.convention == pose_convention::world_from_camera &&
                         options.frame.axes == camera_axes::opencv;
  if (!own_frame && format != pose_format::tum && format != pose_format::npy)
    throw argument_error(message("write_trajectory: ", name(format), " has its own frame"));
  switch (format) {
    case pose_format::tum:
      return write_tum(path, t, {.frame = options.frame});
    case pose_format::kitti:
      return write_kitti(path, t);
    case pose_format::npy:
      return write_npy(path, array_of_poses(t, options.frame));
    case pose_format::colmap:
      return write_colmap(path, make_colmap_model(images), options.encoding);
#ifdef AIB_WITH_JSON
    case pose_format::transforms:
      return write_transforms(path, images);
#endif
    default:
      throw argument_error(message("write_trajectory: ", name(format),
                                   " is not written; tum, kitti, colmap, transforms, npy are"));
  }
}

}  // namespace aib::io
