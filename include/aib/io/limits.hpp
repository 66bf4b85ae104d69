// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string_view>

namespace aib::io {

/// How much a file may hold: for readers of files that strangers give. What is packed (EXR, PNG,
/// JPEG, NPZ, PCD, GLB) is refused before memory is asked for; of other formats, which need as much
/// memory as the file has bytes, what was read is counted.
struct limits {
  std::uint64_t max_pixels = std::uint64_t{1} << 27;  ///< of a picture or a depth map
  /// Points of a cloud; vertices, and triangles, of a mesh.
  std::uint64_t max_points = std::numeric_limits<std::uint64_t>::max();
  /// An array of an NPZ file that inflates to more than `max_ratio` times its stored size, and a
  /// GLB file whose nodes repeat its meshes to that much, is refused where it needs more than
  /// `max_bytes`: arrays hardly compress so well, bombs do. Of an EXR file it is how much larger
  /// than its data the display window may be, from 16 million pixels on.
  double max_ratio = 100;
  std::uint64_t max_bytes = std::uint64_t{1} << 30;
};

/// Throws format_error where an image is larger than the limit.
inline void demand_pixels(const std::filesystem::path& path,
                          std::string_view format,
                          std::uint64_t width,
                          std::uint64_t height,
                          const limits& limits) {
  if (width == 0 || height <= limits.max_pixels / width) return;
  throw format_error(path, message(format, ": ", width, "x", height, " pixels, at most ",
                                   limits.max_pixels, " are allowed (max_pixels)"));
}

/// Throws format_error where there are more than the limit. what   "points", "triangles"
inline void demand_points(const std::filesystem::path& path,
                          std::string_view what,
                          std::uint64_t n,
                          const limits& limits) {
  if (n <= limits.max_points) return;
  throw format_error(
      path, message(n, " ", what, ", at most ", limits.max_points, " are allowed (max_points)"));
}

}  // namespace aib::io
