// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/cloud.hpp>
#include <aib/core/error.hpp>
#include <aib/io/bytes.hpp>
#include <aib/io/file.hpp>
#include <aib/mesh/mesh.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace aib::io {

/// A number for each point or face, written as a float property of this name.
struct ply_scalar {
  std::string name;
  std::span<const float> values;
};

struct ply_cloud_extras {
  std::vector<ply_scalar> scalars = {};       ///< one value a point
  std::span<const cloud::color> colors = {};  ///< instead of the cloud's own
  std::vector<std::string> comments = {};
};

struct ply_mesh_extras {
  std::span<const cloud::color> vertex_colors = {};
  std::span<const cloud::color> face_colors = {};
  std::vector<ply_scalar> face_scalars = {};  ///< one value a triangle
  std::vector<std::string> comments = {};
};

/// Writes a cloud as binary little-endian PLY: x y z as float, or as double where the cloud has an
/// origin; then what it has of normals, colours, label and the scalars.
///
/// Throws argument_error where a column is not as long as the cloud, io_error where the file cannot
/// be written.
void write_ply(const std::filesystem::path& path,
               const cloud::cloud& cloud,
               const ply_cloud_extras& extras = {});

/// Writes a mesh as binary little-endian PLY; labels become a face property, their names a comment.
void write_ply(const std::filesystem::path& path,
               const mesh::mesh& mesh,
               const ply_mesh_extras& extras = {});

namespace detail {

/// How a position is stored: as floats, or as doubles.
enum class coordinate { single, wide };

[[nodiscard]] inline coordinate coordinate_for(const Eigen::Vector3d& origin) {
  return origin.isZero(0) ? coordinate::single : coordinate::wide;
}

/// Builds header and rows of a PLY file and hands them on in large pieces.
class ply_writer {
 public:
  explicit ply_writer(const std::filesystem::path& path) : file_(path) {
    buffer_ = "ply\nformat binary_little_endian 1.0\n";
  }

  void comment(std::string_view text) {
    std::string line(text);
    std::replace(line.begin(), line.end(), '\n', ' ');
    buffer_ += message("comment ", line, "\n");
  }
  void element(std::string_view name, std::uint64_t count) {
    buffer_ += message("element ", name, " ", count, "\n");
  }
  /// As many bytes for any count: a comment takes what is left.
  void element_for_later(std::string_view name) {
    later_at_ = buffer_.size();
    buffer_ += later_text(name, 0);
  }
  void set_count(std::string_view name, std::uint64_t count) {
    flush();
    file_.write_at(later_at_, later_text(name, count));
  }
  void property(std::string_view type, std::string_view name) {
    buffer_ += message("property ", type, " ", name, "\n");
  }
  void color_properties() {
    for (const char* channel : {"red", "green", "blue"}) property("uchar", channel);
  }
  void end_header() { buffer_ += "end_header\n"; }

  template <class T>
  void number(T value) {
    store(buffer_, value);
  }
  void position(coordinate as, const Eigen::Vector3d& origin, const Eigen::Vector3f& point) {
    for (int k = 0; k < 3; ++k) {
      if (as == coordinate::single) number(point[k]);
      if (as == coordinate::wide) number(origin[k] + static_cast<double>(point[k]));
    }
  }
  void color(const cloud::color& c) {
    for (const std::uint8_t channel : c) number(channel);
  }
  void end_row() {
    if (buffer_.size() >= std::size_t{1} << 20) flush();
  }
  void commit() {
    flush();
    file_.commit();
  }

 private:
  void flush() {
    file_.write(buffer_);
    buffer_.clear();
  }
  static std::string later_text(std::string_view name, std::uint64_t count) {
    constexpr std::size_t most_digits = 20;
    const std::string digits = message(count);
    return message("element ", name, " ", digits, "\ncomment ",
                   std::string(most_digits - digits.size(), '.'), "\n");
  }

  output_file file_;
  std::string buffer_;
  std::uint64_t later_at_ = 0;
};

inline void position_properties(ply_writer& out, coordinate as) {
  for (const char* axis : {"x", "y", "z"})
    out.property(as == coordinate::single ? "float" : "double", axis);
}

inline void demand_length(std::string_view column, std::size_t found, std::size_t expected) {
  if (found == 0 || found == expected) return;
  throw argument_error(
      message("io::write_ply: ", column, ": ", expected, " values expected, found ", found));
}

inline void check_scalars(const std::vector<ply_scalar>& scalars, std::size_t expected) {
  for (const ply_scalar& s : scalars) {
    if (s.name.empty() || s.name.find_first_of(" \t\r\n") != std::string::npos)
      throw argument_error(message("io::write_ply: \"", s.name, "\" is not a name of a property"));
    if (s.values.size() != expected)
      throw argument_error(message("io::write_ply: ", s.name, ": ", expected,
                                   " values expected, found ", s.values.size()));
  }
}

inline std::string label_comment(const std::vector<std::string>& names) {
  std::string comment = "labels:";
  for (std::size_t i = 0; i < names.size(); ++i) {
    std::string name = names[i];
    std::replace(name.begin(), name.end(), ' ', '_');
    if (!name.empty()) comment += message(" ", i, "=", name);
  }
  return comment;
}

/// What every point of a cloud has.
inline void cloud_properties(ply_writer& out,
                             coordinate as,
                             const cloud::cloud& cloud,
                             std::span<const cloud::color> colors) {
  position_properties(out, as);
  if (!cloud.normals.empty())
    for (const char* axis : {"nx", "ny", "nz"}) out.property("float", axis);
  if (!colors.empty()) out.color_properties();
  if (!cloud.labels.empty()) out.property("uint", "label");
}

inline void cloud_row(ply_writer& out,
                      coordinate as,
                      const cloud::cloud& cloud,
                      std::span<const cloud::color> colors,
                      std::size_t i) {
  out.position(as, cloud.origin, cloud.points[i]);
  if (!cloud.normals.empty())
    for (int k = 0; k < 3; ++k) out.number(cloud.normals[i][k]);
  if (!colors.empty()) out.color(colors[i]);
  if (!cloud.labels.empty()) out.number(cloud.labels[i]);
}

inline void check_columns(const cloud::cloud& cloud, std::span<const cloud::color> colors) {
  demand_length("normals", cloud.normals.size(), cloud.size());
  demand_length("colors", colors.size(), cloud.size());
  demand_length("labels", cloud.labels.size(), cloud.size());
}

}  // namespace detail

inline void write_ply(const std::filesystem::path& path,
                      const cloud::cloud& cloud,
                      const ply_cloud_extras& extras) {
  const auto colors =
      extras.colors.empty() ? std::span<const cloud::color>(cloud.colors) : extras.colors;
  detail::check_columns(cloud, colors);
  detail::check_scalars(extras.scalars, cloud.size());

  const auto as = detail::coordinate_for(cloud.origin);
  detail::ply_writer out(path);
  for (const std::string& c : extras.comments) out.comment(c);
  out.element("vertex", cloud.size());
  detail::cloud_properties(out, as, cloud, colors);
  for (const ply_scalar& s : extras.scalars) out.property("float", s.name);
  out.end_header();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    detail::cloud_row(out, as, cloud, colors, i);
    for (const ply_scalar& s : extras.scalars) out.number(s.values[i]);
    out.end_row();
  }
  out.commit();
}

inline void write_ply(const std::filesystem::path& path,
                      const mesh::mesh& mesh,
                      const ply_mesh_extras& extras) {
  const std::size_t n_faces = mesh.triangles.size();
  detail::demand_length("vertex_colors", extras.vertex_colors.size(), mesh.vertices.size());
  detail::demand_length("face_colors", extras.face_colors.size(), n_faces);
  detail::demand_length("labels", mesh.labels.size(), n_faces);
  detail::check_scalars(extras.face_scalars, n_faces);

  const auto as = detail::coordinate_for(mesh.origin);
  detail::ply_writer out(path);
  for (const std::string& c : extras.comments) out.comment(c);
  if (!mesh.label_names.empty()) out.comment(detail::label_comment(mesh.label_names));
  out.element("vertex", mesh.vertices.size());
  detail::position_properties(out, as);
  if (!extras.vertex_colors.empty()) out.color_properties();
  out.element("face", n_faces);
  out.property("list uchar uint", "vertex_indices");
  if (!mesh.labels.empty()) out.property("uint", "label");
  if (!extras.face_colors.empty()) out.color_properties();
  for (const ply_scalar& s : extras.face_scalars) out.property("float", s.name);
  out.end_header();
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    out.position(as, mesh.origin, mesh.vertices[i]);
    if (!extras.vertex_colors.empty()) out.color(extras.vertex_colors[i]);
    out.end_row();
  }
  for (std::size_t i = 0; i < n_faces; ++i) {
    out.number(std::uint8_t{3});
    for (const std::uint32_t v : mesh.triangles[i]) out.number(v);
    if (!mesh.labels.empty()) out.number(mesh.labels[i]);
    if (!extras.face_colors.empty()) out.color(extras.face_colors[i]);
    for (const ply_scalar& s : extras.face_scalars) out.number(s.values[i]);
    out.end_row();
  }
  out.commit();
}

}  // namespace aib::io
