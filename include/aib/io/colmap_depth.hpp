// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/depth/depth_map.hpp>
#include <aib/io/file.hpp>
#include <aib/io/float_pixels.hpp>
#include <aib/io/text.hpp>
#include <aib/raster/image.hpp>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace aib::io {

/// Reads a dense map of COLMAP, stereo/depth_maps/NAME.{geometric,photometric}.bin: the text
/// `W&H&C&`, then floats, little endian, row by row from the top. Planar depth, 0 or negative where
/// there is none.
///
/// Throws format_error where the file is damaged or has not one channel (normal maps have three).
/// Source: COLMAP, mvs/mat.h.
inline depth::depth_map read_colmap_depth(const std::filesystem::path& path) {
  const input_file file(path);
  const std::string begin = file.begin(64);
  std::array<std::size_t, 3> size{};
  std::size_t at = 0;
  for (std::size_t& n : size) {
    const std::size_t end = begin.find('&', at);
    const auto number = parse<std::size_t>(std::string_view(begin).substr(at, end - at));
    if (end == std::string::npos || !number)
      throw format_error(path, "colmap map: \"WIDTH&HEIGHT&CHANNELS&\" expected at the begin");
    n = *number;
    at = end + 1;
  }
  if (size[2] != 1)
    throw format_error(path, message("colmap map: 1 channel expected, found ", size[2]));
  return {read_float_pixels(file, at, size[0], size[1], std::endian::little)};
}

}  // namespace aib::io
