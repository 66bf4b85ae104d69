// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/io/colmap.hpp>
#include <aib/io/file.hpp>
#include <aib/io/file_kind.hpp>
#include <aib/io/number_lines.hpp>
#include <aib/io/text.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace aib::io {

/// Formats of camera poses.
enum class pose_format {
  tum,
  kitti,
  euroc,
  log,  ///< Tanks and Temples
  da3,  ///< Depth Anything 3's streaming: 4 x 4 matrices, one a line
  colmap,
  transforms,
  opensfm,
  metashape,
  reality_capture,
  npy,
  npz,
};

/// A format and the name by which options call it.
struct pose_format_name {
  pose_format format;
  std::string_view name;
};

inline constexpr std::array<pose_format_name, 12> pose_format_names{{
    {pose_format::tum, "tum"},
    {pose_format::kitti, "kitti"},
    {pose_format::euroc, "euroc"},
    {pose_format::log, "log"},
    {pose_format::da3, "da3"},
    {pose_format::colmap, "colmap"},
    {pose_format::transforms, "transforms"},
    {pose_format::opensfm, "opensfm"},
    {pose_format::metashape, "metashape"},
    {pose_format::reality_capture, "reality_capture"},
    {pose_format::npy, "npy"},
    {pose_format::npz, "npz"},
}};

[[nodiscard]] constexpr std::string_view name(pose_format format) {
  return pose_format_names[static_cast<std::size_t>(format)].name;
}

/// The format of a file or folder: from its content, then from its extension.
/// Throws io_error where there is nothing at `path`, format_error where the format cannot be told.
[[nodiscard]] pose_format detect_pose_format(const std::filesystem::path& path);

namespace detail {

/// The folder with an NPZ file for each image: `folder` or its folder `camera`; empty where there
/// is none.
inline std::filesystem::path folder_of_npz(const std::filesystem::path& folder) {
  for (const std::filesystem::path& candidate : {folder, folder / "camera"}) {
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator(candidate, ignored)) {
      if (entry.path().extension() == ".npz") return candidate;
    }
  }
  return {};
}

inline std::optional<pose_format> format_of_folder(const std::filesystem::path& folder) {
  if (!find_colmap_models(folder).empty()) return pose_format::colmap;
  if (is_there(folder / "camera_poses.txt")) return pose_format::da3;
  if (is_there(folder / "transforms.json")) return pose_format::transforms;
  if (is_there(folder / "reconstruction.json")) return pose_format::opensfm;
  if (!folder_of_npz(folder).empty()) return pose_format::npz;
  return std::nullopt;
}

/// Whether the path names a file of a COLMAP model.
inline bool is_colmap_file(const std::filesystem::path& path) {
  constexpr std::array<std::string_view, 5> stems{"cameras", "images", "points3D", "rigs",
                                                  "frames"};
  const bool known = std::find(stems.begin(), stems.end(), path.stem().string()) != stems.end();
  return known && (path.extension() == ".bin" || path.extension() == ".txt") &&
         !find_colmap_models(path.parent_path()).empty();
}

inline bool is_number(std::string_view field) { return parse<double>(field).has_value(); }

/// The format of the first two rows of a text.
inline std::optional<pose_format> format_of_rows(const std::vector<std::string_view>& first,
                                                 const std::vector<std::string_view>& second) {
  constexpr double least_ns = 1e14;  // a day in nanoseconds; in seconds it is beyond any clock
  if (first.empty() || !std::all_of(first.begin(), first.end(), is_number)) return std::nullopt;
  const std::size_t n = first.size();
  if (n == 3 && second.size() == 4) return pose_format::log;
  if (n >= 8 && *parse<double>(first.front()) >= least_ns) return pose_format::euroc;
  if (n == 8) return pose_format::tum;
  if (n == 12) return pose_format::kitti;
  if (n == 16) return pose_format::da3;
  return std::nullopt;
}

inline std::optional<pose_format> format_of_text(std::string_view text,
                                                 const std::filesystem::path& path) {
  line_reader raw(text, path);
  if (raw.next() && trim(raw.line()).starts_with("#name")) return pose_format::reality_capture;
  if (raw.line().starts_with("#timestamp [ns]")) return pose_format::euroc;
  line_reader lines(text, path);
  std::vector<std::string_view> first;
  std::vector<std::string_view> second;
  if (lines.next_content()) split_loosely(lines.line(), first);
  if (lines.next_content()) split_loosely(lines.line(), second);
  return format_of_rows(first, second);
}

/// The beginning of the first line with content, for a message.
inline std::string_view first_words(std::string_view text, const std::filesystem::path& path) {
  constexpr std::size_t enough = 60;
  line_reader lines(text, path);
  return lines.next_content() ? lines.line().substr(0, enough) : std::string_view();
}

inline std::optional<pose_format> format_of_content(std::string_view text,
                                                    const std::filesystem::path& path) {
  if (text.starts_with("\x93NUMPY")) return pose_format::npy;
  if (text.starts_with("PK\x03\x04")) return pose_format::npz;
  std::string_view content = text;
  if (content.starts_with("\xEF\xBB\xBF")) content.remove_prefix(3);
  content = trim(content);
  if (content.starts_with('{')) return pose_format::transforms;
  if (content.starts_with('[')) return pose_format::opensfm;
  if (content.starts_with('<')) return pose_format::metashape;
  return format_of_text(text, path);
}

inline std::optional<pose_format> format_of_extension(const std::filesystem::path& path) {
  constexpr std::array<std::pair<std::string_view, pose_format>, 6> extensions{
      {{".tum", pose_format::tum},
       {".kitti", pose_format::kitti},
       {".log", pose_format::log},
       {".npy", pose_format::npy},
       {".npz", pose_format::npz},
       {".xml", pose_format::metashape}}};
  for (const auto& [extension, format] : extensions) {
    if (extension_of(path) == extension) return format;
  }
  return std::nullopt;
}

}  // namespace detail

inline pose_format detect_pose_format(const std::filesystem::path& path) {
  if (is_folder(path)) {
    if (const auto format = detail::format_of_folder(path)) return *format;
    throw format_error(path,
                       "a COLMAP model (cameras, images), camera_poses.txt, transforms.json, "
                       "reconstruction.json or NPZ files expected in the folder, found none");
  }
  if (detail::is_colmap_file(path)) return pose_format::colmap;
  const std::string begin = input_file(path).begin(1 << 16);
  if (const auto format = detail::format_of_content(begin, path)) return *format;
  if (const auto format = detail::format_of_extension(path)) return *format;
  std::string names;
  for (const auto& known : pose_format_names)
    names += message(names.empty() ? "" : ", ", known.name);
  throw format_error(path,
                     message("the format of the poses cannot be told from '",
                             detail::first_words(begin, path), "'; give one as format: ", names));
}

}  // namespace aib::io
