// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/cloud/compare.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <vector>

using namespace aib;

namespace test_compare {

namespace {

cloud::cloud on_x(std::vector<float> xs) {
  cloud::cloud c;
  for (const float x : xs) c.points.push_back({x, 0, 0});
  return c;
}

}  // namespace

TEST_CASE("one point against two") {
  const auto c = cloud::compare(on_x({0}), on_x({1, 5}), {.tau = {1, 1.5, 10}});
  CHECK(c.accuracy == 1);
  CHECK(c.completeness == 3);
  CHECK(c.chamfer == 4);
  CHECK(c.chamfer_mean == 2);
  CHECK(c.f1_distance == 1.5);
  CHECK(c.completeness_median == 3);
  CHECK(c.hausdorff == 5);
  CHECK(c.n_estimate == 1);
  CHECK(c.n_reference == 2);
  REQUIRE(c.scores.size() == 3);
  CHECK(c.scores[0].precision == 0);  // strictly below
  CHECK(c.scores[0].f_score == 0);
  CHECK(c.scores[1].precision == 1);
  CHECK(c.scores[1].recall == 0.5);
  CHECK(c.scores[1].f_score == doctest::Approx(2 / 3.0));
  CHECK(c.scores[2].f_score == 1);
}

TEST_CASE("a cloud against itself has no error and full scores") {
  const auto c = cloud::compare(on_x({0, 1, 2}), on_x({2, 0, 1}), {.tau = {1e-9}});
  CHECK(c.chamfer == 0);
  CHECK(c.f1_distance == 0);
  CHECK(c.scores[0].f_score == 1);
}

TEST_CASE("what is beyond the maximum is left out and told") {
  const auto c = cloud::compare(on_x({0, 100}), on_x({1, 5}), {.max_distance = 20});
  CHECK(c.accuracy == 1);
  CHECK(c.estimate_beyond == 0.5);
  CHECK(c.reference_beyond == 0);
}

TEST_CASE("a stray so far away that no float holds its squared distance counts as infinite") {
  const auto c = cloud::compare(on_x({0, 1e19F}), on_x({0, 1}));
  CHECK(c.n_dropped == 1);
  CHECK(c.accuracy == 0);
  CHECK(c.completeness == 0.5);
  const auto far = cloud::compare(on_x({0, 0x1p62F}), on_x({0, -0x1p62F}));
  CHECK(far.n_dropped == 0);
  CHECK(far.accuracy == 0x1p61);
  CHECK(std::isfinite(far.f1_distance));
}

TEST_CASE("points that are not finite are counted over both clouds; nothing is undefined") {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto c = cloud::compare(on_x({0, nan}), on_x({1, nan, nan}));
  CHECK(c.n_dropped == 3);
  CHECK(c.n_estimate == 1);
  CHECK(c.chamfer == 2);
  CHECK_THROWS_WITH_AS(
      static_cast<void>(cloud::compare(on_x({}), on_x({1}))),
      "cloud::compare: no finite point in the estimated cloud (0 points, 0 not finite)",
      undefined_error);
}

}  // namespace test_compare
