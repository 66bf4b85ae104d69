// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/io/file_kind.hpp>
#include <aib/io/limits.hpp>
#include <aib/raster/color.hpp>
#include <aib/raster/view.hpp>

#include <cstdint>
#include <filesystem>

#if defined(AIB_WITH_PNG)
#include <aib/io/png.hpp>
#endif
#if defined(AIB_WITH_JPEG)
#include <aib/io/jpeg.hpp>
#endif

namespace aib::io {

/// Whether an image file holds one number a pixel (gray, or a palette) and no transparency, so that
/// read_labels reads it. Throws as read_image does.
inline bool is_label_image(const std::filesystem::path& path,
                           [[maybe_unused]] const limits& limits = {}) {
#if defined(AIB_WITH_PNG)
  if (kind_of(path) == file_kind::png) {
    const png_header header = read_png_header(path, limits);
    return header.is_gray && !header.has_alpha;
  }
#endif
  static_cast<void>(path);
  return false;
}

/// Reads a picture, PNG or JPEG, as 8-bit colours. Transparency is dropped.
/// Throws format_error where the file is damaged, larger than the limits, or no picture that this
/// build reads.
inline raster::color_image read_image(const std::filesystem::path& path,
                                      [[maybe_unused]] const limits& limits = {}) {
  switch (kind_of(path)) {
    case file_kind::png:
#if defined(AIB_WITH_PNG)
      return read_png_color(path, limits);
#else
      throw format_error(path, "this build of aib reads no PNG; build it with libspng");
#endif
    case file_kind::jpeg:
#if defined(AIB_WITH_JPEG)
      return read_jpeg(path, limits);
#else
      throw format_error(path, "this build of aib reads no JPEG; build it with libjpeg");
#endif
    default:
      throw format_error(path, "an image expected: PNG or JPEG");
  }
}

/// Reads masks and labels: the stored numbers of a gray PNG of 1 to 16 bits or of a palette.
/// Throws format_error for colours, and where the file is damaged or larger than the limits.
inline raster::label_image read_labels(const std::filesystem::path& path,
                                       [[maybe_unused]] const limits& limits = {}) {
#if defined(AIB_WITH_PNG)
  if (kind_of(path) == file_kind::png) return read_png_gray(path, limits);
#endif
  throw format_error(path, "a gray PNG or one with a palette expected");
}

/// Writes gray (8 or 16 bits), rgb or rgba pixels as PNG. Throws argument_error for another
/// extension or an empty image.
template <class Pixel>
void write_image(const std::filesystem::path& path, raster::view<const Pixel> image) {
#if defined(AIB_WITH_PNG)
  if (extension_of(path) == ".png") return write_png(path, image);
#endif
  static_cast<void>(image);
  throw argument_error(message("io::write_image: the extension .png expected, found \"",
                               path.extension().string(), "\""));
}

}  // namespace aib::io
