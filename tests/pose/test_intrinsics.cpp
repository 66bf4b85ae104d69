// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/pose/intrinsics.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

using namespace aib;

namespace test_intrinsics {

namespace {

const math::camera reference = math::pinhole(640, 480, 500, 500, 320, 240);

}  // namespace

TEST_CASE("a principal point 3 and 4 pixels off moves every pixel by 5") {
  const auto d =
      pose::reprojection_difference(math::pinhole(640, 480, 500, 500, 323, 244), reference);
  CHECK(d.mean == doctest::Approx(5));
  CHECK(d.max == doctest::Approx(5));
  CHECK(d.n == 32 * 24);
  CHECK(d.n_lost == 0);
}

TEST_CASE("cameras are compared at the reference's size and across models") {
  const math::camera half = math::pinhole(320, 240, 250, 250, 160, 120);
  CHECK(pose::reprojection_difference(half, reference).max < 1e-9);
  const math::camera plain{math::camera_model::opencv, 640, 480, {500, 500, 320, 240, 0, 0, 0, 0}};
  CHECK(pose::reprojection_difference(plain, reference).max < 1e-9);
  // 1 % more focal length moves a pixel by 1 % of its distance from the middle.
  const auto longer =
      pose::reprojection_difference(math::pinhole(640, 480, 505, 505, 320, 240), reference);
  CHECK(longer.max == doctest::Approx(0.01 * std::hypot(310, 230)));
}

TEST_CASE("intrinsics of views: focal, principal point, spread") {
  const std::vector<pose::camera_pair> views = {
      {math::pinhole(640, 480, 490, 490, 320, 240), reference},
      {math::pinhole(640, 480, 510, 510, 323, 244), reference}};
  const auto r = pose::intrinsics_error(views);
  CHECK(r.focal.mre == doctest::Approx(0.02));
  CHECK(r.focal_spread == doctest::Approx(0.02));
  CHECK(r.principal_point_px == doctest::Approx(2.5));
  CHECK(r.reprojection_px > 2.5);
  CHECK_THROWS_AS(pose::intrinsics_error({}), undefined_error);
}

TEST_CASE("an unknown image size is refused, a large one is not") {
  CHECK_THROWS_AS(pose::reprojection_difference(math::pinhole(0, 0, 500, 500, 320, 240), reference),
                  argument_error);
  const math::camera large = math::pinhole(65536, 65536, 5e4, 5e4, 3e4, 3e4);
  CHECK(pose::reprojection_difference(large, large).max < 1e-9);
}

}  // namespace test_intrinsics
