// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/depth/depth_map.hpp>
#include <aib/io/bytes.hpp>
#include <aib/io/file.hpp>
#include <aib/io/half.hpp>
#include <aib/raster/image.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace aib::io {

/// Reads the depth of an OpenMVS .dmap file: planar, 0 where there is none. Both layouts, "DR"
/// (float) and "D2" (half times a power of two); normals, confidences and views are passed over.
///
/// Throws format_error where the file is damaged or holds no depth.
/// Source: OpenMVS, libs/MVS/Interface.h.
depth::depth_map read_dmap(const std::filesystem::path& path);

namespace detail {

struct dmap_header {
  bool is_half = false;
  int exponent = 0;  ///< halves are depth / 2^exponent
  std::size_t width = 0, height = 0;
};

inline dmap_header read_dmap_header(byte_reader& in) {
  dmap_header header;
  const std::string_view tag = in.take(2, "dmap: tag");
  if (tag != "DR" && tag != "D2") in.fail("dmap: the tag DR or D2 expected at the begin");
  header.is_half = tag == "D2";
  constexpr std::uint8_t has_depth = 1;
  if ((in.read<std::uint8_t>("dmap: type") & has_depth) == 0) in.fail("dmap: no depth in the file");
  const auto exponent = in.read<std::int8_t>("dmap: exponent");
  if (header.is_half) header.exponent = exponent;
  in.take(8, "dmap: size of the image");
  header.width = in.read<std::uint32_t>("dmap: width");
  header.height = in.read<std::uint32_t>("dmap: height");
  in.take(header.is_half ? 12 : 8, "dmap: range");
  in.take(in.read<std::uint16_t>("dmap: length of the name"), "dmap: name");
  in.take(4 * in.read_count<std::uint32_t>(4, "dmap: number of views"), "dmap: views");
  in.take(8 * (9 + 9 + 3), "dmap: camera");
  return header;
}

}  // namespace detail

inline depth::depth_map read_dmap(const std::filesystem::path& path) {
  const std::string bytes = read_file(path);
  byte_reader in(bytes, path);
  const auto header = detail::read_dmap_header(in);
  const std::size_t pixel = header.is_half ? 2 : 4;
  if (header.width == 0 || header.height == 0 || header.width > in.left() / pixel / header.height) {
    in.fail(message("dmap: ", header.width, "x", header.height, " depths expected, ",
                    in.left() / pixel, " in the file"));
  }
  depth::depth_map result{raster::image<float>(header.width, header.height)};
  const char* from = in.take(pixel * result.values.size(), "dmap: depth").data();
  for (float& depth : result.values) {
    depth = header.is_half ? std::ldexp(float_from_half(load<std::uint16_t>(from)), header.exponent)
                           : load<float>(from);
    from += pixel;
  }
  return result;
}

}  // namespace aib::io
