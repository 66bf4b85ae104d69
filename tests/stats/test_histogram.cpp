// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/stats/histogram.hpp>

#include <doctest/doctest.h>

#include <limits>

using namespace aib;

namespace test_histogram {

TEST_CASE("a bin holds its lower edge, values outside are counted") {
  stats::histogram h(0, 4, 4);
  for (const double x : {-0.1, 0., 0.9, 1., 3.999, 4., std::numeric_limits<double>::quiet_NaN()})
    h.add(x);
  CHECK(h.counts() == std::vector<std::uint64_t>{2, 1, 0, 1});
  CHECK(h.below() == 1);
  CHECK(h.above() == 2);
  CHECK(h.total() == 7);
  CHECK(h.edge(3) == 3);
}

TEST_CASE("histograms of equal bins merge, others do not") {
  stats::histogram a(0, 1, 2), b(0, 1, 2), other(0, 2, 2);
  a.add(0.1);
  b.add(0.9);
  a += b;
  CHECK(a.counts() == std::vector<std::uint64_t>{1, 1});
  CHECK_THROWS_AS(a += other, argument_error);
  CHECK_THROWS_AS(stats::histogram(1, 1, 2), argument_error);
}

}  // namespace test_histogram
