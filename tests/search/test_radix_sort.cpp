// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/core/random.hpp>
#include <aib/search/radix_sort.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

using namespace aib;

namespace test_radix_sort {

TEST_CASE("words are sorted by some of their bits, equal ones keep their order") {
  for (const std::size_t n : {0u, 1u, 1000u, 50000u}) {
    for (const unsigned threads : {1u, 3u}) {
      random_engine random(n + threads);
      search::buffer<std::uint64_t> words(n);
      for (std::size_t i = 0; i < n; ++i) words[i] = random();
      std::vector<std::uint64_t> expected(words.data(), words.data() + n);
      const auto key = [](std::uint64_t w) { return (w >> 7) & ((1u << 25) - 1); };
      std::stable_sort(expected.begin(), expected.end(),
                       [&](std::uint64_t a, std::uint64_t b) { return key(a) < key(b); });
      search::radix_sort(words, {7, 32}, threads);
      CHECK(std::equal(expected.begin(), expected.end(), words.data()));
    }
  }
}

}  // namespace test_radix_sort
