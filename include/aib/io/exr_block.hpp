// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/io/exr_header.hpp>
#include <aib/io/exr_piz.hpp>
#include <aib/io/exr_predictor.hpp>
#include <aib/io/inflate.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <vector>

namespace aib::io::detail {

/// Pixels of a block: lines of `width` pixels, in each line channel after channel.
struct exr_block_shape {
  std::size_t width;
  std::size_t height;
  std::span<const exr_channel_info> channels;
  std::size_t bytes;  ///< all of it, expanded
};

/// Expands runs: a count c < 0 is followed by -c bytes, a count c >= 0 by one byte that stands
/// c + 1 times. False where the block does not give exactly `to.size()` bytes.
inline bool expand_runs(std::string_view from, std::span<std::uint8_t> to) {
  std::size_t n = 0;
  for (std::size_t i = 0; i < from.size();) {
    const int count = static_cast<signed char>(from[i++]);
    const auto run = static_cast<std::size_t>(count < 0 ? -count : count + 1);
    const std::size_t taken = count < 0 ? run : 1;
    if (run > to.size() - n || taken > from.size() - i) return false;
    if (count < 0) {
      std::memcpy(to.data() + n, from.data() + i, run);
    } else {
      std::memset(to.data() + n, static_cast<unsigned char>(from[i]), run);
    }
    n += run;
    i += taken;
  }
  return n == to.size();
}

/// Expands the planes of a PXR24 block: differences of neighbours, highest byte first; floats have
/// lost their lowest byte.
inline void expand_pxr24(std::span<const std::uint8_t> planes,
                         const exr_block_shape& shape,
                         std::uint8_t* to) {
  const std::uint8_t* from = planes.data();
  for (std::size_t y = 0; y < shape.height; ++y) {
    for (const exr_channel_info& channel : shape.channels) {
      const std::size_t n_bytes = channel.type == exr_pixel::half ? 2 : 4;
      const std::size_t n_planes = channel.type == exr_pixel::float32 ? 3 : n_bytes;
      std::uint32_t value = 0;
      for (std::size_t x = 0; x < shape.width; ++x, to += n_bytes) {
        for (std::size_t k = 0; k < n_planes; ++k)
          value += std::uint32_t{from[k * shape.width + x]} << (8 * (n_bytes - 1 - k));
        for (std::size_t k = 0; k < n_bytes; ++k)
          to[k] = static_cast<std::uint8_t>(value >> (8 * k));
      }
      from += n_planes * shape.width;
    }
  }
}

inline std::size_t pxr24_plane_bytes(const exr_block_shape& shape) {
  std::size_t planes = 0;
  for (const exr_channel_info& c : shape.channels)
    planes += c.type == exr_pixel::half ? 2u : c.type == exr_pixel::float32 ? 3u : 4u;
  return planes * shape.width * shape.height;
}

/// Expands blocks one after another; its memory is used again.
class exr_block_decoder {
 public:
  /// Expands a block, of which `copy` then takes parts. False where it is damaged.
  [[nodiscard]] bool decode(exr_compression compression,
                            std::string_view block,
                            const exr_block_shape& shape) {
    raw_ = reinterpret_cast<const std::uint8_t*>(block.data());
    // A block that the codec could not make smaller is stored as it is.
    if (block.size() == shape.bytes) return true;
    if (block.size() > shape.bytes || compression == exr_compression::none ||
        shape.bytes / exr_best_ratio > block.size())
      return false;
    raw_ = nullptr;
    bytes_.resize(shape.bytes);
    switch (compression) {
      case exr_compression::rle:
        return expand_runs(block, bytes_) && sum();
      case exr_compression::zips:
      case exr_compression::zip:
        return expand(block, bytes_) && sum();
      case exr_compression::pxr24:
        return decode_pxr24(block, shape);
      default:
        return decode_piz(block, shape);
    }
  }

  /// Copies n bytes of the block that was decoded last; `begin` and n are even.
  void copy(std::size_t begin, std::size_t n, std::uint8_t* to) const {
    if (raw_) {
      std::memcpy(to, raw_ + begin, n);
    } else {
      const std::uint8_t* even = bytes_.data() + begin / 2;
      interleave(even, even + bytes_.size() / 2, to, n);
    }
  }

 private:
  bool expand(std::string_view block, std::span<std::uint8_t> to) {
    return inflater_.expand(block.data(), block.size(), to.data(), to.size());
  }

  bool sum() {
    sum_differences(bytes_.data(), bytes_.size());
    return true;
  }

  bool decode_pxr24(std::string_view block, const exr_block_shape& shape) {
    planes_.resize(pxr24_plane_bytes(shape));
    raw_ = bytes_.data();
    if (!expand(block, planes_)) return false;
    expand_pxr24(planes_, shape, bytes_.data());
    return true;
  }

  bool decode_piz(std::string_view block, const exr_block_shape& shape) {
    std::vector<std::size_t> words;
    for (const exr_channel_info& c : shape.channels)
      words.push_back(c.type == exr_pixel::half ? 1 : 2);
    raw_ = bytes_.data();
    return expand_piz(block, shape.width, shape.height, words, bytes_);
  }

  inflater inflater_;
  std::vector<std::uint8_t> bytes_;
  std::vector<std::uint8_t> planes_;
  const std::uint8_t* raw_ = nullptr;  ///< the expanded block; null: bytes_ holds two halves
};

}  // namespace aib::io::detail
