// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/stats/quantiles.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

using namespace aib;

namespace test_quantiles {

TEST_CASE("quantiles of an even number of values follow their rule") {
  const std::vector<double> v{4, 1, 3, 2};
  const std::span<const double> s(v);
  CHECK(stats::median(s) == 2.5);
  CHECK(stats::quantile(s, 0.5, stats::quantile_rule::lower) == 2);
  CHECK(stats::quantile(s, 0.5, stats::quantile_rule::midpoint) == 2.5);
  CHECK(stats::quantile(s, 0.25) == 1.75);
  CHECK(stats::quantile(s, 0) == 1);
  CHECK(stats::quantile(s, 1) == 4);
}

TEST_CASE("between two infinities lies infinity") {
  const std::vector<double> v{1, HUGE_VAL, HUGE_VAL, HUGE_VAL};
  CHECK(stats::quantile(std::span<const double>(v), 0.5) == HUGE_VAL);
}

TEST_CASE("a quantile of nothing is undefined, outside [0, 1] it is refused") {
  CHECK_THROWS_WITH_AS(stats::median(std::span<const double>()), "stats::quantile: no values",
                       undefined_error);
  const std::vector<float> v{1};
  CHECK_THROWS_AS(stats::quantile(std::span<const float>(v), 1.5), argument_error);
}

}  // namespace test_quantiles
