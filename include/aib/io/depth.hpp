// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/depth/depth_map.hpp>
#include <aib/io/colmap_depth.hpp>
#include <aib/io/file_kind.hpp>
#include <aib/raster/downsample.hpp>

#if defined(AIB_WITH_EXR)
#include <aib/io/exr.hpp>
#endif

#include <cstddef>
#include <filesystem>
#include <limits>
#include <string>

namespace aib::io {

struct depth_options {
  std::string channel = {};  ///< EXR: name of the channel; empty: chosen, see read_exr
  double scale = 0;          ///< stored value of one unit of length; 0: that of the format
  double max_depth = std::numeric_limits<double>::infinity();  ///< this and beyond becomes 0
  std::size_t width = 0, height = 0;  ///< size of the result by nearest neighbour; 0: the file's
  raster::nearest_rule rule = raster::nearest_rule::centre;
};

namespace detail {

inline depth::depth_map read_depth_as_stored(const std::filesystem::path& path,
                                             const depth_options& options) {
  switch (kind_of(path)) {
    case file_kind::colmap_map:
      return read_colmap_depth(path);
    case file_kind::exr:
#if defined(AIB_WITH_EXR)
      return read_exr(path, {.channel = options.channel,
                             .width = options.width,
                             .height = options.height,
                             .rule = options.rule});
#else
      throw format_error(path, "this build of aib reads no EXR; build it with zlib");
#endif
    default:
      throw format_error(path, "a depth map expected: EXR, COLMAP .bin");
  }
}

}  // namespace detail

/// Reads a depth map; the format is told from the content, then from the extension. Pixels without
/// depth are 0 or not finite.
///
/// Throws format_error where the format is not known or the file is damaged, io_error where it
/// cannot be read, argument_error where an option has no meaning.
inline depth::depth_map read_depth(const std::filesystem::path& path,
                                   const depth_options& options = {}) {
  if (!(options.scale >= 0) || !(options.max_depth > 0))
    throw argument_error("io::read_depth: scale >= 0 and max_depth > 0 expected");
  depth::depth_map result = detail::read_depth_as_stored(path, options);
  if (options.scale > 0) {
    for (float& depth : result.values)
      depth = static_cast<float>(static_cast<double>(depth) / options.scale);
  }
  std::size_t n_far = 0;
  for (float& depth : result.values) {
    if (!(static_cast<double>(depth) >= options.max_depth)) continue;
    depth = 0;
    ++n_far;
  }
  if (n_far > 0)
    result.warnings.push_back(message(n_far, " of ", result.values.size(),
                                      " pixels are at max_depth ", options.max_depth,
                                      " or beyond"));
  const std::size_t width = options.width ? options.width : result.values.width();
  const std::size_t height = options.height ? options.height : result.values.height();
  if (width != result.values.width() || height != result.values.height())
    result.values = raster::resample_nearest<float>(result.values, width, height, options.rule);
  return result;
}

/// Writes a depth map in the format of the extension: .exr (ZIP, float).
/// Throws argument_error for another extension.
inline void write_depth(const std::filesystem::path& path, raster::view<const float> depth) {
#if defined(AIB_WITH_EXR)
  if (extension_of(path) == ".exr") return write_exr(path, depth);
#endif
  throw argument_error(message("io::write_depth: the extension .exr expected, found \"",
                               path.extension().string(), "\""));
}

}  // namespace aib::io
