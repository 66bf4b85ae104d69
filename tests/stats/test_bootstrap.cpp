// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/core/random.hpp>
#include <aib/stats/bootstrap.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <support/stopped.hpp>
#include <vector>

using namespace aib;
using doctest::Approx;

namespace test_bootstrap {

namespace {

/// x[i] = 0.9 x[i - 1] + noise: neighbours are alike.
std::vector<double> series(std::size_t n, double memory) {
  random_engine random(7);
  std::vector<double> x(n);
  double last = 0;
  for (double& v : x) v = last = memory * last + random.normal();
  return x;
}

}  // namespace

TEST_CASE("the interval of independent values is that of the normal law") {
  const auto x = series(2000, 0);
  const auto interval = stats::bootstrap_mean(x, {.block = 1});
  CHECK(interval.deviation == Approx(1 / std::sqrt(2000)).epsilon(0.1));
  CHECK(interval.high - interval.low == Approx(2 * 1.96 / std::sqrt(2000)).epsilon(0.1));
  CHECK(interval.low < interval.mean);
  CHECK(interval.mean < interval.high);
}

TEST_CASE("blocks widen the interval where neighbours are alike") {
  const auto x = series(2000, 0.9);
  const double alone = stats::bootstrap_mean(x, {.block = 1}).deviation;
  const double blocks = stats::bootstrap_mean(x, {.block = 50}).deviation;
  CHECK(blocks > 2.5 * alone);  // sqrt((1 + 0.9) / (1 - 0.9)) = 4.4 for endless blocks
}

TEST_CASE("a seed gives one interval, another seed another") {
  const auto x = series(100, 0.5);
  const auto a = stats::bootstrap_mean(x);
  const auto b = stats::bootstrap_mean(x);
  const auto c = stats::bootstrap_mean(x, {.seed = 2});
  CHECK(a.low == b.low);
  CHECK(a.high == b.high);
  CHECK(a.low != c.low);
}

TEST_CASE("one block of everything leaves a point") {
  const std::vector<double> x = {1, 2, 6};
  const auto interval = stats::bootstrap_mean(x, {.block = 3});
  CHECK(interval.low == Approx(3));
  CHECK(interval.high == Approx(3));
}

TEST_CASE("no values and senseless options are refused") {
  CHECK_THROWS_AS((void)stats::bootstrap_mean({}), undefined_error);
  const std::vector<double> x = {1};
  CHECK_THROWS_AS((void)stats::bootstrap_mean(x, {.block = 0}), argument_error);
  CHECK_THROWS_AS((void)stats::bootstrap_mean(x, {.level = 1}), argument_error);
}

TEST_CASE("resampling stops") {
  CHECK_THROWS_AS((void)stats::bootstrap_mean(series(10, 0), {.control = support::stopped()}),
                  stopped_error);
}

}  // namespace test_bootstrap
