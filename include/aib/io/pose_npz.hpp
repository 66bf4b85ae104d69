// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/io/npz.hpp>
#include <aib/io/pose_arrays.hpp>
#include <aib/io/pose_frame.hpp>
#include <aib/io/posed_images.hpp>
#include <aib/io/trajectory_check.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace aib::io {

struct pose_npz_options {
  std::string key = {};  ///< array of the poses; empty: the first of `pose_keys` that is there
  std::optional<pose_convention> convention = {};  ///< needed where `key` is not of `pose_keys`
  camera_axes axes = camera_axes::opencv;
};

/// An array name by which a method is known to save poses, and what it means.
struct pose_key {
  std::string_view name;
  pose_convention convention;
};

inline constexpr std::array<pose_key, 8> pose_keys{{
    {"extrinsics", pose_convention::camera_from_world},    // Depth Anything 3
    {"exts", pose_convention::camera_from_world},          // Depth Anything 3, its documentation
    {"extrinsic", pose_convention::camera_from_world},     // VGGT
    {"camera_poses", pose_convention::world_from_camera},  // pi3
    {"cam_c2w", pose_convention::world_from_camera},       // MegaSaM
    {"pose", pose_convention::world_from_camera},          // CUT3R
    {"c2w", pose_convention::world_from_camera},
    {"w2c", pose_convention::camera_from_world},
}};

/// Poses and, where they are there, intrinsics (`intrinsics`, `ixts`, `intrinsic`, `K`) of an NPZ
/// file. The images' size is that of `depth` or of the point map; 0 where there is neither.
///
/// Intrinsics whose principal point lies at the far side of the depth map belong to the images'
/// original size (a race in Depth Anything 3's export): they are scaled to the depth map, and a
/// warning says so.
/// Throws argument_error where no array of poses is found or its convention is not known.
[[nodiscard]] posed_images read_pose_npz(const std::filesystem::path& path,
                                         const pose_npz_options& options = {});

/// What CUT3R leaves in a folder `camera`: an NPZ file with one pose (and intrinsics) for each
/// image. The images are named by the files' stems, in their order. Throws format_error where there
/// is none or one of them has more than one pose.
[[nodiscard]] posed_images read_pose_npz_folder(const std::filesystem::path& folder,
                                                const pose_npz_options& options = {});

namespace detail {

inline pose_key find_pose_key(const npz_file& file, const pose_npz_options& options) {
  for (const pose_key& known : pose_keys) {
    if (options.key.empty() ? file.contains(known.name) : options.key == known.name) return known;
  }
  if (options.key.empty()) {
    throw argument_error(
        message(file.path().string(),
                ": npz: no array of poses known by its name; give one as key: ", file.list()));
  }
  if (!options.convention) {
    throw argument_error(message(file.path().string(), ": npz: '", options.key,
                                 "' does not tell its convention: world_from_camera or "
                                 "camera_from_world is to be given"));
  }
  return {options.key, *options.convention};
}

/// Size of the maps that belong to the poses.
inline image_extent size_of_maps(const npz_file& file) {
  for (const char* name : {"depth", "depths", "depth_conf", "local_points", "points", "conf"}) {
    if (!file.contains(name) || file.is_unreadable(name)) continue;
    std::vector<std::size_t> shape = file.read_header(name).shape;
    const bool channels = shape.size() > 3 && (shape.back() == 1 || shape.back() == 3);
    if (channels) shape.pop_back();
    if (shape.size() >= 2) return {shape.back(), shape[shape.size() - 2]};
  }
  return {};
}

/// Scales intrinsics of the original images to the maps' size. Returns whether it was needed.
inline bool scale_to_maps(math::camera& c) {
  constexpr double far_side = 0.9;
  const auto width = static_cast<double>(c.width);
  const auto height = static_cast<double>(c.height);
  if (c.width == 0 || c.cx() <= far_side * width || c.cy() <= far_side * height) return false;
  const double sx = width / (2 * c.cx());
  const double sy = height / (2 * c.cy());
  c.parameters = {c.fx() * sx, c.fy() * sy, width / 2, height / 2};
  return true;
}

inline std::vector<math::camera> read_npz_cameras(const npz_file& file) {
  for (const char* name : {"intrinsics", "ixts", "intrinsic", "K"}) {
    if (!file.contains(name)) continue;
    const image_extent size = size_of_maps(file);
    return cameras_of_array(file.read(name), size.width, size.height,
                            message(file.path().string(), '[', name, ']'));
  }
  return {};
}

}  // namespace detail

inline posed_images read_pose_npz(const std::filesystem::path& path,
                                  const pose_npz_options& options) {
  const npz_file file(path);
  const pose_key key = detail::find_pose_key(file, options);
  const pose_frame frame{options.convention.value_or(key.convention), options.axes};
  posed_images images;
  images.trajectory =
      poses_of_array(file.read(key.name), frame, message(path.string(), '[', key.name, ']'));
  images.cameras = detail::read_npz_cameras(file);
  const std::size_t n = images.trajectory.size();
  if (!images.cameras.empty() && images.cameras.size() != n) {
    throw format_error(
        path, message("npz: intrinsics for ", images.cameras.size(), " images, poses for ", n));
  }
  const auto scaled = std::count_if(images.cameras.begin(), images.cameras.end(),
                                    [](math::camera& c) { return detail::scale_to_maps(c); });
  if (scaled > 0) {
    images.trajectory.warnings.push_back(
        message(scaled, " of ", n,
                " intrinsics belong to a larger image than the depth maps: scaled to these"));
  }
  return images;
}

inline posed_images read_pose_npz_folder(const std::filesystem::path& folder,
                                         const pose_npz_options& options) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".npz") files.push_back(entry.path());
  }
  if (error) throw io_error(folder, message("cannot list: ", error.message()));
  std::sort(files.begin(), files.end());
  posed_images all;
  for (const std::filesystem::path& file : files) {
    const posed_images one = read_pose_npz(file, options);
    if (one.trajectory.size() != 1)
      throw format_error(file, message("one pose expected, found ", one.trajectory.size()));
    all.trajectory.names.push_back(file.stem().string());
    all.trajectory.world_from_camera.push_back(one.trajectory.world_from_camera.front());
    all.cameras.insert(all.cameras.end(), one.cameras.begin(), one.cameras.end());
  }
  if (all.cameras.size() != files.size()) all.cameras.clear();
  all.trajectory = checked_trajectory(std::move(all.trajectory), folder, "npz");
  return all;
}

}  // namespace aib::io
