// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/simd_integers.hpp>

#include <array>
#include <cstddef>
#include <cstdint>

namespace aib::search {
inline namespace AIB_ISA {

namespace detail {

/// All bits set where bit `bit` of a lane is.
inline u32x8 spread_bit(u32x8 a, int bit) {
  return u32x8::broadcast(0) - ((a >> bit) & u32x8::broadcast(1));
}

/// All bits under bit `bit`.
inline u32x8 below(int bit) { return u32x8::broadcast((std::uint32_t{1} << bit) - 1); }

/// One level of the curve undone on one axis: the lower bits of x are turned over where the axis is
/// in its upper half, and change places with those of the axis where it is not.
inline void undo_level(u32x8& x, u32x8& axis, int bit) {
  const u32x8 flip = spread_bit(axis, bit) & below(bit);
  const u32x8 swap = (x ^ axis) & (flip ^ below(bit));
  x = x ^ (flip | swap);
  axis = axis ^ swap;
}

/// The low 10 bits of a, two zeros between each.
inline u32x8 spread(u32x8 a) {
  const auto mask = [](std::uint32_t bits) { return u32x8::broadcast(bits); };
  a = a & mask(0x3ff);
  a = (a | a << 16) & mask(0x030000ff);
  a = (a | a << 8) & mask(0x0300f00f);
  a = (a | a << 4) & mask(0x030c30c3);
  return (a | a << 2) & mask(0x09249249);
}

/// The low 10 bits of x, y and z in turn.
inline u32x8 interleave(u32x8 x, u32x8 y, u32x8 z) {
  return spread(x) << 2 | spread(y) << 1 | spread(z);
}

}  // namespace detail

/// Places of eight cells along the Hilbert curve through a cube of 2^bits cells a side: neighbours
/// on the curve are neighbours in space.
///
/// bits   1 .. 20; x, y, z < 2^bits
/// Source: Skilling, "Programming the Hilbert curve", AIP Conf. Proc. 707, 2004.
[[nodiscard]] inline std::array<std::uint64_t, 8> hilbert_keys(u32x8 x,
                                                               u32x8 y,
                                                               u32x8 z,
                                                               int bits) {
  for (int bit = bits - 1; bit > 0; --bit) {
    x = x ^ (detail::spread_bit(x, bit) & detail::below(bit));
    detail::undo_level(x, y, bit);
    detail::undo_level(x, z, bit);
  }
  y = y ^ x;  // Gray code
  z = z ^ y;
  u32x8 turned = u32x8::broadcast(0);
  for (int bit = bits - 1; bit > 0; --bit) {
    turned = turned ^ (detail::spread_bit(z, bit) & detail::below(bit));
  }
  x = x ^ turned;
  y = y ^ turned;
  z = z ^ turned;
  std::array<std::uint32_t, 8> low, high;
  detail::interleave(x, y, z).store(low.data());
  detail::interleave(x >> 10, y >> 10, z >> 10).store(high.data());
  std::array<std::uint64_t, 8> keys;
  for (std::size_t i = 0; i < 8; ++i) keys[i] = std::uint64_t{high[i]} << 30 | low[i];
  return keys;
}

}  // namespace AIB_ISA
}  // namespace aib::search
