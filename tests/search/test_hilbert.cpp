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

namespace {

/// Keys of all cells of a cube, x slowest.
std::vector<std::uint64_t> all_keys(std::uint32_t side, int bits) {
  std::vector<std::uint64_t> keys;
  std::array<std::array<std::uint32_t, 8>, 3> cell{};
  for (std::uint32_t i = 0; i < side * side * side; i += 8) {
    for (std::uint32_t lane = 0; lane < 8; ++lane) {
      const std::uint32_t c = i + lane;
      cell[0][lane] = c / side / side, cell[1][lane] = c / side % side, cell[2][lane] = c % side;
    }
    const auto eight =
        search::hilbert_keys(u32x8::load(cell[0].data()), u32x8::load(cell[1].data()),
                             u32x8::load(cell[2].data()), bits);
    keys.insert(keys.end(), eight.begin(), eight.end());
  }
  return keys;
}

}  // namespace

TEST_CASE("the curve visits each cell once and always steps to a neighbour") {
  for (const int bits : {1, 2, 3, 4}) {
    const auto side = std::uint32_t{1} << bits;
    const auto keys = all_keys(side, bits);
    std::vector<int> cell_at(keys.size(), -1);
    for (std::size_t i = 0; i < keys.size(); ++i) {
      REQUIRE(keys[i] < cell_at.size());
      REQUIRE(cell_at[keys[i]] == -1);
      cell_at[keys[i]] = static_cast<int>(i);
    }
    const int n = static_cast<int>(side);
    for (std::size_t i = 1; i < cell_at.size(); ++i) {
      const int a = cell_at[i - 1], b = cell_at[i];
      REQUIRE(std::abs(a / n / n - b / n / n) + std::abs(a / n % n - b / n % n) +
                  std::abs(a % n - b % n) ==
              1);
    }
  }
}

TEST_CASE("a finer curve refines a coarser one, up to 20 bits an axis") {
  const std::uint32_t x[8] = {0, 1, 77'777, 0xfffff, 0x80000, 524'287, 9, 1'000'000};
  const std::uint32_t y[8] = {0, 0, 0xfffff, 0xfffff, 0x7ffff, 3, 99'999, 31'415};
  const std::uint32_t z[8] = {0, 1, 5, 0xfffff, 0x80001, 271'828, 0xffffe, 0};
  const auto fine = search::hilbert_keys(u32x8::load(x), u32x8::load(y), u32x8::load(z), 20);
  const auto coarse =
      search::hilbert_keys(u32x8::load(x) >> 2, u32x8::load(y) >> 2, u32x8::load(z) >> 2, 18);
  for (std::size_t i = 0; i < 8; ++i) {
    CHECK(fine[i] < (std::uint64_t{1} << 60));
    CHECK((fine[i] >> 6) == coarse[i]);
  }
}

}  // namespace test_hilbert
