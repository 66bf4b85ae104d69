// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/core/random.hpp>
#include <aib/math/angle_of.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace aib;

namespace test_angle_of {

namespace {

double angle(double x, double y) {
  double lanes[4];
  math::angle_of(f64x4::broadcast(x), f64x4::broadcast(y)).store(lanes);
  return lanes[3];
}

}  // namespace

TEST_CASE("angle_of is std::atan2 over the upper half plane") {
  random_engine random;
  double worst = 0, worst_small = 0;
  for (int i = 0; i < 100000; ++i) {
    const double a = random.uniform(0, std::numbers::pi), length = std::exp(random.uniform(-9, 9));
    const double x = length * std::cos(a), y = length * std::sin(a);
    worst = std::max(worst, std::abs(angle(x, y) - std::atan2(y, x)));
    const double small = std::exp(random.uniform(-40, -1));
    worst_small = std::max(worst_small, std::abs(angle(1, small) / std::atan(small) - 1));
  }
  CHECK(worst < 5e-16);
  CHECK(worst_small < 7e-16);
}

TEST_CASE("angle_of the axes, of the diagonals and of nothing") {
  const double pi = std::numbers::pi;
  CHECK(angle(1, 0) == 0);
  CHECK(angle(0, 1) == pi / 2);
  CHECK(angle(-1, 0) == pi);
  CHECK(angle(3, 3) == pi / 4);
  CHECK(angle(-3, 3) == 3 * pi / 4);
  CHECK(angle(0, 0) == 0);
}

}  // namespace test_angle_of
