// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/cloud.hpp>
#include <aib/core/error.hpp>
#include <aib/io/colmap_binary.hpp>
#include <aib/io/colmap_records.hpp>
#include <aib/io/colmap_text.hpp>
#include <aib/io/file.hpp>
#include <aib/io/positions.hpp>
#include <aib/io/text.hpp>
#include <aib/io/trajectory_check.hpp>
#include <aib/math/camera.hpp>
#include <aib/math/rotation.hpp>
#include <aib/pose/trajectory.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace aib::io {

/// A sparse model of COLMAP or GLOMAP.
struct colmap_model {
  std::filesystem::path path = {};             ///< folder that it was read from
  pose::trajectory trajectory = {};            ///< the registered images, sorted by name
  std::vector<std::uint32_t> image_ids = {};   ///< one a pose
  std::vector<std::uint32_t> camera_ids = {};  ///< one a pose, keys of `cameras`
  std::map<std::uint32_t, math::camera> cameras = {};
  cloud::cloud points = {};                       ///< with colors
  std::vector<double> point_errors_px = {};       ///< one a point, < 0: not known
  std::vector<std::uint64_t> track_lengths = {};  ///< one a point
  std::size_t n_points = 0;                       ///< in the file, also where none were read

  /// The camera of pose `i`.
  [[nodiscard]] const math::camera& camera(std::size_t i) const {
    return cameras.at(camera_ids.at(i));
  }
};

/// How a model's files are written.
enum class colmap_encoding { binary, text };

/// What of a model is read.
enum class colmap_content {
  everything,
  cameras_and_images,  ///< points are counted only
};

/// The folders of the models at `path`: the folder itself, else its numbered sub-folders in the
/// order of their numbers, else those of its folder `sparse`. Empty where there is none.
[[nodiscard]] std::vector<std::filesystem::path> find_colmap_models(
    const std::filesystem::path& path);

/// Reads the models at `path`, see find_colmap_models: cameras, images and points3D, binary where a
/// folder has both kinds (as COLMAP does), of every version to 4.2. Where rigs and frames are
/// there, their poses win over those in images, as in COLMAP. Quaternions are normalised. Without
/// points3D the points are empty, and a warning says so.
///
/// Throws io_error where there is no model or half of one, format_error where a file is cut off,
/// has bytes after its last record, an unknown camera model, an image without its camera or a pose
/// that is not finite.
[[nodiscard]] std::vector<colmap_model> read_colmap_models(
    const std::filesystem::path& path, colmap_content content = colmap_content::everything);

/// The largest of the models at `path`: most images, then most points, then the lowest number. A
/// warning of its trajectory names the others.
[[nodiscard]] colmap_model read_colmap(const std::filesystem::path& path,
                                       colmap_content content = colmap_content::everything);

/// Image name -> camera.
[[nodiscard]] std::map<std::string, math::camera> cameras_by_name(const colmap_model& model);

namespace colmap::detail {

namespace fs = std::filesystem;

inline std::optional<colmap_encoding> find_encoding(const fs::path& folder) {
  if (is_there(folder / "cameras.bin") && is_there(folder / "images.bin"))
    return colmap_encoding::binary;
  if (is_there(folder / "cameras.txt") && is_there(folder / "images.txt"))
    return colmap_encoding::text;
  return std::nullopt;
}

/// Throws io_error where only one of the two files is there without which there is no model.
inline void refuse_half_model(const fs::path& folder) {
  for (const std::string extension : {".bin", ".txt"}) {
    for (const auto& [here, away] :
         {std::pair("cameras", "images"), std::pair("images", "cameras")}) {
      if (is_there(folder / (here + extension)))
        throw io_error(folder / (away + extension),
                       message("colmap: not there, though ", here, extension, " is"));
    }
  }
}

/// Sub-folders with a number for a name that are models, in the order of the numbers.
inline std::vector<fs::path> numbered_models(const fs::path& folder) {
  std::vector<std::pair<std::uint64_t, fs::path>> found;
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
    const auto number = parse<std::uint64_t>(entry.path().filename().string());
    if (!number) continue;
    if (!find_encoding(entry.path())) {
      refuse_half_model(entry.path());
      continue;
    }
    found.emplace_back(*number, entry.path());
  }
  std::sort(found.begin(), found.end());
  std::vector<fs::path> folders;
  for (auto& [number, path] : found) folders.push_back(std::move(path));
  return folders;
}

/// The three or five files of a model, whichever way they are written.
class model_files {
 public:
  model_files(fs::path folder, colmap_encoding kind) : folder_(std::move(folder)), kind_(kind) {}

  [[nodiscard]] fs::path file(const char* stem) const {
    return folder_ / (std::string(stem) + (kind_ == colmap_encoding::binary ? ".bin" : ".txt"));
  }
  [[nodiscard]] auto cameras() const {
    return read("cameras", binary::read_cameras, text::read_cameras);
  }
  [[nodiscard]] auto images() const {
    return read("images", binary::read_images, text::read_images);
  }
  [[nodiscard]] auto rigs() const { return read("rigs", binary::read_rigs, text::read_rigs); }
  [[nodiscard]] auto frames() const {
    return read("frames", binary::read_frames, text::read_frames);
  }
  [[nodiscard]] auto points() const {
    return read("points3D", binary::read_points, text::read_points);
  }
  [[nodiscard]] auto point_count() const {
    return read("points3D", binary::count_points, text::count_points);
  }

 private:
  template <class Records>
  Records read(const char* stem,
               Records (*read_binary)(const fs::path&),
               Records (*read_text)(const fs::path&)) const {
    return kind_ == colmap_encoding::binary ? read_binary(file(stem)) : read_text(file(stem));
  }

  fs::path folder_;
  colmap_encoding kind_;
};

/// camera_from_world of each image that the rigs and frames pose.
inline std::map<std::uint64_t, math::rigid3> poses_of_frames(
    const std::map<std::uint32_t, rig>& rigs, const std::vector<frame>& frames) {
  std::map<std::uint64_t, math::rigid3> poses;
  for (const frame& f : frames) {
    const auto r = rigs.find(f.rig_id);
    if (r == rigs.end()) continue;
    for (const auto& [s, image_id] : f.data) {
      if (s.first != camera_sensor) continue;
      if (r->second.reference == s) {
        poses[image_id] = f.rig_from_world;
      } else if (const auto known = r->second.sensor_from_rig.find(s);
                 known != r->second.sensor_from_rig.end()) {
        poses[image_id] = known->second * f.rig_from_world;
      }
    }
  }
  return poses;
}

inline bool differ(const math::rigid3& a, const math::rigid3& b) {
  constexpr double rounding = 1e-6;
  return (a.rotation - b.rotation).norm() > rounding ||
         (a.translation - b.translation).norm() > rounding * (1 + b.translation.norm());
}

/// Lets the rigs' poses win. Returns how many images they moved.
inline std::size_t apply_frames(std::vector<image>& images, const model_files& files) {
  if (!is_there(files.file("rigs")) || !is_there(files.file("frames"))) return 0;
  const auto poses = poses_of_frames(files.rigs(), files.frames());
  std::size_t moved = 0;
  for (image& i : images) {
    const auto pose = poses.find(i.id);
    if (pose == poses.end()) continue;
    moved += differ(pose->second, i.camera_from_world) ? 1 : 0;
    i.camera_from_world = pose->second;
  }
  return moved;
}

inline void check_images(const std::vector<image>& images,
                         const std::map<std::uint32_t, math::camera>& cameras,
                         const fs::path& path) {
  std::vector<std::uint32_t> ids;
  for (const image& i : images) {
    ids.push_back(i.id);
    if (!cameras.contains(i.camera_id)) {
      throw format_error(path, message("colmap: image '", i.name, "' has camera ", i.camera_id,
                                       ", which is not among the ", cameras.size(), " cameras"));
    }
  }
  std::sort(ids.begin(), ids.end());
  const auto twice = std::adjacent_find(ids.begin(), ids.end());
  if (twice != ids.end())
    throw format_error(path, message("colmap: image ", *twice, " comes twice"));
}

inline void read_points(colmap_model& model, const model_files& files, colmap_content content) {
  if (!is_there(files.file("points3D"))) {
    model.points.warnings.push_back("the model has no points3D file: no points");
    return;
  }
  if (content == colmap_content::cameras_and_images) {
    model.n_points = files.point_count();
    return;
  }
  points p = files.points();
  model.n_points = p.positions.size();
  float_positions floats = to_floats(p.positions);
  model.points.origin = floats.origin;
  model.points.points = std::move(floats.points);
  model.points.colors = std::move(p.colors);
  if (auto warning = non_finite_warning(model.points.points, "points"))
    model.points.warnings.push_back(std::move(*warning));
  model.point_errors_px = std::move(p.errors_px);
  model.track_lengths = std::move(p.track_lengths);
}

inline colmap_model read_model(const fs::path& folder,
                               colmap_encoding kind,
                               colmap_content content) {
  const model_files files(folder, kind);
  colmap_model model;
  model.path = folder;
  model.cameras = files.cameras();
  std::vector<image> images = files.images();
  check_images(images, model.cameras, files.file("images"));
  const std::size_t moved = apply_frames(images, files);
  std::sort(images.begin(), images.end(), [](const image& a, const image& b) {
    return std::tie(a.name, a.id) < std::tie(b.name, b.id);
  });
  for (image& i : images) {
    model.trajectory.world_from_camera.push_back(i.camera_from_world.inverse());
    model.trajectory.names.push_back(std::move(i.name));
    model.image_ids.push_back(i.id);
    model.camera_ids.push_back(i.camera_id);
  }
  if (moved > 0) {
    model.trajectory.warnings.push_back(message(
        moved, " of ", images.size(), " images have another pose in rigs and frames, which wins"));
  }
  model.trajectory =
      checked_trajectory(std::move(model.trajectory), files.file("images"), "colmap");
  read_points(model, files, content);
  return model;
}

}  // namespace colmap::detail

inline std::vector<std::filesystem::path> find_colmap_models(const std::filesystem::path& path) {
  if (colmap::detail::find_encoding(path)) return {path};
  auto models = colmap::detail::numbered_models(path);
  if (!models.empty()) return models;
  const std::filesystem::path sparse = path / "sparse";
  if (colmap::detail::find_encoding(sparse)) return {sparse};
  return colmap::detail::numbered_models(sparse);
}

inline std::vector<colmap_model> read_colmap_models(const std::filesystem::path& path,
                                                    colmap_content content) {
  std::vector<colmap_model> models;
  for (const std::filesystem::path& folder : find_colmap_models(path)) {
    const auto kind = colmap::detail::find_encoding(folder);
    models.push_back(colmap::detail::read_model(folder, *kind, content));
  }
  if (models.empty()) {
    throw io_error(path,
                   is_there(path)
                       ? "colmap: cameras and images (.bin or .txt) expected here, in numbered "
                         "folders or in sparse, found none"
                       : "no such folder");
  }
  return models;
}

inline colmap_model read_colmap(const std::filesystem::path& path, colmap_content content) {
  std::vector<colmap_model> models = read_colmap_models(path, content);
  const auto size = [](const colmap_model& m) {
    return std::pair(m.trajectory.size(), m.n_points);
  };
  const auto largest =
      std::max_element(models.begin(), models.end(),
                       [&](const auto& a, const auto& b) { return size(a) < size(b); });
  colmap_model model = std::move(*largest);
  if (models.size() == 1) return model;
  std::string others;
  for (auto m = models.begin(); m != models.end(); ++m) {
    if (m == largest) continue;
    others += message(others.empty() ? "" : ", ", m->path.filename().string(), " (",
                      m->trajectory.size(), " images)");
  }
  model.trajectory.warnings.push_back(message("model ", model.path.filename().string(), " of ",
                                              models.size(), " is read (", model.trajectory.size(),
                                              " images), not ", others));
  return model;
}

inline std::map<std::string, math::camera> cameras_by_name(const colmap_model& model) {
  std::map<std::string, math::camera> cameras;
  for (std::size_t i = 0; i < model.trajectory.size(); ++i)
    cameras[model.trajectory.names[i]] = model.camera(i);
  return cameras;
}

}  // namespace aib::io
