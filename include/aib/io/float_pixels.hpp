// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/io/bytes.hpp>
#include <aib/io/file.hpp>
#include <aib/raster/image.hpp>

#include <bit>
#include <cstddef>
#include <cstdint>

namespace aib::io {

/// Reads width x height floats that lie in a file row by row, without compression.
/// Throws format_error where the image is empty or the file does not hold it.
[[nodiscard]] inline raster::image<float> read_float_pixels(const input_file& file,
                                                            std::uint64_t offset,
                                                            std::size_t width,
                                                            std::size_t height,
                                                            std::endian order) {
  const std::uint64_t available = offset < file.size() ? (file.size() - offset) / sizeof(float) : 0;
  if (width == 0 || height == 0 || width > available / height) {
    throw format_error(file.path(),
                       message(width, "x", height, " floats expected, the file has ", available));
  }
  raster::image<float> image(width, height);
  file.read_at(offset, image.data(), image.size() * sizeof(float));
  if (order != std::endian::native)
    for (float& value : image) value = load<float>(&value, order);
  return image;
}

}  // namespace aib::io
