// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/io/byte_stream.hpp>
#include <aib/io/colmap_records.hpp>
#include <aib/io/file.hpp>
#include <aib/math/camera.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// COLMAP's binary files, little endian, of every version to 4.2.
/// Source: COLMAP, scene/reconstruction_io_binary.cc.
namespace aib::io::colmap::binary {

[[nodiscard]] std::map<std::uint32_t, math::camera> read_cameras(const std::filesystem::path& path);
/// Observations in the images are skipped unread.
[[nodiscard]] std::vector<image> read_images(const std::filesystem::path& path);
[[nodiscard]] std::map<std::uint32_t, rig> read_rigs(const std::filesystem::path& path);
[[nodiscard]] std::vector<frame> read_frames(const std::filesystem::path& path);
/// Tracks are counted, not kept.
[[nodiscard]] points read_points(const std::filesystem::path& path);
[[nodiscard]] std::size_t count_points(const std::filesystem::path& path);

namespace detail {

/// Reads a file of `count, record, record, ...`; refuses bytes after the last record.
template <class Record>
void read_records(const std::filesystem::path& path,
                  std::size_t record_bytes,
                  std::string_view what,
                  Record&& record) {
  const input_file file(path);
  byte_stream in(file);
  const auto count = in.read_count<std::uint64_t>(record_bytes, message("colmap: ", what));
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t begin = in.offset();
    try {
      record(in);
    } catch (const argument_error& e) {
      throw format_error(path, at_byte{begin}, message("colmap: ", what, ": ", e.what()));
    }
  }
  if (in.left() > 0)
    in.fail(message("colmap: ", in.left(), " bytes after the last of ", count, " ", what));
}

inline Eigen::Vector3d read_vector(byte_stream& in, std::string_view what) {
  const auto x = in.read_number<double>(what);
  const auto y = in.read_number<double>(what);
  const auto z = in.read_number<double>(what);
  return {x, y, z};
}

inline math::rigid3 read_pose(byte_stream& in) {
  math::quaternion q;
  q.w = in.read_number<double>("colmap: quaternion");
  q.x = in.read_number<double>("colmap: quaternion");
  q.y = in.read_number<double>("colmap: quaternion");
  q.z = in.read_number<double>("colmap: quaternion");
  return written_pose(q, read_vector(in, "colmap: translation"));
}

inline sensor read_sensor(byte_stream& in) {
  const auto kind = in.read_number<std::int32_t>("colmap: kind of sensor");
  return {kind, in.read_number<std::uint32_t>("colmap: sensor id")};
}

}  // namespace detail

inline std::map<std::uint32_t, math::camera> read_cameras(const std::filesystem::path& path) {
  std::map<std::uint32_t, math::camera> cameras;
  detail::read_records(path, 40, "cameras", [&](byte_stream& in) {
    const auto id = in.read_number<std::uint32_t>("colmap: camera id");
    const auto model_id = in.read_number<std::int32_t>("colmap: camera model");
    const auto model = math::find_camera_model(model_id);
    if (!model)
      throw argument_error(message("camera ", id, " has model ", model_id, ", 0 to 17 expected"));
    math::camera camera{*model, 0, 0, {}};
    camera.width = in.read_number<std::uint64_t>("colmap: camera width");
    camera.height = in.read_number<std::uint64_t>("colmap: camera height");
    for (std::size_t i = 0; i < math::info(*model).n_parameters; ++i)
      camera.parameters.push_back(in.read_number<double>("colmap: camera parameters"));
    add_camera(cameras, id, std::move(camera));
  });
  return cameras;
}

inline std::vector<image> read_images(const std::filesystem::path& path) {
  constexpr std::size_t observation_bytes = 24;
  std::vector<image> images;
  detail::read_records(path, 73, "images", [&](byte_stream& in) {
    image i;
    i.id = in.read_number<std::uint32_t>("colmap: image id");
    i.camera_from_world = detail::read_pose(in);
    i.camera_id = in.read_number<std::uint32_t>("colmap: camera id");
    i.name = in.take_name("colmap: image name");
    const auto n = in.read_count<std::uint64_t>(observation_bytes, "colmap: observations");
    in.skip(n * observation_bytes, "colmap: observations");
    images.push_back(std::move(i));
  });
  return images;
}

inline std::map<std::uint32_t, rig> read_rigs(const std::filesystem::path& path) {
  std::map<std::uint32_t, rig> rigs;
  detail::read_records(path, 8, "rigs", [&](byte_stream& in) {
    rig r;
    const auto id = in.read_number<std::uint32_t>("colmap: rig id");
    const auto n_sensors = in.read_count<std::uint32_t>(8, "colmap: sensors of a rig");
    if (n_sensors > 0) r.reference = detail::read_sensor(in);
    for (std::size_t i = 1; i < n_sensors; ++i) {
      const sensor s = detail::read_sensor(in);
      if (in.read_number<std::uint8_t>("colmap: whether a sensor has a pose") != 0)
        r.sensor_from_rig[s] = detail::read_pose(in);
    }
    add_rig(rigs, id, std::move(r));
  });
  return rigs;
}

inline std::vector<frame> read_frames(const std::filesystem::path& path) {
  std::vector<frame> frames;
  detail::read_records(path, 68, "frames", [&](byte_stream& in) {
    frame f;
    in.read_number<std::uint32_t>("colmap: frame id");
    f.rig_id = in.read_number<std::uint32_t>("colmap: rig id");
    f.rig_from_world = detail::read_pose(in);
    const auto n = in.read_count<std::uint32_t>(16, "colmap: images of a frame");
    for (std::size_t i = 0; i < n; ++i) {
      const sensor s = detail::read_sensor(in);
      f.data.emplace_back(s, in.read_number<std::uint64_t>("colmap: image id"));
    }
    frames.push_back(std::move(f));
  });
  return frames;
}

inline points read_points(const std::filesystem::path& path) {
  constexpr std::size_t track_bytes = 8;
  points p;
  detail::read_records(path, 51, "points", [&](byte_stream& in) {
    in.read_number<std::uint64_t>("colmap: point id");
    p.positions.push_back(detail::read_vector(in, "colmap: point"));
    cloud::color color;
    for (std::uint8_t& channel : color) channel = in.read_number<std::uint8_t>("colmap: color");
    p.colors.push_back(color);
    p.errors_px.push_back(in.read_number<double>("colmap: point error"));
    const auto n = in.read_count<std::uint64_t>(track_bytes, "colmap: track");
    in.skip(n * track_bytes, "colmap: track");
    p.track_lengths.push_back(n);
  });
  return p;
}

inline std::size_t count_points(const std::filesystem::path& path) {
  const input_file file(path);
  return byte_stream(file).read_count<std::uint64_t>(51, "colmap: points");
}

}  // namespace aib::io::colmap::binary
