// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/io/file.hpp>
#include <aib/io/limits.hpp>
#include <aib/raster/color.hpp>
#include <aib/raster/image.hpp>
#include <aib/raster/view.hpp>

#include <spng.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace aib::io {

/// What the header of a PNG file says.
struct png_header {
  std::size_t width = 0, height = 0;
  int bits = 0;  ///< of a channel
  bool is_gray = false, has_palette = false, has_alpha = false;
};

/// Needs libspng. All PNG functions throw format_error where a file is damaged, is larger than the
/// limits, or has not the pixels that are asked for.
png_header read_png_header(const std::filesystem::path& path, const limits& limits = {});

/// The stored numbers of a gray PNG of 1 to 16 bits, or the indices of a palette: labels, or depth
/// of 16 bits. Refuses colours and transparency.
raster::image<std::uint16_t> read_png_gray(const std::filesystem::path& path,
                                           const limits& limits = {});

/// Any PNG as 8-bit red, green, blue; transparency is dropped.
raster::color_image read_png_color(const std::filesystem::path& path, const limits& limits = {});

/// Any PNG as 8-bit red, green, blue, alpha.
raster::image<std::array<std::uint8_t, 4>> read_png_rgba(const std::filesystem::path& path,
                                                         const limits& limits = {});

/// Any PNG as 16-bit red, green, blue: the stored numbers of a file of 16 bits. Transparency is
/// dropped.
raster::image<std::array<std::uint16_t, 3>> read_png_color16(const std::filesystem::path& path,
                                                             const limits& limits = {});

/// Writes gray, rgb or rgba pixels of 8 or 16 bits, whichever the type is. Throws argument_error
/// for an empty image, io_error where the file cannot be written.
template <class Pixel>
void write_png(const std::filesystem::path& path, raster::view<const Pixel> image);

namespace detail {

struct free_spng {
  void operator()(spng_ctx* context) const { spng_ctx_free(context); }
};

/// An opened PNG file: header checked, pixels not yet read.
class png_decoder {
 public:
  png_decoder(const std::filesystem::path& path, const limits& limits)
      : path_(path), bytes_(read_file(path)), context_(spng_ctx_new(0)) {
    constexpr std::uint32_t max_side = 1u << 20;
    constexpr std::size_t max_chunk = std::size_t{1} << 26;
    if (!context_) fail("no memory");
    check(spng_set_image_limits(context_.get(), max_side, max_side));
    check(spng_set_chunk_limits(context_.get(), max_chunk, max_chunk));
    check(spng_set_png_buffer(context_.get(), bytes_.data(), bytes_.size()));
    check(spng_get_ihdr(context_.get(), &ihdr_));
    demand_pixels(path, "png", ihdr_.width, ihdr_.height, limits);
    // Deflate expands at most 1032 times: more pixels than that were never in the file.
    if (std::uint64_t{ihdr_.width} * ihdr_.height / 8 > 1100 * bytes_.size())
      fail(message(ihdr_.width, "x", ihdr_.height, " pixels in a file of ", bytes_.size(),
                   " bytes"));
  }

  [[nodiscard]] png_header header() const {
    const bool gray = ihdr_.color_type == SPNG_COLOR_TYPE_GRAYSCALE ||
                      ihdr_.color_type == SPNG_COLOR_TYPE_GRAYSCALE_ALPHA;
    const bool alpha = ihdr_.color_type == SPNG_COLOR_TYPE_GRAYSCALE_ALPHA ||
                       ihdr_.color_type == SPNG_COLOR_TYPE_TRUECOLOR_ALPHA;
    return {ihdr_.width,
            ihdr_.height,
            ihdr_.bit_depth,
            gray,
            ihdr_.color_type == SPNG_COLOR_TYPE_INDEXED,
            alpha};
  }

  /// Decodes into n bytes, which must be what the format takes.
  void decode(spng_format format, void* to, std::size_t n) {
    std::size_t needed = 0;
    check(spng_decoded_image_size(context_.get(), format, &needed));
    if (needed != n) fail("an unexpected size");
    check(spng_decode_image(context_.get(), to, n, format, 0));
  }

  [[nodiscard]] std::size_t decoded_size(spng_format format) {
    std::size_t needed = 0;
    check(spng_decoded_image_size(context_.get(), format, &needed));
    return needed;
  }

  [[noreturn]] void fail(std::string_view what) const {
    throw format_error(path_, message("png: ", what));
  }

 private:
  void check(int code) const {
    if (code != 0) fail(spng_strerror(code));
  }

  std::filesystem::path path_;
  std::string bytes_;
  std::unique_ptr<spng_ctx, free_spng> context_;
  spng_ihdr ihdr_ = {};
};

/// Samples of 1, 2, 4, 8 or 16 bits, the first in the highest bits, each row from a whole byte on.
inline raster::image<std::uint16_t> unpack_samples(const std::vector<std::uint8_t>& packed,
                                                   const png_header& header) {
  raster::image<std::uint16_t> image(header.width, header.height);
  const std::size_t bits = static_cast<std::size_t>(header.bits);
  const std::size_t row_bytes = (header.width * bits + 7) / 8;
  for (std::size_t y = 0; y < header.height; ++y) {
    const std::uint8_t* row = packed.data() + y * row_bytes;
    for (std::size_t x = 0; x < header.width; ++x) {
      const std::size_t bit = x * bits;
      image(x, y) =
          static_cast<std::uint16_t>((row[bit / 8] >> (8 - bits - bit % 8)) & ((1u << bits) - 1));
    }
  }
  return image;
}

/// Bits of a channel.
template <class Pixel>
constexpr std::uint8_t png_bits() {
  if constexpr (std::is_integral_v<Pixel>)
    return 8 * sizeof(Pixel);
  else
    return 8 * sizeof(typename Pixel::value_type);
}

template <class Pixel>
constexpr int png_color_type() {
  if constexpr (std::is_integral_v<Pixel>)
    return SPNG_COLOR_TYPE_GRAYSCALE;
  else if constexpr (std::tuple_size_v<Pixel> == 3)
    return SPNG_COLOR_TYPE_TRUECOLOR;
  else
    return SPNG_COLOR_TYPE_TRUECOLOR_ALPHA;
}

}  // namespace detail

inline png_header read_png_header(const std::filesystem::path& path, const limits& limits) {
  return detail::png_decoder(path, limits).header();
}

namespace detail {

/// The stored numbers of an opened file, see read_png_gray.
inline raster::image<std::uint16_t> decode_gray(png_decoder& decoder) {
  const png_header header = decoder.header();
  if (!(header.is_gray || header.has_palette) || header.has_alpha)
    decoder.fail("gray pixels without transparency expected, found colours or transparency");
  if (header.bits == 16) {
    raster::image<std::uint16_t> image(header.width, header.height);
    decoder.decode(SPNG_FMT_PNG, image.data(), 2 * image.size());
    return image;
  }
  std::vector<std::uint8_t> packed(decoder.decoded_size(SPNG_FMT_PNG));
  decoder.decode(SPNG_FMT_PNG, packed.data(), packed.size());
  return unpack_samples(packed, header);
}

}  // namespace detail

inline raster::image<std::uint16_t> read_png_gray(const std::filesystem::path& path,
                                                  const limits& limits) {
  detail::png_decoder decoder(path, limits);
  return detail::decode_gray(decoder);
}

inline raster::color_image read_png_color(const std::filesystem::path& path, const limits& limits) {
  detail::png_decoder decoder(path, limits);
  raster::color_image image(decoder.header().width, decoder.header().height);
  decoder.decode(SPNG_FMT_RGB8, image.data(), 3 * image.size());
  return image;
}

inline raster::image<std::array<std::uint8_t, 4>> read_png_rgba(const std::filesystem::path& path,
                                                                const limits& limits) {
  detail::png_decoder decoder(path, limits);
  raster::image<std::array<std::uint8_t, 4>> image(decoder.header().width, decoder.header().height);
  decoder.decode(SPNG_FMT_RGBA8, image.data(), 4 * image.size());
  return image;
}

inline raster::image<std::array<std::uint16_t, 3>> read_png_color16(
    const std::filesystem::path& path, const limits& limits) {
  detail::png_decoder decoder(path, limits);
  const png_header header = decoder.header();
  std::vector<std::array<std::uint16_t, 4>> pixels(header.width * header.height);
  decoder.decode(SPNG_FMT_RGBA16, pixels.data(), 8 * pixels.size());
  raster::image<std::array<std::uint16_t, 3>> image(header.width, header.height);
  for (std::size_t i = 0; i < pixels.size(); ++i)
    image.data()[i] = {pixels[i][0], pixels[i][1], pixels[i][2]};
  return image;
}

template <class Pixel>
void write_png(const std::filesystem::path& path, raster::view<const Pixel> image) {
  if (image.empty()) throw argument_error("io::write_png: an empty image");
  std::vector<Pixel> pixels;
  pixels.reserve(image.size());
  for (std::size_t y = 0; y < image.height; ++y)
    pixels.insert(pixels.end(), image.row(y).begin(), image.row(y).end());

  const std::unique_ptr<spng_ctx, detail::free_spng> context(spng_ctx_new(SPNG_CTX_ENCODER));
  spng_ihdr ihdr = {};
  ihdr.width = static_cast<std::uint32_t>(image.width);
  ihdr.height = static_cast<std::uint32_t>(image.height);
  ihdr.bit_depth = detail::png_bits<Pixel>();
  ihdr.color_type = static_cast<std::uint8_t>(detail::png_color_type<Pixel>());
  std::size_t n = 0;
  int code = context ? 0 : 1;
  if (code == 0) code = spng_set_option(context.get(), SPNG_ENCODE_TO_BUFFER, 1);
  if (code == 0) code = spng_set_ihdr(context.get(), &ihdr);
  if (code == 0)
    code = spng_encode_image(context.get(), pixels.data(), pixels.size() * sizeof(Pixel),
                             SPNG_FMT_PNG, SPNG_ENCODE_FINALIZE);
  const std::unique_ptr<void, decltype(&std::free)> bytes(
      code == 0 ? spng_get_png_buffer(context.get(), &n, &code) : nullptr, &std::free);
  if (code != 0 || !bytes) throw argument_error(message("io::write_png: ", spng_strerror(code)));
  write_file(path, {static_cast<const char*>(bytes.get()), n});
}

}  // namespace aib::io
