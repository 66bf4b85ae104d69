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
#include <aib/math/rotation.hpp>
#include <aib/pose/trajectory.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace aib::io {

/// A RealityCapture csv file of internal and external camera parameters. Its columns are found by
/// the names in the first line: `#name,x,y,alt,heading,pitch,roll,f,...`; angles are degrees.
///
/// size   of the images, which the file does not say: f (35 mm equivalent) becomes pixels with it.
///        Where it is 0 there are no cameras.
///
/// Principal point and distortion are not taken over (their units are not documented): the cameras
/// are pinholes with the centre of the image; a warning says so where they are not 0.
/// Throws format_error for a missing column, a line of another length and a file without an image.
[[nodiscard]] posed_images read_reality_capture(const std::filesystem::path& path,
                                                const image_extent& size = {});

namespace detail {

/// The rows of a csv file with named columns.
class csv_table {
 public:
  csv_table(std::string_view text, const std::filesystem::path& path) : lines_(text, path) {
    if (!lines_.next()) throw format_error(path, "reality_capture: the file is empty");
    std::string_view header = trim(lines_.line());
    if (header.starts_with('#')) header.remove_prefix(1);
    std::vector<std::string_view> names;
    split(header, names, ',');
    n_columns_ = names.size();
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (!columns_.emplace(names[i], i).second && !names[i].empty())
        lines_.fail(message("reality_capture: column '", names[i], "' comes twice"));
    }
  }

  bool next() {
    if (!lines_.next_content()) return false;
    split(lines_.line(), fields_, ',');
    if (fields_.size() != n_columns_) {
      lines_.fail(
          message("reality_capture: ", n_columns_, " columns expected, found ", fields_.size()));
    }
    return true;
  }
  [[nodiscard]] bool has(const std::string& column) const { return columns_.contains(column); }
  [[nodiscard]] std::string_view text(const std::string& column) const {
    const auto found = columns_.find(column);
    if (found == columns_.end())
      lines_.fail(message("reality_capture: no column '", column, "' in the first line"));
    return fields_[found->second];
  }
  [[nodiscard]] double number(const std::string& column) const {
    const std::string_view field = text(column);
    if (const auto value = parse<double>(field)) return *value;
    lines_.fail(message("reality_capture: ", column, ": a number expected, found '", field, "'"));
  }

 private:
  line_reader lines_;
  std::size_t n_columns_ = 0;
  std::map<std::string, std::size_t> columns_;
  std::vector<std::string_view> fields_;
};

/// Orientation of a camera from its angles in degrees: heading clockwise from north, pitch, roll.
inline Eigen::Matrix3d rotation_of_angles(double heading, double pitch, double roll) {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  return (AngleAxisd(-math::radians(heading), Vector3d::UnitZ()) *
          AngleAxisd(math::radians(pitch), Vector3d::UnitX()) *
          AngleAxisd(math::radians(roll), Vector3d::UnitY()))
      .toRotationMatrix();
}

}  // namespace detail

inline posed_images read_reality_capture(const std::filesystem::path& path,
                                         const image_extent& size) {
  constexpr std::array unused{"px", "py", "k1", "k2", "k3", "k4", "t1", "t2"};
  constexpr double film_width_mm = 36;
  const auto width = static_cast<double>(size.width);
  const auto height = static_cast<double>(size.height);
  const std::string content = read_file(path);
  detail::csv_table table(content, path);
  posed_images images;
  bool left_out = false;
  while (table.next()) {
    const double heading = table.number("heading");
    const double pitch = table.number("pitch");
    const double roll = table.number("roll");
    pose_matrix matrix;
    matrix.leftCols<3>() = detail::rotation_of_angles(heading, pitch, roll);
    matrix.col(3) = Eigen::Vector3d{table.number("x"), table.number("y"), table.number("alt")};
    images.trajectory.names.emplace_back(table.text("name"));
    images.trajectory.world_from_camera.push_back(
        pose_from_matrix(matrix, {pose_convention::world_from_camera, camera_axes::opengl}));
    if (size.width == 0 || !table.has("f")) continue;
    const double f = table.number("f") * std::max(width, height) / film_width_mm;
    images.cameras.push_back(math::pinhole(size.width, size.height, f, f, width / 2, height / 2));
    for (const char* column : unused) left_out |= table.has(column) && table.number(column) != 0;
  }
  images.trajectory = checked_trajectory(std::move(images.trajectory), path, "reality_capture");
  if (left_out) {
    images.trajectory.warnings.push_back(
        "principal points and distortion are left out of the intrinsics");
  }
  return images;
}

}  // namespace aib::io
