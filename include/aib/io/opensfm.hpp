// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/io/json.hpp>
#include <aib/io/pose_frame.hpp>
#include <aib/io/posed_images.hpp>
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
#include <utility>
#include <vector>

namespace aib::io {

/// The components of an OpenSfM or OpenDroneMap reconstruction.json, in the order of the file; the
/// shots of each sorted by name. Points are not read.
///
/// Cameras are empty where a shot's camera has a projection that COLMAP has not; a warning says so.
/// Throws format_error where it is not such a file or has no shot.
/// Source: OpenSfM, opensfm/io.py, doc/source/reporting.rst.
[[nodiscard]] std::vector<posed_images> read_opensfm_components(const std::filesystem::path& path);

/// The component with the most shots (of equals the first); a warning counts the others.
[[nodiscard]] posed_images read_opensfm(const std::filesystem::path& path);

namespace detail {

/// OpenSfM's camera with COLMAP's parameters. Lengths are written in units of the longer side, from
/// the image's centre.
inline std::optional<math::camera> opensfm_camera(const json_node& j) {
  using math::camera_model;
  const double width = j["width"].number();
  const double height = j["height"].number();
  if (!(width >= 1 && height >= 1 && width < 1e9 && height < 1e9))
    j.fail("width and height of 1 or more pixels expected");
  const double side = std::max(width, height);
  const double f = side * j.number("focal", 0);
  const double fx = side * j.number("focal_x", f / side);
  const double fy = side * j.number("focal_y", fx / side);
  const double cx = width / 2 + side * j.number("c_x", 0);
  const double cy = height / 2 + side * j.number("c_y", 0);
  const auto d = [&](const char* key) { return j.number(key, 0); };
  const auto of = [&](camera_model model, std::vector<double> parameters) {
    return math::camera{model, static_cast<std::uint64_t>(width),
                        static_cast<std::uint64_t>(height), std::move(parameters)};
  };
  const std::string type = j["projection_type"].text();
  if (type == "perspective") return of(camera_model::radial, {f, cx, cy, d("k1"), d("k2")});
  if (type == "fisheye") return of(camera_model::radial_fisheye, {f, cx, cy, d("k1"), d("k2")});
  if (type == "spherical" || type == "equirectangular")
    return of(camera_model::equirectangular, {width, height});
  if (type == "simple_radial" || type == "radial")
    return of(camera_model::opencv, {fx, fy, cx, cy, d("k1"), d("k2"), 0, 0});
  if (type == "brown") {
    return of(camera_model::full_opencv,
              {fx, fy, cx, cy, d("k1"), d("k2"), d("p1"), d("p2"), d("k3"), 0, 0, 0});
  }
  if (type == "fisheye_opencv") {
    return of(camera_model::opencv_fisheye, {fx, fy, cx, cy, d("k1"), d("k2"), d("k3"), d("k4")});
  }
  return std::nullopt;
}

inline Eigen::Vector3d read_json_vector(const json_node& j) {
  if (j.size() != 3) j.fail(message("3 numbers expected, found ", j.size()));
  return {j[0].number(), j[1].number(), j[2].number()};
}

inline posed_images opensfm_component(const json_node& component,
                                      const std::filesystem::path& path) {
  std::map<std::string, std::optional<math::camera>> cameras;
  component["cameras"].for_each_member([&](const std::string& name, const json_node& camera) {
    cameras[name] = opensfm_camera(camera);
  });
  posed_images images;
  component["shots"].for_each_member([&](const std::string& name, const json_node& shot) {
    const Eigen::Matrix3d rotation = math::rotation_from(read_json_vector(shot["rotation"]));
    const math::rigid3 camera_from_world{rotation, read_json_vector(shot["translation"])};
    images.trajectory.names.push_back(name);
    images.trajectory.world_from_camera.push_back(camera_from_world.inverse());
    const std::string camera_name = shot["camera"].text();
    const auto camera = cameras.find(camera_name);
    if (camera == cameras.end()) shot.fail(message("no camera '", camera_name, "' in the file"));
    if (camera->second) images.cameras.push_back(*camera->second);
  });
  images.trajectory = checked_trajectory(std::move(images.trajectory), path, "opensfm");
  drop_some_cameras(images);
  return images;
}

}  // namespace detail

inline std::vector<posed_images> read_opensfm_components(const std::filesystem::path& path) {
  const nlohmann::json content =
      read_json(path, [](const std::string& key) { return key != "points"; });
  const json_node file(content, path);
  std::vector<posed_images> components;
  for (std::size_t i = 0; i < file.size(); ++i)
    components.push_back(detail::opensfm_component(file[i], path));
  if (components.empty()) throw format_error(path, "opensfm: no reconstruction in the file");
  return components;
}

inline posed_images read_opensfm(const std::filesystem::path& path) {
  std::vector<posed_images> components = read_opensfm_components(path);
  const auto largest = std::max_element(components.begin(), components.end(),
                                        [](const posed_images& a, const posed_images& b) {
                                          return a.trajectory.size() < b.trajectory.size();
                                        });
  posed_images images = std::move(*largest);
  if (components.size() > 1) {
    images.trajectory.warnings.push_back(message("component ", largest - components.begin(), " of ",
                                                 components.size(), " is read (",
                                                 images.trajectory.size(), " images)"));
  }
  return images;
}

}  // namespace aib::io
