// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/io/bytes.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

/// OpenEXR's PIZ codec: Haar wavelets of 16-bit words, their values renumbered without gaps, and
/// Huffman codes of up to 58 bits. Every step is checked; a damaged block gives nothing.
/// Source: the reference implementation of OpenEXR (ImfPizCompressor, ImfWav, ImfHuf).
namespace aib::io::detail {

/// Bits of a block, highest of each byte first.
class exr_bits {
 public:
  explicit exr_bits(std::string_view bytes) : bytes_(bytes) {}

  /// The next n bits (n <= 32); nothing beyond the end.
  std::optional<std::uint32_t> take(unsigned n) {
    if (n > left()) return std::nullopt;
    const std::uint32_t value = peek(n);
    at_ += n;
    return value;
  }

  /// The next n bits (n <= 32) without moving on, zeros beyond the end.
  [[nodiscard]] std::uint32_t peek(unsigned n) const {
    std::uint64_t word = 0;
    const std::size_t first = at_ / 8;
    for (std::size_t k = 0; k < 5; ++k) {
      const auto byte =
          first + k < bytes_.size() ? static_cast<unsigned char>(bytes_[first + k]) : 0u;
      word = (word << 8) | byte;
    }
    return static_cast<std::uint32_t>((word >> (40 - at_ % 8 - n)) & ((std::uint64_t{1} << n) - 1));
  }

  void skip(std::size_t n) { at_ += n; }
  void limit(std::size_t bits) { end_ = at_ + bits; }
  void align() { at_ = (at_ + 7) / 8 * 8; }
  [[nodiscard]] std::size_t left() const { return end_ > at_ ? end_ - at_ : 0; }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
  std::size_t end_ = 8 * bytes_.size();
};

/// Canonical Huffman code of 65537 symbols: the 16-bit words and a sign for runs.
class piz_huffman {
 public:
  static constexpr std::size_t n_symbols = 65537;
  static constexpr unsigned max_length = 58;

  /// Reads the lengths of the codes of symbols first..last.
  [[nodiscard]] bool read_lengths(exr_bits& bits, std::size_t first, std::size_t last) {
    constexpr std::uint32_t short_run = 59, long_run = 63;
    lengths_.assign(n_symbols, 0);
    for (std::size_t symbol = first; symbol <= last;) {
      const auto length = bits.take(6);
      if (!length) return false;
      if (*length < short_run) {
        lengths_[symbol++] = static_cast<std::uint8_t>(*length);
        continue;
      }
      std::size_t run = *length - short_run + 2;
      if (*length == long_run) {
        const auto more = bits.take(8);
        if (!more) return false;
        run = *more + 6;
      }
      if (run > last + 1 - symbol) return false;
      symbol += run;
    }
    return make_codes();
  }

  /// Decodes `to.size()` words; `run_symbol` repeats the last word as often as the 8 bits behind it
  /// say.
  [[nodiscard]] bool decode(exr_bits& bits, std::size_t run_symbol, std::span<std::uint16_t> to) {
    std::size_t n = 0;
    while (bits.left() > 0) {
      const auto symbol = next(bits);
      if (!symbol) return false;
      if (*symbol == run_symbol) {
        const auto run = bits.take(8);
        if (!run || n == 0 || *run > to.size() - n) return false;
        std::fill_n(to.begin() + static_cast<std::ptrdiff_t>(n), *run, to[n - 1]);
        n += *run;
      } else {
        if (n == to.size()) return false;
        to[n++] = static_cast<std::uint16_t>(*symbol);
      }
    }
    return n == to.size();
  }

 private:
  static constexpr unsigned table_bits = 14;

  /// Code words of each length follow one another; the longest are the smallest numbers.
  bool make_codes() {
    std::array<std::uint64_t, max_length + 1> count{};
    for (const std::uint8_t length : lengths_) ++count[length];
    count[0] = 0;
    std::uint64_t code = 0;
    for (unsigned length = max_length; length > 0; --length) {
      first_code_[length] = code;
      code = (code + count[length]) >> 1;
    }
    std::size_t offset = 0;
    for (unsigned length = 1; length <= max_length; ++length) {
      first_symbol_[length] = offset;
      offset += count[length];
      n_codes_[length] = count[length];
    }
    symbols_.resize(offset);
    auto place = first_symbol_;
    for (std::size_t symbol = 0; symbol < n_symbols; ++symbol) {
      if (lengths_[symbol] > 0)
        symbols_[place[lengths_[symbol]]++] = static_cast<std::uint32_t>(symbol);
    }
    return fill_table();
  }

  /// Short codes are looked up: every continuation of a code leads to its symbol.
  bool fill_table() {
    table_.assign(std::size_t{1} << table_bits, {});
    for (unsigned length = 1; length <= table_bits; ++length) {
      const unsigned rest = table_bits - length;
      if (first_code_[length] + n_codes_[length] > std::uint64_t{1} << length) return false;
      for (std::uint64_t k = 0; k < n_codes_[length]; ++k) {
        const auto begin = static_cast<std::size_t>((first_code_[length] + k) << rest);
        std::fill_n(table_.begin() + static_cast<std::ptrdiff_t>(begin), std::size_t{1} << rest,
                    entry{symbols_[first_symbol_[length] + k], length});
      }
    }
    return true;
  }

  std::optional<std::uint32_t> next(exr_bits& bits) const {
    const entry& found = table_[bits.peek(table_bits)];
    if (found.length > 0) {
      if (found.length > bits.left()) return std::nullopt;
      bits.skip(found.length);
      return found.symbol;
    }
    std::uint64_t code = 0;
    for (unsigned length = 1; length <= max_length; ++length) {
      const auto bit = bits.take(1);
      if (!bit) return std::nullopt;
      code = (code << 1) | *bit;
      if (code >= first_code_[length] && code - first_code_[length] < n_codes_[length])
        return symbols_[first_symbol_[length] + (code - first_code_[length])];
    }
    return std::nullopt;
  }

  struct entry {
    std::uint32_t symbol = 0;
    unsigned length = 0;
  };
  std::vector<std::uint8_t> lengths_;
  std::array<std::uint64_t, max_length + 1> first_code_{};
  std::array<std::uint64_t, max_length + 1> n_codes_{};
  std::array<std::size_t, max_length + 1> first_symbol_{};
  std::vector<std::uint32_t> symbols_;
  std::vector<entry> table_;
};

/// Undoes one step of the wavelet on a pair: low and high become their two neighbours.
struct piz_pair {
  std::uint16_t a, b;
};

template <bool FourteenBits>
piz_pair unlift(std::uint16_t low, std::uint16_t high) {
  if constexpr (FourteenBits) {
    const int h = static_cast<std::int16_t>(high);
    const int a = static_cast<std::int16_t>(low) + (h & 1) + (h >> 1);
    return {static_cast<std::uint16_t>(a), static_cast<std::uint16_t>(a - h)};
  } else {
    const unsigned b = (low - (high >> 1)) & 0xffffu;
    return {static_cast<std::uint16_t>(high + b - 0x8000u), static_cast<std::uint16_t>(b)};
  }
}

/// Undoes the wavelet of a plane: word (x, y) lies at data[x * step_x + y * step_y].
template <bool FourteenBits>
void unlift_plane(std::uint16_t* data,
                  std::size_t width,
                  std::size_t step_x,
                  std::size_t height,
                  std::size_t step_y) {
  const auto at = [=](std::size_t x, std::size_t y) -> std::uint16_t& {
    return data[x * step_x + y * step_y];
  };
  const auto pair = [](std::uint16_t& low, std::uint16_t& high) {
    const auto [a, b] = unlift<FourteenBits>(low, high);
    low = a;
    high = b;
  };
  std::size_t p = 1;
  while (2 * p <= std::min(width, height)) p *= 2;
  for (std::size_t step = p / 2; step > 0; step /= 2) {
    std::size_t y = 0;
    for (; y + 2 * step <= height; y += 2 * step) {
      std::size_t x = 0;
      for (; x + 2 * step <= width; x += 2 * step) {
        pair(at(x, y), at(x, y + step));
        pair(at(x + step, y), at(x + step, y + step));
        pair(at(x, y), at(x + step, y));
        pair(at(x, y + step), at(x + step, y + step));
      }
      if ((width & step) != 0) pair(at(x, y), at(x, y + step));
    }
    if ((height & step) != 0)
      for (std::size_t x = 0; x + 2 * step <= width; x += 2 * step) pair(at(x, y), at(x + step, y));
  }
}

/// Expands a PIZ block. `words` says for each channel how many 16-bit words a pixel has; `to` gets
/// the lines, channel after channel in each. False where the block is damaged.
inline bool expand_piz(std::string_view from,
                       std::size_t width,
                       std::size_t height,
                       std::span<const std::size_t> words,
                       std::span<std::uint8_t> to) {
  constexpr std::size_t bitmap_bytes = 8192;
  const auto u16 = [&](std::size_t at) { return load<std::uint16_t>(from.data() + at); };
  if (from.size() < 4) return false;
  const std::size_t first = u16(0), last = u16(2);
  from.remove_prefix(4);
  std::array<std::uint8_t, bitmap_bytes> bitmap{};
  if (first <= last) {
    const std::size_t n = last - first + 1;
    if (last >= bitmap_bytes || n > from.size()) return false;
    std::copy_n(from.begin(), n, bitmap.begin() + static_cast<std::ptrdiff_t>(first));
    from.remove_prefix(n);
  }
  std::vector<std::uint16_t> value_of(65536, 0);
  std::size_t n_values = 0;
  for (std::size_t v = 0; v < value_of.size(); ++v) {
    if (v == 0 || (bitmap[v / 8] >> (v % 8) & 1) != 0)
      value_of[n_values++] = static_cast<std::uint16_t>(v);
  }

  const auto u32 = [&](std::size_t at) { return load<std::uint32_t>(from.data() + at); };
  if (from.size() < 4 + 20 || u32(0) < 20 || u32(0) > from.size() - 4) return false;
  from = from.substr(4, u32(0));
  const std::size_t first_symbol = u32(0), last_symbol = u32(4), n_bits = u32(12);
  if (first_symbol >= piz_huffman::n_symbols || last_symbol >= piz_huffman::n_symbols) return false;
  exr_bits bits(from.substr(20));
  piz_huffman huffman;
  if (!huffman.read_lengths(bits, first_symbol, last_symbol)) return false;
  bits.align();
  if (n_bits > bits.left()) return false;
  bits.limit(n_bits);
  std::vector<std::uint16_t> planes(to.size() / 2);
  if (!huffman.decode(bits, last_symbol, planes)) return false;

  std::uint16_t* plane = planes.data();
  std::size_t line_offset = 0;
  std::size_t line_words = 0;
  for (const std::size_t w : words) line_words += w * width;
  for (const std::size_t w : words) {
    for (std::size_t k = 0; k < w; ++k) {
      const auto undo = n_values - 1 < (1u << 14) ? unlift_plane<true> : unlift_plane<false>;
      undo(plane + k, width, w, height, w * width);
    }
    for (std::size_t y = 0; y < height; ++y) {
      std::uint8_t* line = to.data() + 2 * (y * line_words + line_offset);
      for (std::size_t i = 0; i < w * width; ++i) {
        const std::uint16_t value = value_of[plane[y * w * width + i]];
        line[2 * i] = static_cast<std::uint8_t>(value & 0xff);
        line[2 * i + 1] = static_cast<std::uint8_t>(value >> 8);
      }
    }
    plane += w * width * height;
    line_offset += w * width;
  }
  return true;
}

}  // namespace aib::io::detail
