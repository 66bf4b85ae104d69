// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/io/file.hpp>
#include <aib/io/json.hpp>
#include <aib/io/pose_frame.hpp>
#include <aib/io/posed_images.hpp>
#include <aib/io/trajectory_check.hpp>
#include <aib/math/camera.hpp>
#include <aib/pose/trajectory.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace aib::io {

struct transforms_options {
  pose_frame frame = {pose_convention::world_from_camera, camera_axes::opengl};
  image_extent size = {};
};

/// A transforms.json of NeRF (camera_angle_x) or nerfstudio (fl_x ..., shared or per frame): poses
/// in the order of the frames, named by `file_path` without a leading "./".
///
/// nerfstudio's `applied_transform` is part of the written poses and stays so. Cameras are empty
/// where the file tells no focal length (an angle needs a width) or has a camera model that COLMAP
/// has not; a warning says so.
///
/// Throws format_error where it is not JSON, has no frames, or a frame without a 4 x 4 or 3 x 4
/// transform_matrix.
[[nodiscard]] posed_images read_transforms(const std::filesystem::path& path,
                                           const transforms_options& options = {});

/// Writes a nerfstudio transforms.json: OpenGL axes, intrinsics per frame where there are cameras.
/// Poses that are not registered are left out. Throws argument_error where names or cameras do not
/// fit the poses, no pose is registered or a camera has a model that nerfstudio has not.
void write_transforms(const std::filesystem::path& path, const posed_images& images);

namespace detail {

inline pose_matrix read_transform_matrix(const json_node& rows) {
  if (rows.size() != 4 && rows.size() != 3)
    rows.fail(message("4 or 3 rows expected, found ", rows.size()));
  pose_matrix matrix;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const json_node row = rows[r];
    if (row.size() != 4) row.fail(message("4 numbers expected, found ", row.size()));
    for (std::size_t c = 0; c < 4; ++c) {
      const double number = row[c].number();
      if (r < 3) matrix(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) = number;
      if (r == 3 && number != (c == 3 ? 1 : 0)) row.fail("0 0 0 1 expected in the last row");
    }
  }
  return matrix;
}

/// Whether nerfstudio takes the model for a perspective camera with OpenCV's distortion.
inline bool is_perspective(std::string_view model) {
  constexpr std::array<std::string_view, 6> models{
      "", "SIMPLE_PINHOLE", "PINHOLE", "SIMPLE_RADIAL", "RADIAL", "OPENCV"};
  return std::find(models.begin(), models.end(), model) != models.end();
}

/// Intrinsics of a frame: its own members, else those of the file.
class transforms_intrinsics {
 public:
  transforms_intrinsics(const json_node& frame,
                        const json_node& file,
                        const transforms_options& options)
      : frame_(frame), file_(file) {
    width_ = number("w").value_or(static_cast<double>(options.size.width));
    height_ = number("h").value_or(static_cast<double>(options.size.height));
  }

  /// Nothing where the focal length or the model is not known.
  [[nodiscard]] std::optional<math::camera> camera() const {
    using math::camera_model;
    const std::string model = model_name();
    if (model == "EQUIRECTANGULAR") return of(camera_model::equirectangular, {width_, height_});
    const auto fx = focal("fl_x", "camera_angle_x", width_);
    if (!fx) return std::nullopt;
    const double fy = focal("fl_y", "camera_angle_y", height_).value_or(*fx);
    const double cx = number("cx").value_or(width_ / 2);
    const double cy = number("cy").value_or(height_ / 2);
    const auto k = [&](const char* key) { return number(key).value_or(0); };
    if (model == "OPENCV_FISHEYE") {
      return of(camera_model::opencv_fisheye,
                {*fx, fy, cx, cy, k("k1"), k("k2"), k("k3"), k("k4")});
    }
    if (!is_perspective(model) || k("k4") != 0) return std::nullopt;
    if (k("k3") != 0) {
      return of(camera_model::full_opencv,
                {*fx, fy, cx, cy, k("k1"), k("k2"), k("p1"), k("p2"), k("k3"), 0, 0, 0});
    }
    if (k("k1") != 0 || k("k2") != 0 || k("p1") != 0 || k("p2") != 0)
      return of(camera_model::opencv, {*fx, fy, cx, cy, k("k1"), k("k2"), k("p1"), k("p2")});
    return of(camera_model::pinhole, {*fx, fy, cx, cy});
  }

 private:
  [[nodiscard]] std::optional<double> number(const std::string& key) const {
    auto member = frame_.find(key);
    if (!member) member = file_.find(key);
    if (!member) return std::nullopt;
    return member->number();
  }

  [[nodiscard]] std::string model_name() const {
    auto member = frame_.find("camera_model");
    if (!member) member = file_.find("camera_model");
    return member ? member->text() : std::string();
  }

  [[nodiscard]] std::optional<double> focal(const char* key,
                                            const char* angle_key,
                                            double extent) const {
    if (const auto f = number(key)) return f;
    const auto angle = number(angle_key);
    if (!angle || !(extent > 0)) return std::nullopt;
    return extent / 2 / std::tan(*angle / 2);
  }

  [[nodiscard]] math::camera of(math::camera_model model, std::vector<double> parameters) const {
    const auto pixels = [&](double extent) {
      if (!(extent >= 0 && extent < 1e9)) frame_.fail("w and h between 0 and 1e9 expected");
      return static_cast<std::uint64_t>(extent);
    };
    return {model, pixels(width_), pixels(height_), std::move(parameters)};
  }

  const json_node& frame_;
  const json_node& file_;
  double width_ = 0;
  double height_ = 0;
};

inline nlohmann::ordered_json json_of_camera(const math::camera& c) {
  using math::camera_model;
  static constexpr std::array names{"k1", "k2", "p1", "p2"};
  static constexpr std::array fisheye_names{"k1", "k2", "k3", "k4"};
  nlohmann::ordered_json j;
  const bool fisheye = c.model == camera_model::opencv_fisheye;
  const bool distorted = fisheye || c.model == camera_model::opencv;
  if (!distorted && c.model != camera_model::pinhole && c.model != camera_model::simple_pinhole) {
    throw argument_error(message("write_transforms: camera model ", math::info(c.model).name,
                                 " is not one of SIMPLE_PINHOLE, PINHOLE, OPENCV, OPENCV_FISHEYE"));
  }
  j["camera_model"] = fisheye ? "OPENCV_FISHEYE" : "OPENCV";
  j["w"] = c.width;
  j["h"] = c.height;
  j["fl_x"] = c.fx();
  j["fl_y"] = c.fy();
  j["cx"] = c.cx();
  j["cy"] = c.cy();
  for (std::size_t i = 0; distorted && i < 4; ++i)
    j[fisheye ? fisheye_names[i] : names[i]] = c.parameters.at(4 + i);
  return j;
}

}  // namespace detail

inline posed_images read_transforms(const std::filesystem::path& path,
                                    const transforms_options& options) {
  const nlohmann::json content = read_json(path);
  const json_node file(content, path, "");
  const json_node frames = file["frames"];
  posed_images images;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const json_node frame = frames[i];
    std::string name = frame["file_path"].text();
    if (name.starts_with("./")) name.erase(0, 2);
    images.trajectory.names.push_back(std::move(name));
    const json_node matrix = frame["transform_matrix"];
    try {
      images.trajectory.world_from_camera.push_back(
          pose_from_matrix(detail::read_transform_matrix(matrix), options.frame));
    } catch (const argument_error& e) {
      matrix.fail(e.what());
    }
    if (auto camera = detail::transforms_intrinsics(frame, file, options).camera())
      images.cameras.push_back(std::move(*camera));
  }
  images.trajectory = checked_trajectory(std::move(images.trajectory), path, "transforms");
  drop_some_cameras(images);
  return images;
}

inline void write_transforms(const std::filesystem::path& path, const posed_images& images) {
  const pose::trajectory& t = images.trajectory;
  pose::check(t);
  if (t.names.empty()) throw argument_error("write_transforms: the poses need names");
  if (!images.cameras.empty() && images.cameras.size() != t.size()) {
    throw argument_error(
        message("write_transforms: ", images.cameras.size(), " cameras for ", t.size(), " poses"));
  }
  nlohmann::ordered_json frames = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < t.size(); ++i) {
    if (!t.world_from_camera[i].is_finite()) continue;
    nlohmann::ordered_json frame;
    frame["file_path"] = t.names[i];
    if (!images.cameras.empty()) frame.update(detail::json_of_camera(images.cameras[i]));
    const Eigen::Matrix4d m =
        pose_in_frame(t.world_from_camera[i], transforms_options{}.frame).matrix();
    for (Eigen::Index r = 0; r < 4; ++r)
      frame["transform_matrix"].push_back({m(r, 0), m(r, 1), m(r, 2), m(r, 3)});
    frames.push_back(std::move(frame));
  }
  if (frames.empty()) throw argument_error("write_transforms: no registered pose to write");
  nlohmann::ordered_json file;
  file["frames"] = std::move(frames);
  write_file(path, file.dump(1) + "\n");
}

}  // namespace aib::io
