// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/core/random.hpp>
#include <aib/stats/moments.hpp>

#include <doctest/doctest.h>

#include <vector>

using namespace aib;

namespace test_moments {

TEST_CASE("moments of 1, 2, 3, 4") {
  stats::moments m;
  for (const double x : {1., 2., 3., 4.}) m.add(x);
  CHECK(m.count() == 4);
  CHECK(m.mean() == 2.5);
  CHECK(m.variance() == 1.25);
  CHECK(m.mean_square() == 7.5);
  CHECK(m.min() == 1);
  CHECK(m.max() == 4);
}

TEST_CASE("a small spread about a large mean is kept") {
  stats::moments m;
  for (int i = 0; i < 1000; ++i) m.add(1e9 + (i % 2));
  CHECK(m.variance() == doctest::Approx(0.25).epsilon(1e-9));
}

TEST_CASE("merged parts equal the whole") {
  random_engine engine(5);
  stats::moments whole, left, right, none;
  for (int i = 0; i < 1000; ++i) {
    const double x = 10 + engine.normal();
    whole.add(x);
    (i < 300 ? left : right).add(x);
  }
  none += left;
  none += right;
  none += stats::moments();
  CHECK(none.count() == whole.count());
  CHECK(none.mean() == doctest::Approx(whole.mean()).epsilon(1e-14));
  CHECK(none.variance() == doctest::Approx(whole.variance()).epsilon(1e-12));
  CHECK(none.min() == whole.min());
  CHECK(none.max() == whole.max());
}

}  // namespace test_moments
