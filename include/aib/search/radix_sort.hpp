// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/executor.hpp>
#include <aib/search/buffer.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace aib::search {

/// Bits [low, high) of a word.
struct bit_range {
  int low;
  int high;
};

namespace detail {

/// One stable counting pass: from `in` to `out` by the digit at `shift`.
inline void scatter_by_digit(const buffer<std::uint64_t>& in,
                             buffer<std::uint64_t>& out,
                             int shift,
                             int width,
                             unsigned threads,
                             const control& control) {
  const std::size_t digits = std::size_t{1} << width;
  const auto digit = [&](std::uint64_t word) { return (word >> shift) & (digits - 1); };
  const std::size_t share = (in.size() + threads - 1) / threads;
  std::vector<std::size_t> place(digits * threads, 0);  // [chunk][digit]
  for_each_chunk(in.size(), share, threads, control, [&](const chunk& c) {
    std::size_t* count = &place[digits * c.index];
    for (std::size_t i = c.begin; i < c.end; ++i) ++count[digit(in[i])];
  });
  std::size_t next = 0;
  for (std::size_t d = 0; d < digits; ++d) {
    for (std::size_t t = 0; t < threads; ++t) {
      next += std::exchange(place[digits * t + d], next);
    }
  }
  for_each_chunk(in.size(), share, threads, control, [&](const chunk& c) {
    std::size_t* to = &place[digits * c.index];
    for (std::size_t i = c.begin; i < c.end; ++i) out[to[digit(in[i])]++] = in[i];
  });
}

}  // namespace detail

/// Sorts words by some of their bits, equal ones in their order. Linear time; one copy of the words
/// beside them. `threads` >= 1.
inline void radix_sort(buffer<std::uint64_t>& words,
                       bit_range bits,
                       unsigned threads,
                       const control& control = {}) {
  const int total = bits.high - bits.low;
  if (total <= 0 || words.size() < 2) return;
  if (words.size() < 20000) threads = 1;
  const int passes = (total + 10) / 11;
  const int width = (total + passes - 1) / passes;
  buffer<std::uint64_t> other(words.size());
  for (int low = bits.low; low < bits.high; low += width) {
    detail::scatter_by_digit(words, other, low, std::min(width, bits.high - low), threads, control);
    std::swap(words, other);
  }
}

}  // namespace aib::search
