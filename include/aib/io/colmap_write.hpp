// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/cloud.hpp>
#include <aib/core/error.hpp>
#include <aib/io/bytes.hpp>
#include <aib/io/colmap.hpp>
#include <aib/io/file.hpp>
#include <aib/io/posed_images.hpp>
#include <aib/math/camera.hpp>
#include <aib/math/rotation.hpp>
#include <aib/pose/trajectory.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

namespace aib::io {

/// Writes cameras, images and points3D into a folder, which is made where it is not there. Images
/// have no observations and points no tracks; poses that are not registered are left out.
///
/// Throws argument_error where names, image or camera ids do not fit the poses, an image has no
/// name or one with a line end, or no pose is registered.
void write_colmap(const std::filesystem::path& folder,
                  const colmap_model& model,
                  colmap_encoding encoding = colmap_encoding::binary);

/// A model of the images, numbered from 1; equal intrinsics become one camera.
/// Throws argument_error where the images have no names or no cameras.
[[nodiscard]] colmap_model make_colmap_model(const posed_images& images);

namespace colmap::detail {

inline bool same_camera(const math::camera& a, const math::camera& b) {
  return a.model == b.model && a.width == b.width && a.height == b.height &&
         a.parameters == b.parameters;
}

inline void check_writable(const colmap_model& m) {
  const pose::trajectory& t = m.trajectory;
  if (t.names.size() != t.size() || m.image_ids.size() != t.size() ||
      m.camera_ids.size() != t.size()) {
    throw argument_error(message("write_colmap: ", t.size(), " poses, ", t.names.size(), " names, ",
                                 m.image_ids.size(), " image ids, ", m.camera_ids.size(),
                                 " camera ids: one of each a pose expected"));
  }
  for (std::size_t i = 0; i < t.size(); ++i) {
    if (t.names[i].empty() ||
        t.names[i].find_first_of(std::string_view("\n\r\0", 3)) != std::string::npos)
      throw argument_error(message("write_colmap: pose ", i, " has a name that cannot be written"));
    if (!m.cameras.contains(m.camera_ids[i]))
      throw argument_error(message("write_colmap: no camera ", m.camera_ids[i]));
  }
}

/// Puts numbers and names one after another, as text lines or as bytes.
class record_writer {
 public:
  explicit record_writer(colmap_encoding encoding) : encoding_(encoding) {}

  void begin(std::uint64_t n_records, std::string_view comment) {
    if (is_text()) {
      out_ += message("# ", comment, '\n');
    } else {
      store(out_, n_records);
    }
  }
  template <class Number>
  void put(Number number) {
    if (is_text()) {
      out_ += message(number, ' ');
    } else {
      store(out_, number);
    }
  }
  void put_model(math::camera_model model) {
    if (is_text()) {
      out_ += message(math::info(model).name, ' ');
    } else {
      store(out_, static_cast<std::int32_t>(model));
    }
  }
  void put_name(const std::string& name) {
    out_ += name;
    if (!is_text()) out_ += '\0';
  }
  /// An empty list: in text, the line's end says so.
  void put_empty_list() {
    if (!is_text()) store(out_, std::uint64_t{0});
  }
  void end_line() {
    if (is_text()) out_ += '\n';
  }
  void save(const fs::path& folder, const char* stem) const {
    write_file(folder / (std::string(stem) + (is_text() ? ".txt" : ".bin")), out_);
  }

 private:
  [[nodiscard]] bool is_text() const { return encoding_ == colmap_encoding::text; }

  colmap_encoding encoding_;
  std::string out_;
};

inline void write_cameras(const fs::path& folder, const colmap_model& m, colmap_encoding encoding) {
  record_writer out(encoding);
  out.begin(m.cameras.size(), "CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]");
  for (const auto& [id, camera] : m.cameras) {
    if (camera.parameters.size() != math::info(camera.model).n_parameters) {
      throw argument_error(message("write_colmap: camera ", id, ": ",
                                   math::info(camera.model).n_parameters,
                                   " parameters expected, found ", camera.parameters.size()));
    }
    out.put(id);
    out.put_model(camera.model);
    out.put(camera.width);
    out.put(camera.height);
    for (const double parameter : camera.parameters) out.put(parameter);
    out.end_line();
  }
  out.save(folder, "cameras");
}

inline void write_images(const fs::path& folder, const colmap_model& m, colmap_encoding encoding) {
  const auto& poses = m.trajectory.world_from_camera;
  const auto registered = std::count_if(poses.begin(), poses.end(),
                                        [](const math::rigid3& p) { return p.is_finite(); });
  if (registered == 0) throw argument_error("write_colmap: no registered pose to write");
  record_writer out(encoding);
  out.begin(static_cast<std::uint64_t>(registered),
            "IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME; then POINTS2D[]");
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (!poses[i].is_finite()) continue;
    const math::rigid3 camera_from_world = poses[i].inverse();
    const math::quaternion q = math::quaternion_from(camera_from_world.rotation);
    out.put(m.image_ids[i]);
    for (const double number : {q.w, q.x, q.y, q.z}) out.put(number);
    for (const double number : camera_from_world.translation) out.put(number);
    out.put(m.camera_ids[i]);
    out.put_name(m.trajectory.names[i]);
    out.end_line();
    out.put_empty_list();
    out.end_line();
  }
  out.save(folder, "images");
}

inline void write_points(const fs::path& folder, const colmap_model& m, colmap_encoding encoding) {
  constexpr double unknown_error = -1;
  const auto n = static_cast<std::uint64_t>(m.points.size());
  record_writer out(encoding);
  out.begin(n, "POINT3D_ID, X, Y, Z, R, G, B, ERROR, TRACK[]");
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector3d p = m.points.position(i);
    out.put(static_cast<std::uint64_t>(i + 1));
    for (const double number : p) out.put(number);
    const cloud::color color = m.points.colors.empty() ? cloud::color{} : m.points.colors[i];
    for (const std::uint8_t channel : color) out.put(channel);
    out.put(m.point_errors_px.empty() ? unknown_error : m.point_errors_px[i]);
    out.put_empty_list();
    out.end_line();
  }
  out.save(folder, "points3D");
}

}  // namespace colmap::detail

inline void write_colmap(const std::filesystem::path& folder,
                         const colmap_model& model,
                         colmap_encoding encoding) {
  colmap::detail::check_writable(model);
  std::error_code code;
  std::filesystem::create_directories(folder, code);
  if (code) throw output_error(folder, message("cannot create: ", code.message()));
  colmap::detail::write_cameras(folder, model, encoding);
  colmap::detail::write_images(folder, model, encoding);
  colmap::detail::write_points(folder, model, encoding);
}

inline colmap_model make_colmap_model(const posed_images& images) {
  pose::check(images.trajectory);
  const std::size_t n = images.trajectory.size();
  if (images.trajectory.names.empty() || images.cameras.size() != n) {
    throw argument_error(message("make_colmap_model: names and cameras for ", n,
                                 " poses expected, found ", images.trajectory.names.size(),
                                 " names and ", images.cameras.size(), " cameras"));
  }
  colmap_model model;
  model.trajectory = images.trajectory;
  for (std::size_t i = 0; i < n; ++i) {
    const auto known =
        std::find_if(model.cameras.begin(), model.cameras.end(), [&](const auto& entry) {
          return colmap::detail::same_camera(entry.second, images.cameras[i]);
        });
    const auto id = known != model.cameras.end()
                        ? known->first
                        : static_cast<std::uint32_t>(model.cameras.size() + 1);
    model.cameras.try_emplace(id, images.cameras[i]);
    model.image_ids.push_back(static_cast<std::uint32_t>(i + 1));
    model.camera_ids.push_back(id);
  }
  return model;
}

}  // namespace aib::io
