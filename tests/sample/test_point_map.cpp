// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/sample/point_map.hpp>

#include <doctest/doctest.h>

#include <limits>
#include <vector>

using namespace aib;

namespace test_point_map {

namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
const std::vector<float> four_points{1, 2, 3, 0, 0, -1, nan, 0, 1, 4, 5, 6};
const math::rigid3 pose{Eigen::Matrix3d::Identity(), {10, 0, 0}};

}  // namespace

TEST_CASE("points of a point map are moved by the pose; those without a depth are left out") {
  const auto made = sample::place_point_map(four_points, 2, 2, pose);
  REQUIRE(made.points.size() == 2);
  CHECK(made.n_valid == 2);
  CHECK(made.points.position(0) == Eigen::Vector3d(11, 2, 3));
  CHECK(made.points.position(1) == Eigen::Vector3d(14, 5, 6));
}

TEST_CASE("points of a point map are kept strictly above a confidence") {
  raster::image<float> logits(2, 2, 0);
  logits(1, 1) = 2;
  sample::unproject_options options;
  options.confidence = logits.view();
  options.min_confidence = 0.5;
  options.rule = sample::confidence_rule::sigmoid;
  const auto made = sample::place_point_map(four_points, 2, 2, pose, options);
  CHECK(made.points.size() == 1);
  CHECK(made.n_unsure == 1);
}

TEST_CASE("a point map of another size is refused") {
  CHECK_THROWS_AS(sample::place_point_map(four_points, 3, 2, pose), argument_error);
}

}  // namespace test_point_map
