// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace aib::search {

namespace detail {

/// How the curve lies in one cell: which axis stands at each place, which places run backwards,
/// and whether the walk through the eight children is reversed.
struct hilbert_state {
  std::array<unsigned, 3> axis{0, 1, 2};
  std::array<unsigned, 3> flip{0, 0, 0};
  unsigned reversed = 0;
};

/// One level down: the child's place on the curve and how the curve lies in the child.
struct hilbert_step {
  unsigned place;  ///< 0..7
  hilbert_state child;
};

/// `octant` has bit k set in the upper half of axis k.
/// Source: Skilling, "Programming the Hilbert curve", AIP Conf. Proc. 707, 2004, one bit plane.
constexpr hilbert_step descend(hilbert_state state, unsigned octant) {
  std::array<unsigned, 3> bit{};
  for (std::size_t k = 0; k < 3; ++k) bit[k] = ((octant >> state.axis[k]) & 1) ^ state.flip[k];
  for (std::size_t k = 0; k < 3; ++k) {
    if (bit[k]) {
      state.flip[0] ^= 1;
    } else {
      const unsigned axis = state.axis[0], flip = state.flip[0];
      state.axis[0] = state.axis[k], state.flip[0] = state.flip[k];
      state.axis[k] = axis, state.flip[k] = flip;
    }
  }
  const unsigned second = bit[1] ^ bit[0];
  const unsigned third = bit[2] ^ second;
  const unsigned r = state.reversed;
  state.reversed ^= third;
  return {(bit[0] ^ r) << 2 | (second ^ r) << 1 | (third ^ r), state};
}

inline constexpr std::array<std::array<unsigned, 3>, 6> axis_orders{
    {{0, 1, 2}, {1, 0, 2}, {2, 1, 0}, {0, 2, 1}, {1, 2, 0}, {2, 0, 1}}};

constexpr unsigned number_of(const hilbert_state& s) {
  unsigned order = 0;
  while (axis_orders[order] != s.axis) ++order;
  return order << 4 | (s.flip[0] | s.flip[1] << 1 | s.flip[2] << 2) << 1 | s.reversed;
}

constexpr hilbert_state state_of(unsigned number) {
  return {axis_orders[number >> 4],
          {(number >> 1) & 1, (number >> 2) & 1, (number >> 3) & 1},
          number & 1};
}

inline constexpr unsigned hilbert_states = 96;

/// One level: [state][octant] -> next state << 3 | place.
constexpr std::array<std::uint16_t, hilbert_states * 8> make_octant_table() {
  std::array<std::uint16_t, hilbert_states * 8> table{};
  for (unsigned number = 0; number < hilbert_states; ++number) {
    for (unsigned octant = 0; octant < 8; ++octant) {
      const hilbert_step step = descend(state_of(number), octant);
      table[number * 8 + octant] =
          static_cast<std::uint16_t>(number_of(step.child) << 3 | step.place);
    }
  }
  return table;
}

/// Two levels in one look-up: [state][two octants] -> next state << 6 | two places. 12 KB.
constexpr std::array<std::uint16_t, hilbert_states * 64> make_hilbert_table() {
  const auto octants = make_octant_table();
  std::array<std::uint16_t, hilbert_states * 64> table{};
  for (unsigned i = 0; i < table.size(); ++i) {
    const unsigned upper = octants[i / 64 * 8 + i / 8 % 8];
    const unsigned lower = octants[(upper >> 3) * 8 + i % 8];
    table[i] = static_cast<std::uint16_t>((lower >> 3) << 6 | (upper & 7) << 3 | (lower & 7));
  }
  return table;
}

inline constexpr auto hilbert_table = make_hilbert_table();

/// The low 21 bits of x, two zeros between each.
constexpr std::uint64_t spread(std::uint64_t x) {
  x &= 0x1fffff;
  x = (x | x << 32) & 0x1f00000000ffff;
  x = (x | x << 16) & 0x1f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  return (x | x << 2) & 0x1249249249249249;
}

}  // namespace detail

/// Place of a cell along the Hilbert curve through a cube of 2^bits cells a side: neighbours on the
/// curve are neighbours in space.
///
/// bits   even, at most 20; x, y, z < 2^bits
[[nodiscard]] constexpr std::uint64_t hilbert_key(std::uint32_t x,
                                                  std::uint32_t y,
                                                  std::uint32_t z,
                                                  int bits) {
  const std::uint64_t octants = detail::spread(x) | detail::spread(y) << 1 | detail::spread(z) << 2;
  std::uint64_t key = 0;
  unsigned state = 0;
  for (int shift = 3 * bits - 6; shift >= 0; shift -= 6) {
    const unsigned entry = detail::hilbert_table[state * 64 + ((octants >> shift) & 63)];
    state = entry >> 6;
    key = key << 6 | (entry & 63);
  }
  return key;
}

}  // namespace aib::search
