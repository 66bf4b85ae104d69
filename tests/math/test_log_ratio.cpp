// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/core/random.hpp>
#include <aib/math/log_ratio.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace aib;

namespace test_log_ratio {

TEST_CASE("log_ratio is std::log of the ratio, near 1 and far from it") {
  random_engine random;
  double worst = 0;
  for (int i = 0; i < 200000; ++i) {
    const double b = std::exp(random.uniform(-300, 300));
    const double a = b * std::exp(random.uniform(-1, 1) * std::pow(10, random.uniform(-16, 2)));
    const long double exact = std::log(static_cast<long double>(a) / b);
    const double error = std::abs(static_cast<double>(math::log_ratio(a, b) - exact));
    worst = std::max(worst, error / std::max(1.0, std::abs(static_cast<double>(exact))));
  }
  CHECK(worst < 3e-16);
}

TEST_CASE("log_ratio of near numbers keeps its digits") {
  for (const double k : {1.0, 3.0, 1000.0}) {
    const double a = 7 * (1 + k * 0x1p-52);
    CHECK(math::log_ratio(a, 7) == doctest::Approx(a / 7 - 1).epsilon(1e-12));
  }
}

TEST_CASE("log_ratio of equal numbers is 0 and of swapped numbers the opposite") {
  for (const double x : {1e-300, 0.1, 1.0, std::sqrt(2.0), 3.7, 1e300})
    CHECK(math::log_ratio(x, x) == 0);
  CHECK(math::log_ratio(3, 0.7) == -math::log_ratio(0.7, 3));
}

TEST_CASE("log_ratio does not overflow where the ratio would") {
  CHECK(math::log_ratio(1e300, 1e-300) == doctest::Approx(600 * std::log(10)).epsilon(1e-15));
}

}  // namespace test_log_ratio
