// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/cloud.hpp>
#include <aib/core/error.hpp>
#include <aib/io/byte_stream.hpp>
#include <aib/io/bytes.hpp>
#include <aib/io/file.hpp>
#include <aib/io/positions.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace aib::io {

/// Reads a LAS file, versions 1.0 to 1.4, point formats 0 to 10: positions, colours, and the
/// classification as label. Colours of 16 bits become 8; files that store 0..255 in them are told
/// from their largest value.
///
/// Throws format_error where the file is damaged, and for LAZ, which is compressed.
/// Source: ASPRS, "LAS Specification 1.4 - R15".
cloud::cloud read_las(const std::filesystem::path& path);

namespace detail {

struct las_header {
  std::uint64_t n_points = 0;
  std::uint64_t points_at = 0;
  std::size_t format = 0;
  std::size_t record_bytes = 0;
  Eigen::Vector3d scale, offset;
};

/// Bytes of a record, and where its colour lies (0: none), by point format.
inline constexpr std::array<std::size_t, 11> las_record_bytes{20, 28, 26, 34, 57, 63,
                                                              30, 36, 38, 59, 67};
inline constexpr std::array<std::size_t, 11> las_color_at{0, 0, 20, 28, 0, 28, 0, 30, 30, 0, 30};

inline las_header read_las_header(const input_file& file) {
  constexpr std::size_t smallest = 227;
  const auto refuse = [&](std::string_view what) {
    throw format_error(file.path(), message("las: ", what));
  };
  if (file.size() < smallest) refuse("the file ends within the header");
  const std::string bytes = file.begin(375);
  const auto u8 = [&](std::size_t at) { return std::size_t{load<std::uint8_t>(&bytes[at])}; };
  if (!bytes.starts_with("LASF") || u8(24) != 1) refuse("not a LAS file of version 1");
  las_header header;
  header.points_at = load<std::uint32_t>(&bytes[96]);
  if (u8(104) >= 64)
    refuse(
        "LAZ is compressed; convert it with `laszip -i in.laz -o out.las` or "
        "`pdal translate in.laz out.las`");
  header.format = u8(104);
  header.record_bytes = load<std::uint16_t>(&bytes[105]);
  const std::uint64_t old_count = load<std::uint32_t>(&bytes[107]);
  header.n_points =
      u8(25) >= 4 && bytes.size() >= 255 ? load<std::uint64_t>(&bytes[247]) : old_count;
  if (old_count != 0 && old_count != header.n_points)
    refuse(message("one number of points expected, found ", old_count, " and ", header.n_points));
  for (int k = 0; k < 3; ++k) {
    const auto axis = static_cast<std::size_t>(k);
    header.scale[k] = load<double>(&bytes[131 + 8 * axis]);
    header.offset[k] = load<double>(&bytes[155 + 8 * axis]);
  }
  if (header.format > 10) refuse(message("point format 0 to 10 expected, found ", header.format));
  if (header.record_bytes < las_record_bytes[header.format])
    refuse(message("records of ", las_record_bytes[header.format], " bytes expected, found ",
                   header.record_bytes));
  if (!header.scale.allFinite() || !header.offset.allFinite() || !(header.scale.array() != 0).all())
    refuse("scale or offset is not finite, or a scale is 0");
  if (header.points_at > file.size() ||
      header.n_points > (file.size() - header.points_at) / header.record_bytes)
    refuse(message(header.n_points, " records of ", header.record_bytes, " bytes from byte ",
                   header.points_at, " expected, the file has ", file.size(), " bytes"));
  return header;
}

}  // namespace detail

inline cloud::cloud read_las(const std::filesystem::path& path) {
  const input_file file(path);
  const auto header = detail::read_las_header(file);
  const auto n = static_cast<std::size_t>(header.n_points);
  const std::size_t color_at = detail::las_color_at[header.format];
  std::vector<Eigen::Vector3d> positions(n);
  std::vector<std::array<std::uint16_t, 3>> colors(color_at > 0 ? n : 0);
  cloud::cloud result;
  result.labels.resize(n);
  std::uint16_t brightest = 0;
  byte_stream in(file, header.points_at);
  for (std::size_t i = 0; i < n; ++i) {
    const char* record = in.take(header.record_bytes, "las: record");
    for (int k = 0; k < 3; ++k)
      positions[i][k] = load<std::int32_t>(record + 4 * k) * header.scale[k] + header.offset[k];
    const bool is_old = header.format < 6;
    const auto classification = load<std::uint8_t>(record + (is_old ? 15 : 16));
    result.labels[i] = is_old ? classification & 31u : classification;
    for (std::size_t k = 0; k < 3 && color_at > 0; ++k) {
      colors[i][k] = load<std::uint16_t>(record + color_at + 2 * k);
      brightest = std::max(brightest, colors[i][k]);
    }
  }
  const unsigned unit = brightest > 255 ? 257 : 1;
  for (const auto& c : colors)
    result.colors.push_back({static_cast<std::uint8_t>(c[0] / unit),
                             static_cast<std::uint8_t>(c[1] / unit),
                             static_cast<std::uint8_t>(c[2] / unit)});
  set_positions(result, to_floats(positions));
  return result;
}

}  // namespace aib::io
