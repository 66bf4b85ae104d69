// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/io/file.hpp>
#include <aib/io/pose_frame.hpp>
#include <aib/io/posed_images.hpp>
#include <aib/io/text.hpp>
#include <aib/io/trajectory_check.hpp>
#include <aib/math/camera.hpp>
#include <aib/math/sim3.hpp>
#include <aib/pose/trajectory.hpp>

#include <pugixml.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace aib::io {

/// The cameras of an Agisoft Metashape XML file, in the order of the file, named by their labels;
/// of several chunks those of the first, and a warning says so. A camera without a transform stays,
/// unregistered.
///
/// Poses are in the world of the component's transform, else of the chunk's; where there is
/// neither, in the chunk's own frame of no known unit, and a warning says so. Skew (b2) and k4 have
/// no place in COLMAP's models and are left out of the intrinsics with a warning.
/// Throws format_error where it is no such file, a matrix is not a pose, or there is no camera.
/// Source: Agisoft Metashape Professional manual 2.0, Appendix D (camera models).
[[nodiscard]] posed_images read_metashape(const std::filesystem::path& path);

namespace detail {

/// Reads one document; errors carry the file.
class metashape_reader {
 public:
  explicit metashape_reader(const std::filesystem::path& path) : path_(path) {
    const std::string text = read_file(path);
    const pugi::xml_parse_result parsed = document_.load_buffer(text.data(), text.size());
    if (!parsed) {
      throw format_error(path, at_byte{static_cast<std::uint64_t>(parsed.offset)},
                         message("xml: ", parsed.description()));
    }
    chunk_ = document_.child("document").child("chunk");
    if (!chunk_) fail("<document><chunk> expected");
  }

  posed_images read() {
    read_sensors();
    read_worlds();
    posed_images images;
    for (const pugi::xpath_node& node : chunk_.child("cameras").select_nodes(".//camera"))
      add(images, node.node());
    images.trajectory = checked_trajectory(std::move(images.trajectory), path_, "metashape");
    finish(images);
    return images;
  }

 private:
  void read_sensors() {
    for (const pugi::xml_node sensor : chunk_.child("sensors").children("sensor"))
      sensors_[sensor.attribute("id").value()] = camera_of(sensor);
  }

  /// Transforms to the world by component; that of the chunk has the name "".
  void read_worlds() {
    if (const auto world = world_of(chunk_)) worlds_[""] = *world;
    for (const pugi::xml_node component : chunk_.child("components").children("component")) {
      if (const auto world = world_of(component))
        worlds_[component.attribute("id").value()] = *world;
    }
  }

  void add(posed_images& images, const pugi::xml_node& camera) {
    const std::string label = camera.attribute("label").value();
    images.trajectory.names.push_back(label);
    images.trajectory.world_from_camera.push_back(pose_of(camera, label));
    const auto sensor = sensors_.find(camera.attribute("sensor_id").value());
    if (sensor != sensors_.end() && sensor->second) images.cameras.push_back(*sensor->second);
  }

  math::rigid3 pose_of(const pugi::xml_node& camera, const std::string& label) {
    const pugi::xml_node transform = camera.child("transform");
    if (!transform) return unregistered_pose();
    const std::vector<double> n = numbers(transform, 16);
    const std::string component = camera.attribute("component_id").value();
    try {
      const math::rigid3 pose = pose_from_matrix(matrix_of_rows(n));
      const auto world = worlds_.contains(component) ? worlds_.find(component) : worlds_.find("");
      components_.insert(component);
      if (world != worlds_.end()) return world->second * pose;
      in_chunk_frame_ = true;
      return pose;
    } catch (const argument_error& e) {
      fail(message("camera '", label, "': ", e.what()));
    }
  }

  std::optional<math::sim3> world_of(const pugi::xml_node& owner) const {
    const pugi::xml_node transform = owner.child("transform");
    if (!transform.child("rotation") || !transform.child("translation")) return std::nullopt;
    const std::vector<double> r = numbers(transform.child("rotation"), 9);
    const std::vector<double> t = numbers(transform.child("translation"), 3);
    const double scale = transform.child("scale") ? numbers(transform.child("scale"), 1)[0] : 1;
    pose_matrix matrix;
    matrix << r[0], r[1], r[2], t[0], r[3], r[4], r[5], t[1], r[6], r[7], r[8], t[2];
    try {
      const math::rigid3 rigid = pose_from_matrix(matrix);
      if (!rigid.is_finite() || !(scale > 0) || !std::isfinite(scale))
        throw argument_error("finite numbers and a scale above 0 expected");
      return math::sim3{scale, rigid.rotation, rigid.translation};
    } catch (const argument_error& e) {
      fail(message("<transform> to the world: ", e.what()));
    }
  }

  /// The adjusted calibration of a sensor, else its first; nothing where it has none of a known
  /// type.
  std::optional<math::camera> camera_of(const pugi::xml_node& sensor) {
    using math::camera_model;
    pugi::xml_node c = sensor.find_child_by_attribute("calibration", "class", "adjusted");
    if (!c) c = sensor.child("calibration");
    const pugi::xml_node resolution = sensor.child("resolution");
    const auto width = number(resolution.attribute("width").value());
    const auto height = number(resolution.attribute("height").value());
    if (!c || !(width >= 1 && width < 1e9) || !(height >= 1 && height < 1e9)) return std::nullopt;
    const auto of = [&](camera_model model, std::vector<double> parameters) {
      return math::camera{model, static_cast<std::uint64_t>(width),
                          static_cast<std::uint64_t>(height), std::move(parameters)};
    };
    const auto d = [&](const char* name) {
      const pugi::xml_node value = c.child(name);
      return value ? numbers(value, 1)[0] : 0;
    };
    const std::string_view type = c.attribute("type").value();
    if (type == "spherical") return of(camera_model::equirectangular, {width, height});
    if (!c.child("f")) return std::nullopt;
    const double fx = d("f") + d("b1");
    const double cx = width / 2 + d("cx");
    const double cy = height / 2 + d("cy");
    left_out_ |= d("b2") != 0;
    if (type == "fisheye") {
      left_out_ |= d("p1") != 0 || d("p2") != 0;
      return of(camera_model::opencv_fisheye,
                {fx, d("f"), cx, cy, d("k1"), d("k2"), d("k3"), d("k4")});
    }
    if (type != "frame") return std::nullopt;
    left_out_ |= d("k4") != 0;
    // Metashape's p1 and p2 stand in the other order than OpenCV's.
    return of(camera_model::full_opencv,
              {fx, d("f"), cx, cy, d("k1"), d("k2"), d("p2"), d("p1"), d("k3"), 0, 0, 0});
  }

  void finish(posed_images& images) const {
    std::vector<std::string>& warnings = images.trajectory.warnings;
    const auto chunks = document_.child("document").children("chunk");
    const auto n_chunks = std::distance(chunks.begin(), chunks.end());
    if (n_chunks > 1) warnings.push_back(message("the first of ", n_chunks, " chunks is read"));
    if (in_chunk_frame_)
      warnings.push_back("no transform to the world: the frame and unit of the chunk");
    if (components_.size() > 1) {
      warnings.push_back(message("the cameras lie in ", components_.size(),
                                 " components, which need not fit each other"));
    }
    if (left_out_) warnings.push_back("b2, k4 or p of a fisheye are left out of the intrinsics");
    drop_some_cameras(images);
  }

  static double number(std::string_view text) {
    return parse<double>(trim(text)).value_or(std::nan(""));
  }

  std::vector<double> numbers(const pugi::xml_node& node, std::size_t n) const {
    std::vector<std::string_view> fields;
    split(node.child_value(), fields);
    std::vector<double> values;
    for (const std::string_view field : fields) {
      const auto value = parse<double>(field);
      if (!value) fail(message("<", node.name(), ">: a number expected, found '", field, "'"));
      values.push_back(*value);
    }
    if (values.size() != n)
      fail(message("<", node.name(), ">: ", n, " numbers expected, found ", values.size()));
    return values;
  }

  [[noreturn]] void fail(std::string_view what) const {
    throw format_error(path_, message("metashape: ", what));
  }

  const std::filesystem::path& path_;
  pugi::xml_document document_;
  pugi::xml_node chunk_;
  std::map<std::string, std::optional<math::camera>> sensors_;
  std::map<std::string, math::sim3> worlds_;
  std::set<std::string> components_;
  bool in_chunk_frame_ = false;
  bool left_out_ = false;
};

}  // namespace detail

inline posed_images read_metashape(const std::filesystem::path& path) {
  return detail::metashape_reader(path).read();
}

}  // namespace aib::io
