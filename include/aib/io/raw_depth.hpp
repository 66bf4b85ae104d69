// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/depth/depth_map.hpp>
#include <aib/io/file.hpp>
#include <aib/io/float_pixels.hpp>

#include <bit>
#include <cstddef>
#include <filesystem>

namespace aib::io {

/// Reads depth that has no header: little-endian floats row by row from the top, as ETH3D has them
/// (its files end in .JPG all the same, infinite where there is no depth). The size is that of the
/// camera. Throws format_error where the file is not exactly that large.
inline depth::depth_map read_raw_depth(const std::filesystem::path& path,
                                       std::size_t width,
                                       std::size_t height) {
  const input_file file(path);
  depth::depth_map result{read_float_pixels(file, 0, width, height, std::endian::little)};
  if (file.size() != result.values.size() * sizeof(float)) {
    throw format_error(
        path, message(width, "x", height, " floats are ", result.values.size() * sizeof(float),
                      " bytes, the file has ", file.size()));
  }
  return result;
}

}  // namespace aib::io
