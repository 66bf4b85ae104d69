// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/core/random.hpp>

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <random>

using namespace aib;

namespace test_random {

static_assert(std::uniform_random_bit_generator<random_engine>);

TEST_CASE("the bits of a counter are those of SplitMix64") {
  // First outputs of the reference implementation for seed 0.
  CHECK(random_bits(0, 0) == 0xe220a8397b1dcdafu);
  CHECK(random_bits(0, 1) == 0x6e789e6aa1b965f4u);
}

TEST_CASE("a seed gives one sequence, another seed another") {
  random_engine a(7), b(7), c(8);
  CHECK(a() == b());
  CHECK(a() != c());
}

TEST_CASE("uniform numbers fill [0, 1) and integers all values") {
  random_engine engine(1);
  double sum = 0;
  std::array<int, 7> seen{};
  for (int i = 0; i < 70'000; ++i) {
    const double u = engine.uniform();
    REQUIRE((u >= 0 && u < 1));
    sum += u;
    ++seen[engine.below(7)];
  }
  CHECK(sum / 70'000 == doctest::Approx(0.5).epsilon(0.01));
  for (const int n : seen) CHECK(std::abs(n - 10'000) < 500);
}

TEST_CASE("normal numbers have mean 0 and deviation 1") {
  random_engine engine(3);
  double sum = 0, squares = 0;
  for (int i = 0; i < 100'000; ++i) {
    const double x = engine.normal();
    sum += x;
    squares += x * x;
  }
  CHECK(std::abs(sum / 100'000) < 0.02);
  CHECK(squares / 100'000 == doctest::Approx(1).epsilon(0.02));
}

}  // namespace test_random
