// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/io/colmap_records.hpp>
#include <aib/io/file.hpp>
#include <aib/io/text.hpp>
#include <aib/math/camera.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// COLMAP's text files of every version to 4.2.
/// Source: COLMAP, scene/reconstruction_io_text.cc.
namespace aib::io::colmap::text {

[[nodiscard]] std::map<std::uint32_t, math::camera> read_cameras(const std::filesystem::path& path);
/// An image takes two lines, of which the second (its observations, skipped) may be empty. A name
/// may hold blanks.
[[nodiscard]] std::vector<image> read_images(const std::filesystem::path& path);
[[nodiscard]] std::map<std::uint32_t, rig> read_rigs(const std::filesystem::path& path);
[[nodiscard]] std::vector<frame> read_frames(const std::filesystem::path& path);
/// Tracks are counted, not kept.
[[nodiscard]] points read_points(const std::filesystem::path& path);
[[nodiscard]] std::size_t count_points(const std::filesystem::path& path);

namespace detail {

/// Takes the fields of a line one after another. Throws argument_error where one is missing or is
/// not what is expected.
class field_reader {
 public:
  explicit field_reader(std::string_view line) : rest_(trim(line)) {}

  [[nodiscard]] bool done() const { return rest_.empty(); }
  [[nodiscard]] std::string_view rest() const { return rest_; }

  std::string_view next(std::string_view what) {
    if (rest_.empty()) throw argument_error(message(what, " expected, found the end of the line"));
    const std::size_t end = std::min(rest_.find_first_of(" \t"), rest_.size());
    const std::string_view field = rest_.substr(0, end);
    rest_.remove_prefix(end);
    rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t"), rest_.size()));
    return field;
  }

  template <class Number>
  Number number(std::string_view what) {
    const std::string_view field = next(what);
    if (const auto value = parse<Number>(field)) return *value;
    throw argument_error(message(what, " expected, found '", field, "'"));
  }

 private:
  std::string_view rest_;
};

/// Calls `record(fields, lines)` for each line that is neither blank nor a comment and puts the
/// line before what is refused.
template <class Record>
void read_records(const std::filesystem::path& path, Record&& record) {
  const std::string content = read_file(path);
  line_reader lines(content, path);
  while (lines.next_content()) {
    field_reader fields(lines.line());
    try {
      record(fields, lines);
    } catch (const argument_error& e) {
      lines.fail(message("colmap: ", e.what()));
    }
  }
}

inline Eigen::Vector3d read_vector(field_reader& in, std::string_view what) {
  const auto x = in.number<double>(what);
  const auto y = in.number<double>(what);
  const auto z = in.number<double>(what);
  return {x, y, z};
}

inline math::rigid3 read_pose(field_reader& in) {
  math::quaternion q;
  q.w = in.number<double>("quaternion");
  q.x = in.number<double>("quaternion");
  q.y = in.number<double>("quaternion");
  q.z = in.number<double>("quaternion");
  return written_pose(q, read_vector(in, "translation"));
}

inline sensor read_sensor(field_reader& in) {
  const std::string_view kind = in.next("kind of sensor");
  const auto id = in.number<std::uint32_t>("sensor id");
  if (kind == "CAMERA") return {camera_sensor, id};
  if (kind == "IMU") return {imu_sensor, id};
  throw argument_error(message("kind of sensor CAMERA or IMU expected, found '", kind, "'"));
}

/// Whether a line can be the observations of an image: X, Y, POINT3D_ID and so on. Long lines are
/// believed: only a short one can be the next image, its blank line lost.
inline bool is_observations(std::string_view line) {
  constexpr std::size_t longest_image_line = 4096;
  if (line.size() > longest_image_line) return true;
  std::size_t n = 0;
  for (field_reader fields(line); !fields.done(); ++n) {
    if (!parse<double>(fields.next("observation"))) return false;
  }
  return n % 3 == 0;
}

inline void expect_end(const field_reader& fields) {
  if (!fields.done())
    throw argument_error(message("the end of the line expected, found '", fields.rest(), "'"));
}

}  // namespace detail

inline std::map<std::uint32_t, math::camera> read_cameras(const std::filesystem::path& path) {
  std::map<std::uint32_t, math::camera> cameras;
  detail::read_records(path, [&](detail::field_reader& in, line_reader&) {
    const auto id = in.number<std::uint32_t>("camera id");
    const std::string_view name = in.next("camera model");
    const auto model = math::find_camera_model(name);
    if (!model) throw argument_error(message("camera model '", name, "' is not known"));
    math::camera camera{*model, 0, 0, {}};
    camera.width = in.number<std::uint64_t>("camera width");
    camera.height = in.number<std::uint64_t>("camera height");
    while (!in.done()) camera.parameters.push_back(in.number<double>("camera parameter"));
    if (camera.parameters.size() != math::info(*model).n_parameters) {
      throw argument_error(message(math::info(*model).n_parameters, " parameters of ", name,
                                   " expected, found ", camera.parameters.size()));
    }
    add_camera(cameras, id, std::move(camera));
  });
  return cameras;
}

inline std::vector<image> read_images(const std::filesystem::path& path) {
  std::vector<image> images;
  detail::read_records(path, [&](detail::field_reader& in, line_reader& lines) {
    image i;
    i.id = in.number<std::uint32_t>("image id");
    i.camera_from_world = detail::read_pose(in);
    i.camera_id = in.number<std::uint32_t>("camera id");
    i.name = in.rest();
    if (i.name.empty()) throw argument_error("image name expected, found the end of the line");
    images.push_back(std::move(i));
    if (lines.next() && !detail::is_observations(lines.line())) {
      throw argument_error(
          "observations (x, y, point id) or an empty line expected after an image's line");
    }
  });
  return images;
}

inline std::map<std::uint32_t, rig> read_rigs(const std::filesystem::path& path) {
  std::map<std::uint32_t, rig> rigs;
  detail::read_records(path, [&](detail::field_reader& in, line_reader&) {
    rig r;
    const auto id = in.number<std::uint32_t>("rig id");
    const auto n_sensors = in.number<std::uint32_t>("number of sensors");
    if (n_sensors > 0) r.reference = detail::read_sensor(in);
    for (std::uint32_t i = 1; i < n_sensors; ++i) {
      const sensor s = detail::read_sensor(in);
      if (in.number<int>("whether the sensor has a pose") != 0)
        r.sensor_from_rig[s] = detail::read_pose(in);
    }
    detail::expect_end(in);
    add_rig(rigs, id, std::move(r));
  });
  return rigs;
}

inline std::vector<frame> read_frames(const std::filesystem::path& path) {
  std::vector<frame> frames;
  detail::read_records(path, [&](detail::field_reader& in, line_reader&) {
    frame f;
    static_cast<void>(in.number<std::uint32_t>("frame id"));
    f.rig_id = in.number<std::uint32_t>("rig id");
    f.rig_from_world = detail::read_pose(in);
    const auto n = in.number<std::uint32_t>("number of images");
    for (std::uint32_t i = 0; i < n; ++i) {
      const sensor s = detail::read_sensor(in);
      f.data.emplace_back(s, in.number<std::uint64_t>("image id"));
    }
    detail::expect_end(in);
    frames.push_back(std::move(f));
  });
  return frames;
}

inline points read_points(const std::filesystem::path& path) {
  points p;
  detail::read_records(path, [&](detail::field_reader& in, line_reader&) {
    static_cast<void>(in.number<std::uint64_t>("point id"));
    p.positions.push_back(detail::read_vector(in, "point"));
    cloud::color color;
    for (std::uint8_t& channel : color) channel = in.number<std::uint8_t>("color");
    p.colors.push_back(color);
    p.errors_px.push_back(in.number<double>("point error"));
    std::uint64_t fields = 0;
    for (; !in.done(); ++fields) in.next("track");
    if (fields % 2 != 0)
      throw argument_error(message("track: pairs of numbers expected, found ", fields));
    p.track_lengths.push_back(fields / 2);
  });
  return p;
}

inline std::size_t count_points(const std::filesystem::path& path) {
  std::size_t n = 0;
  detail::read_records(path, [&](detail::field_reader&, line_reader&) { ++n; });
  return n;
}

}  // namespace aib::io::colmap::text
