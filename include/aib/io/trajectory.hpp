// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/io/colmap.hpp>
#include <aib/io/da3_streaming.hpp>
#include <aib/io/euroc.hpp>
#include <aib/io/file.hpp>
#include <aib/io/kitti.hpp>
#include <aib/io/npy.hpp>
#include <aib/io/number_lines.hpp>
#include <aib/io/pose_arrays.hpp>
#include <aib/io/pose_format.hpp>
#include <aib/io/pose_frame.hpp>
#include <aib/io/posed_images.hpp>
#include <aib/io/reality_capture.hpp>
#include <aib/io/tanks_and_temples.hpp>
#include <aib/io/tum.hpp>
#include <aib/math/camera.hpp>
#include <aib/pose/trajectory.hpp>

#ifdef AIB_WITH_JSON
#include <aib/io/opensfm.hpp>
#include <aib/io/transforms.hpp>
#endif
#ifdef AIB_WITH_NPZ
#include <aib/io/pose_npz.hpp>
#endif
#ifdef AIB_WITH_XML
#include <aib/io/metashape.hpp>
#endif

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace aib::io {

/// How poses are read. What is left out is told from the file or is the format's own.
struct trajectory_options {
  std::optional<pose_format> format = {};
  std::optional<pose_convention> convention = {};  ///< needed for NPY and unknown NPZ arrays
  std::optional<camera_axes> axes = {};
  quaternion_order quaternion = quaternion_order::xyzw;  ///< TUM only
  std::string key = {};                                  ///< NPZ only: the array of the poses
  std::vector<std::string> names = {};  ///< one a pose, for files that do not name their images
  image_extent size = {};               ///< for intrinsics of files that do not say it
};

/// The poses of a file or folder in the house's frame, with the intrinsics where it has any:
///
/// format             from                                       convention, axes
/// tum                `stamp tx ty tz qx qy qz qw` a line        world_from_camera, opencv
/// kitti              3 x 4 matrix a line                        world_from_camera, opencv
/// euroc              csv with stamps in ns                      world_from_body
/// log                Tanks and Temples                          world_from_camera, opencv
/// da3                camera_poses.txt, intrinsic.txt            world_from_camera, opencv
/// colmap             a model or a folder of models (largest)    its own
/// transforms         transforms.json (NeRF, nerfstudio)         world_from_camera, opengl
/// opensfm            reconstruction.json (largest component)    its own
/// metashape          cameras.xml                                its own
/// reality_capture    csv of internal and external parameters    its own
/// npy, npz           N x 4 x 4 or N x 3 x 4                     as told, opencv
/// npz                a folder of them, one an image (CUT3R)     as told, opencv
///
/// Throws io_error, format_error as the readers do, format_error too where there are more or fewer
/// poses than names; argument_error where an option does not fit the format.
[[nodiscard]] posed_images read_posed_images(const std::filesystem::path& path,
                                             const trajectory_options& options = {});

/// The poses alone, see read_posed_images.
[[nodiscard]] pose::trajectory read_trajectory(const std::filesystem::path& path,
                                               const trajectory_options& options = {});

/// Image name -> camera, of every format that has intrinsics, see read_posed_images. Images without
/// a name are called by their index ("0", "1", ...).
/// Throws format_error where the file has no intrinsics.
[[nodiscard]] std::map<std::string, math::camera> read_cameras(
    const std::filesystem::path& path, const trajectory_options& options = {});

namespace detail {

[[noreturn]] inline void needs_library(const std::filesystem::path& path,
                                       std::string_view format,
                                       std::string_view library) {
  throw argument_error(message(path.string(), ": ", format, " is read with ", library,
                               ", which this program was built without"));
}

/// The file that is meant where a folder is given.
inline std::filesystem::path file_in(const std::filesystem::path& path, const char* name) {
  return is_folder(path) ? path / name : path;
}

/// Reads one file in its format with the options that fit it.
class pose_reader {
 public:
  pose_reader(const std::filesystem::path& path,
              pose_format format,
              const trajectory_options& options)
      : path_(path), format_(format), options_(options) {}

  posed_images read() const {
    reject_unused_options();
    switch (format_) {
      case pose_format::tum:
        return {read_tum(path_, {frame(), options_.quaternion}), {}};
      case pose_format::kitti:
        return {read_kitti(path_, frame()), {}};
      case pose_format::euroc:
        return {read_euroc(path_, frame()), {}};
      case pose_format::log:
        return {read_tanks_and_temples(path_, frame()), {}};
      case pose_format::da3:
        return read_da3_streaming(path_, frame());
      case pose_format::colmap:
        return from_colmap();
      case pose_format::transforms:
        return from_transforms();
      case pose_format::opensfm:
        return from_opensfm();
      case pose_format::metashape:
        return from_metashape();
      case pose_format::reality_capture:
        return read_reality_capture(path_, options_.size);
      case pose_format::npy:
        return from_npy();
      case pose_format::npz:
        break;
    }
    return from_npz();
  }

 private:
  pose_frame frame(camera_axes axes = camera_axes::opencv) const {
    return {options_.convention.value_or(pose_convention::world_from_camera),
            options_.axes.value_or(axes)};
  }

  posed_images from_colmap() const {
    const bool folder = is_folder(path_);
    const colmap_model model =
        read_colmap(folder ? path_ : path_.parent_path(), colmap_content::cameras_and_images);
    posed_images images{model.trajectory, {}};
    for (std::size_t i = 0; i < model.trajectory.size(); ++i)
      images.cameras.push_back(model.camera(i));
    return images;
  }

  posed_images from_npy() const {
    if (!options_.convention) {
      throw argument_error(message(path_.string(),
                                   ": an array does not tell its convention: world_from_camera or "
                                   "camera_from_world is to be given"));
    }
    return {poses_of_array(read_npy(path_), frame(), path_), {}};
  }

#ifdef AIB_WITH_NPZ
  posed_images from_npz() const {
    const pose_npz_options npz{options_.key, options_.convention, frame().axes};
    if (!is_folder(path_)) return read_pose_npz(path_, npz);
    return read_pose_npz_folder(folder_of_npz(path_), npz);
  }
#else
  posed_images from_npz() const { needs_library(path_, "NPZ", "zlib"); }
#endif

#ifdef AIB_WITH_JSON
  posed_images from_transforms() const {
    return read_transforms(file_in(path_, "transforms.json"),
                           {frame(camera_axes::opengl), options_.size});
  }
  posed_images from_opensfm() const { return read_opensfm(file_in(path_, "reconstruction.json")); }
#else
  posed_images from_transforms() const { needs_library(path_, "JSON", "nlohmann-json"); }
  posed_images from_opensfm() const { needs_library(path_, "JSON", "nlohmann-json"); }
#endif

#ifdef AIB_WITH_XML
  posed_images from_metashape() const { return read_metashape(path_); }
#else
  posed_images from_metashape() const { needs_library(path_, "XML", "pugixml"); }
#endif

  void reject_unused_options() const {
    const auto reject = [&](std::string_view option) {
      throw argument_error(message(path_.string(), ": the option ", option,
                                   " does not fit the format ", name(format_)));
    };
    const bool own_frame = format_ == pose_format::colmap || format_ == pose_format::opensfm ||
                           format_ == pose_format::metashape ||
                           format_ == pose_format::reality_capture;
    if (own_frame && options_.convention) reject("convention");
    if (own_frame && options_.axes) reject("axes");
    if (format_ != pose_format::npz && !options_.key.empty()) reject("key");
    if (format_ != pose_format::tum && options_.quaternion != quaternion_order::xyzw)
      reject("quaternion");
  }

  const std::filesystem::path& path_;
  pose_format format_;
  const trajectory_options& options_;
};

}  // namespace detail

inline posed_images read_posed_images(const std::filesystem::path& path,
                                      const trajectory_options& options) {
  const pose_format format = options.format ? *options.format : detect_pose_format(path);
  posed_images images = detail::pose_reader(path, format, options).read();
  if (options.names.empty()) return images;
  if (options.names.size() != images.trajectory.size()) {
    throw format_error(
        path, message(options.names.size(), " names for ", images.trajectory.size(), " poses"));
  }
  images.trajectory.names = options.names;
  return images;
}

inline pose::trajectory read_trajectory(const std::filesystem::path& path,
                                        const trajectory_options& options) {
  return read_posed_images(path, options).trajectory;
}

inline std::map<std::string, math::camera> read_cameras(const std::filesystem::path& path,
                                                        const trajectory_options& options) {
  const posed_images images = read_posed_images(path, options);
  if (images.cameras.empty()) {
    throw format_error(path,
                       "no intrinsics in the file, or none without the images' width and height");
  }
  std::map<std::string, math::camera> cameras;
  const std::vector<std::string>& names = images.trajectory.names;
  for (std::size_t i = 0; i < images.cameras.size(); ++i)
    cameras[names.empty() ? message(i) : names[i]] = images.cameras[i];
  return cameras;
}

}  // namespace aib::io
