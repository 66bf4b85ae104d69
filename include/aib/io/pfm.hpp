// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/depth/depth_map.hpp>
#include <aib/io/bytes.hpp>
#include <aib/io/file.hpp>
#include <aib/io/float_pixels.hpp>
#include <aib/io/text.hpp>
#include <aib/raster/image.hpp>
#include <aib/raster/view.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace aib::io {

/// Reads a gray PFM: "Pf", width, height, scale, then floats row by row from the bottom. A negative
/// scale means little endian; its size is ignored as everybody does, with a warning where it is
/// not 1. Bytes after the pixels are ignored.
///
/// Throws format_error where the file is damaged or has colours ("PF").
/// Source: Debevec, "PFM Portable FloatMap Image Format".
depth::depth_map read_pfm(const std::filesystem::path& path);

/// Writes a gray PFM in the machine's byte order, scale 1.
void write_pfm(const std::filesystem::path& path, raster::view<const float> depth);

namespace detail {

/// The four words of the header; one blank parts the last from the pixels.
class pfm_header {
 public:
  explicit pfm_header(const input_file& file) : path_(file.path()), text_(file.begin(256)) {
    const std::string_view tag = word("the tag Pf");
    if (tag == "PF") fail("a gray map (Pf) expected, found colours (PF)");
    if (tag != "Pf") fail("the tag Pf expected at the begin");
    width = number<std::size_t>("the width");
    height = number<std::size_t>("the height");
    const auto scale = number<double>("the scale");
    if (!std::isfinite(scale) || scale == 0) fail("a scale other than 0 expected");
    order = scale < 0 ? std::endian::little : std::endian::big;
    factor = std::abs(scale);
  }

  std::size_t width = 0, height = 0;
  std::endian order = std::endian::little;
  double factor = 1;
  [[nodiscard]] std::size_t end() const { return at_; }

 private:
  std::string_view word(std::string_view what) {
    constexpr std::string_view blank = " \t\r\n";
    const std::size_t begin = text_.find_first_not_of(blank, at_);
    const std::size_t end = begin == std::string::npos ? begin : text_.find_first_of(blank, begin);
    if (end == std::string::npos) fail(message(what, " expected, the header ends"));
    at_ = end + 1;
    return std::string_view(text_).substr(begin, end - begin);
  }

  template <class Number>
  Number number(std::string_view what) {
    const std::string_view found = word(what);
    const auto value = parse<Number>(found);
    if (!value) fail(message(what, " expected, found \"", found, "\""));
    return *value;
  }

  [[noreturn]] void fail(std::string_view what) const {
    throw format_error(path_, message("pfm: ", what));
  }

  std::filesystem::path path_;
  std::string text_;
  std::size_t at_ = 0;
};

}  // namespace detail

inline depth::depth_map read_pfm(const std::filesystem::path& path) {
  const input_file file(path);
  const detail::pfm_header header(file);
  depth::depth_map result{
      read_float_pixels(file, header.end(), header.width, header.height, header.order)};
  raster::image<float>& image = result.values;
  for (std::size_t y = 0; y < image.height() / 2; ++y)
    std::swap_ranges(&image(0, y), &image(0, y) + image.width(), &image(0, image.height() - 1 - y));
  if (header.factor != 1)
    result.warnings.push_back(message("the scale ", header.factor, " in the header was ignored"));
  return result;
}

inline void write_pfm(const std::filesystem::path& path, raster::view<const float> depth) {
  std::string bytes = message("Pf\n", depth.width, " ", depth.height, "\n-1.0\n");
  for (std::size_t y = depth.height; y-- > 0;)
    for (const float value : depth.row(y)) store(bytes, value);
  write_file(path, bytes);
}

}  // namespace aib::io
