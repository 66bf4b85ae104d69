// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/search/hilbert.hpp>

#include <doctest/doctest.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <vector>

using namespace aib;

namespace test_hilbert {

TEST_CASE("the curve visits each cell once and always steps to a neighbour") {
  for (const int bits : {2, 4}) {
    const auto side = std::uint32_t{1} << bits;
    std::vector<std::array<int, 3>> cell_at(std::size_t{side} * side * side, {-1, -1, -1});
    for (std::uint32_t x = 0; x < side; ++x) {
      for (std::uint32_t y = 0; y < side; ++y) {
        for (std::uint32_t z = 0; z < side; ++z) {
          const auto key = search::hilbert_key(x, y, z, bits);
          REQUIRE(key < cell_at.size());
          REQUIRE(cell_at[key][0] == -1);
          cell_at[key] = {static_cast<int>(x), static_cast<int>(y), static_cast<int>(z)};
        }
      }
    }
    for (std::size_t i = 1; i < cell_at.size(); ++i) {
      int steps = 0;
      for (std::size_t k = 0; k < 3; ++k) steps += std::abs(cell_at[i][k] - cell_at[i - 1][k]);
      REQUIRE(steps == 1);
    }
  }
}

}  // namespace test_hilbert
