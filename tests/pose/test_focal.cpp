// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/pose/focal.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

using namespace aib;

namespace test_focal {

namespace {

const math::camera reference = math::pinhole(1920, 1080, 2000, 2000, 960, 540);

}  // namespace

TEST_CASE("focal lengths are compared at the reference's image size") {
  // fx 550 of 480 is 2200 of 1920, fy 450 of 270 is 1800 of 1080: the mean is right.
  const math::camera estimate = math::pinhole(480, 270, 550, 450, 240, 135);
  CHECK(pose::focal_at_size(estimate, 1920, 1080) == doctest::Approx(2000));
  const std::vector<pose::camera_pair> views = {{estimate, reference}};
  CHECK(pose::focal_error(views).mre == doctest::Approx(0));
}

TEST_CASE("a camera counts once, or once a view") {
  const pose::camera_pair ten{math::pinhole(1920, 1080, 2200, 2200, 960, 540), reference};
  const pose::camera_pair none{reference, reference};
  const std::vector<pose::camera_pair> views = {ten, none, none, none};
  const auto by_view = pose::focal_error(views);
  CHECK(by_view.mre == doctest::Approx(0.025));
  CHECK(by_view.n == 4);
  const auto by_camera = pose::focal_error(views, pose::focal_over::cameras);
  CHECK(by_camera.mre == doctest::Approx(0.05));
  CHECK(by_camera.n == 2);
}

TEST_CASE("no view has no focal error, nor has a camera without focal length") {
  CHECK_THROWS_AS(pose::focal_error({}), undefined_error);
  const math::camera sphere{math::camera_model::equirectangular, 100, 50, {100, 50}};
  const std::vector<pose::camera_pair> views = {{sphere, reference}};
  CHECK_THROWS_AS(pose::focal_error(views), argument_error);
}

TEST_CASE("a focal length that is none gives no number") {
  const auto with_focal = [](double f) { return math::pinhole(1920, 1080, f, f, 960, 540); };
  for (const double f : {0.0, -2000.0, std::nan(""), HUGE_VAL}) {
    const std::vector<pose::camera_pair> views = {{reference, with_focal(f)}};
    CHECK_THROWS_AS(pose::focal_error(views), argument_error);
  }
  const std::vector<pose::camera_pair> lost = {{with_focal(std::nan("")), reference}};
  CHECK_THROWS_AS(pose::focal_error(lost), argument_error);
  const std::vector<pose::camera_pair> inside_out = {{with_focal(-2000), reference}};
  CHECK(pose::focal_error(inside_out).mre == 2);
}

}  // namespace test_focal
