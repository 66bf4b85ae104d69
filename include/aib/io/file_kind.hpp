// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/io/file.hpp>
#include <aib/io/text.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

namespace aib::io {

/// Formats of clouds, meshes, depth maps and images that aib knows of; not all of them are read.
enum class file_kind {
  unknown,
  colmap_map,  ///< COLMAP's stereo/depth_maps/*.bin
  dmap,        ///< OpenMVS depth map
  e57,
  exr,
  glb,
  gltf,
  jpeg,
  las,  ///< LAS or LAZ
  npy,
  npz,
  obj,
  pcd,
  pfm,
  ply,
  png,
  stl,
  text_points,  ///< XYZ, CSV, PTS
};

/// The extension in lower case, with its dot.
[[nodiscard]] inline std::string extension_of(const std::filesystem::path& path) {
  return lower_case(path.extension().string());
}

namespace detail {

/// "480&270&1&": what COLMAP writes before its dense maps.
inline bool is_colmap_map(std::string_view begin) {
  std::size_t n_fields = 0;
  bool digits = false;
  for (const char c : begin) {
    if (c >= '0' && c <= '9') {
      digits = true;
    } else if (c == '&' && digits) {
      digits = false;
      if (++n_fields == 3) return true;
    } else {
      return false;
    }
  }
  return false;
}

/// A binary STL says in its bytes 80 to 83 how many triangles of 50 bytes follow. Text before them
/// may begin with "solid" all the same, so that only the size tells.
inline bool is_binary_stl(std::string_view begin, std::uint64_t file_size) {
  if (begin.size() < 84) return false;
  std::uint64_t n = 0;
  for (std::size_t i = 4; i-- > 0;) n = (n << 8) | static_cast<unsigned char>(begin[80 + i]);
  return file_size == 84 + 50 * n;
}

inline file_kind kind_of_content(std::string_view begin) {
  using namespace std::string_view_literals;
  constexpr std::array<std::pair<std::string_view, file_kind>, 18> magics{{
      {"ply\n"sv, file_kind::ply},
      {"ply\r"sv, file_kind::ply},
      {"\x76\x2f\x31\x01"sv, file_kind::exr},
      {"\x89PNG\r\n\x1a\n"sv, file_kind::png},
      {"\xff\xd8\xff"sv, file_kind::jpeg},
      {"\x93NUMPY"sv, file_kind::npy},
      {"PK\x03\x04"sv, file_kind::npz},
      {"PK\x05\x06"sv, file_kind::npz},
      {"Pf\n"sv, file_kind::pfm},
      {"Pf\r"sv, file_kind::pfm},
      {"Pf "sv, file_kind::pfm},
      {"PF\n"sv, file_kind::pfm},
      {"glTF"sv, file_kind::glb},
      {"LASF"sv, file_kind::las},
      {"ASTM-E57"sv, file_kind::e57},
      {"# .PCD"sv, file_kind::pcd},
      {"VERSION "sv, file_kind::pcd},
      {"solid"sv, file_kind::stl},
  }};
  for (const auto& [magic, kind] : magics) {
    if (begin.starts_with(magic)) return kind;
  }
  return is_colmap_map(begin) ? file_kind::colmap_map : file_kind::unknown;
}

inline file_kind kind_of_extension(std::string_view extension) {
  constexpr std::array<std::pair<std::string_view, file_kind>, 21> extensions{{
      {".asc", file_kind::text_points},
      {".csv", file_kind::text_points},
      {".dmap", file_kind::dmap},
      {".e57", file_kind::e57},
      {".exr", file_kind::exr},
      {".glb", file_kind::glb},
      {".gltf", file_kind::gltf},
      {".las", file_kind::las},
      {".laz", file_kind::las},
      {".npy", file_kind::npy},
      {".npz", file_kind::npz},
      {".obj", file_kind::obj},
      {".pcd", file_kind::pcd},
      {".pfm", file_kind::pfm},
      {".ply", file_kind::ply},
      {".png", file_kind::png},
      {".pts", file_kind::text_points},
      {".stl", file_kind::stl},
      {".txt", file_kind::text_points},
      {".xyz", file_kind::text_points},
      {".xyzrgb", file_kind::text_points},
  }};
  for (const auto& [known, kind] : extensions) {
    if (known == extension) return kind;
  }
  return file_kind::unknown;
}

}  // namespace detail

/// The format of a file: told from its first bytes, else from its extension.
/// Throws io_error where the file cannot be read.
[[nodiscard]] inline file_kind kind_of(const std::filesystem::path& path) {
  const input_file file(path);
  const std::string begin = file.begin(128);
  if (detail::is_binary_stl(begin, file.size())) return file_kind::stl;
  const file_kind kind = detail::kind_of_content(begin);
  return kind != file_kind::unknown ? kind : detail::kind_of_extension(extension_of(path));
}

}  // namespace aib::io
