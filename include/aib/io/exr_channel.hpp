// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/io/bytes.hpp>
#include <aib/io/exr_block.hpp>
#include <aib/io/exr_header.hpp>
#include <aib/io/file.hpp>
#include <aib/io/half.hpp>
#include <aib/raster/image.hpp>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

namespace aib::io {

/// Reads a channel of a part, all of its data window or some of its lines.
///
/// lines   lines of the data window, ascending, the same may come twice; empty: all of them. Blocks
///         without a wanted line are not read.
///
/// Halves and unsigned integers become float. Returns data.width() x number of lines.
/// Codecs: NONE, RLE, ZIPS, ZIP, PIZ, PXR24, scan lines and tiles (the full resolution of
/// multi-resolution images). Throws format_error for the others and where a block is damaged.
raster::image<float> read_exr_channel(const input_file& file,
                                      const exr_header& header,
                                      std::size_t part,
                                      std::size_t channel,
                                      std::span<const std::size_t> lines = {});

namespace detail {

/// Bytes of a file at any place. Who goes on reading gets more and more ahead; who jumps about, as
/// tiles in any order do, gets what is asked for.
class file_window {
 public:
  explicit file_window(const input_file& file) : file_(file) {}

  /// n bytes at `offset`, valid until the next call.
  std::string_view at(std::uint64_t offset, std::size_t n, std::string_view what) {
    if (offset > file_.size() || n > file_.size() - offset) {
      throw format_error(file_.path(), at_byte{offset},
                         message(what, ": ", n, " bytes expected, the file has ", file_.size()));
    }
    if (offset < begin_ || offset + n > begin_ + bytes_.size()) {
      const bool goes_on = offset >= begin_ && offset <= begin_ + bytes_.size();
      ahead_ = goes_on ? std::min(2 * ahead_, most_ahead) : least_ahead;
      const std::uint64_t wanted = std::max<std::uint64_t>(n, ahead_);
      bytes_.resize(static_cast<std::size_t>(std::min(wanted, file_.size() - offset)));
      file_.read_at(offset, bytes_.data(), bytes_.size());
      begin_ = offset;
    }
    return {bytes_.data() + (offset - begin_), n};
  }

 private:
  static constexpr std::uint64_t least_ahead = 1 << 12, most_ahead = 1 << 18;

  const input_file& file_;
  std::vector<char> bytes_;
  std::uint64_t begin_ = 0;
  std::uint64_t ahead_ = least_ahead;
};

/// Reads one channel block by block.
class exr_channel_reader {
 public:
  exr_channel_reader(const input_file& file,
                     const exr_header& header,
                     std::size_t part,
                     std::size_t channel)
      : file_(file),
        window_(file),
        part_(header.parts[part]),
        type_(part_.channels[channel].type),
        part_number_(header.is_multipart ? static_cast<std::int32_t>(part) : -1) {
    for (std::size_t i = 0; i < channel; ++i)
      channel_offset_ += part_.channels[i].type == exr_pixel::half ? 2u : 4u;
    if (part_.compression > exr_compression::pxr24) {
      throw format_error(file.path(), message("exr: compression ", name(part_.compression),
                                              " is not supported; save the file with ZIP"));
    }
    block_width_ = part_.is_tiled() ? part_.tile_width : part_.data.width();
    block_height_ = part_.is_tiled() ? part_.tile_height : block_lines(part_.compression);
    if (std::min(block_width_, part_.data.width()) * std::min(block_height_, part_.data.height()) >
        max_block_bytes / part_.pixel_bytes())
      throw format_error(file.path(), "exr: the blocks are larger than 512 MB");
  }

  raster::image<float> read(std::span<const std::size_t> lines) {
    const std::size_t width = part_.data.width(), height = part_.data.height();
    place_rows(lines);
    raster::image<float> result(width, lines.empty() ? height : lines.size());
    const std::size_t columns = (width + block_width_ - 1) / block_width_;
    for (std::size_t row = 0; row * block_height_ < height; ++row) {
      const std::size_t first = row * block_height_;
      const std::size_t n = std::min(block_height_, height - first);
      if (!is_wanted(first, n)) continue;
      for (std::size_t column = 0; column < columns; ++column) {
        const std::size_t x = column * block_width_;
        const exr_block_shape shape = shape_of(std::min(block_width_, width - x), n);
        decode(row, column, columns, shape);
        copy(result, x, first, shape);
      }
    }
    repeat_rows(result, lines);
    return result;
  }

 private:
  static constexpr std::size_t max_block_bytes = std::size_t{1} << 29;
  static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

  /// Where line y goes; none where it is not wanted.
  std::size_t row_of(std::size_t y) const { return row_of_.empty() ? y : row_of_[y]; }

  void place_rows(std::span<const std::size_t> lines) {
    if (!lines.empty()) row_of_.assign(part_.data.height(), none);
    for (std::size_t i = lines.size(); i-- > 0;) {
      if (lines[i] >= row_of_.size()) throw argument_error("read_exr_channel: no such line");
      row_of_[lines[i]] = i;
    }
  }

  /// Lines that are wanted more than once were read into the first of their rows.
  static void repeat_rows(raster::image<float>& image, std::span<const std::size_t> lines) {
    for (std::size_t i = 1; i < lines.size(); ++i) {
      if (lines[i] == lines[i - 1]) std::copy_n(&image(0, i - 1), image.width(), &image(0, i));
    }
  }

  bool is_wanted(std::size_t first, std::size_t n) const {
    if (row_of_.empty()) return true;
    return std::any_of(row_of_.begin() + static_cast<std::ptrdiff_t>(first),
                       row_of_.begin() + static_cast<std::ptrdiff_t>(first + n),
                       [](std::size_t row) { return row != none; });
  }

  exr_block_shape shape_of(std::size_t width, std::size_t height) const {
    return {width, height, part_.channels, width * height * part_.pixel_bytes()};
  }

  void decode(std::size_t row,
              std::size_t column,
              std::size_t columns,
              const exr_block_shape& shape) {
    const std::size_t index = row * columns + column;
    const std::string_view table = window_offsets(index);
    const auto offset = load<std::uint64_t>(table.data());
    const std::size_t n_fields = (part_number_ >= 0 ? 1u : 0u) + (part_.is_tiled() ? 5u : 2u);
    const std::string_view fields = window_.at(offset, 4 * n_fields, "exr: block");
    const auto field = [&](std::size_t i) { return load<std::int32_t>(fields.data() + 4 * i); };
    std::size_t at = 0;
    bool right = part_number_ < 0 || field(at++) == part_number_;
    if (part_.is_tiled()) {
      right = right && field(at) == static_cast<std::int32_t>(column) &&
              field(at + 1) == static_cast<std::int32_t>(row) && field(at + 2) == 0 &&
              field(at + 3) == 0;
      at += 4;
    } else {
      const std::int64_t y = part_.data.min_y + static_cast<std::int64_t>(row * block_height_);
      right = right && field(at++) == y;
    }
    if (!right)
      fail(offset, message("exr: block ", index, " is not at its place; the file is not complete"));
    const std::int32_t size = field(at);
    if (size < 0 || static_cast<std::size_t>(size) > shape.bytes)
      fail(offset, message("exr: block ", index, " of ", size, " bytes, at most ", shape.bytes,
                           " expected"));
    const std::string_view block =
        window_.at(offset + 4 * n_fields, static_cast<std::size_t>(size), "exr: block");
    if (!decoder_.decode(part_.compression, block, shape))
      fail(offset, message("exr: block ", index, " is damaged (", name(part_.compression), ")"));
  }

  /// The place of a block; the table of them is read in one piece.
  std::string_view window_offsets(std::size_t index) {
    if (offsets_.empty()) {
      const std::size_t columns = (part_.data.width() + block_width_ - 1) / block_width_;
      const std::size_t rows = (part_.data.height() + block_height_ - 1) / block_height_;
      offsets_.resize(8 * columns * rows);
      file_.read_at(part_.offsets_at, offsets_.data(), offsets_.size());
    }
    return {offsets_.data() + 8 * index, 8};
  }

  /// Copies the wanted lines of the decoded block to their rows.
  void copy(raster::image<float>& to,
            std::size_t x,
            std::size_t first,
            const exr_block_shape& shape) {
    const std::size_t line_bytes = shape.width * part_.pixel_bytes();
    const std::size_t pixel = type_ == exr_pixel::half ? 2 : 4;
    row_bytes_.resize(shape.width * pixel);
    for (std::size_t y = 0; y < shape.height; ++y) {
      const std::size_t row = row_of(first + y);
      if (row == none) continue;
      const std::size_t begin = y * line_bytes + channel_offset_ * shape.width;
      float* const pixels = &to(x, row);
      if (type_ == exr_pixel::float32 && std::endian::native == std::endian::little) {
        decoder_.copy(begin, row_bytes_.size(), reinterpret_cast<std::uint8_t*>(pixels));
      } else {
        decoder_.copy(begin, row_bytes_.size(), row_bytes_.data());
        convert({pixels, shape.width});
      }
    }
  }

  void convert(std::span<float> pixels) const {
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const std::uint8_t* from = row_bytes_.data();
      switch (type_) {
        case exr_pixel::half:
          pixels[i] = float_from_half(load<std::uint16_t>(from + 2 * i));
          break;
        case exr_pixel::uint32:
          pixels[i] = static_cast<float>(load<std::uint32_t>(from + 4 * i));
          break;
        default:
          pixels[i] = load<float>(from + 4 * i);
      }
    }
  }

  [[noreturn]] void fail(std::uint64_t offset, std::string_view what) const {
    throw format_error(file_.path(), at_byte{offset}, what);
  }

  const input_file& file_;
  file_window window_;
  const exr_part& part_;
  exr_pixel type_;
  std::int32_t part_number_;        ///< -1: the file has one part
  std::size_t channel_offset_ = 0;  ///< bytes of the channels before, a pixel
  std::size_t block_width_ = 0, block_height_ = 0;
  std::vector<char> offsets_;
  std::vector<std::size_t> row_of_;  ///< by line; empty: all of them stay where they are
  std::vector<std::uint8_t> row_bytes_;
  exr_block_decoder decoder_;
};

}  // namespace detail

inline raster::image<float> read_exr_channel(const input_file& file,
                                             const exr_header& header,
                                             std::size_t part,
                                             std::size_t channel,
                                             std::span<const std::size_t> lines) {
  return detail::exr_channel_reader(file, header, part, channel).read(lines);
}

}  // namespace aib::io
