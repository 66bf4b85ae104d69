// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/math/projection.hpp>
#include <aib/math/rotation.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <vector>

using namespace aib::math;

namespace test_projection {

namespace {

camera make(camera_model model, std::vector<double> parameters) {
  return {model, 640, 480, std::move(parameters)};
}

/// One camera of every model, with strong but monotone distortion.
std::vector<camera> every_model() {
  using enum camera_model;
  return {
      make(simple_pinhole, {500, 320, 240}),
      make(pinhole, {500, 505, 320, 240}),
      make(simple_radial, {500, 320, 240, 0.05}),
      make(radial, {500, 320, 240, -0.1, 0.02}),
      make(opencv, {510, 511, 321, 239, -0.125, 0.0625, 0.001, -0.002}),
      make(opencv_fisheye, {300, 301, 320, 240, 0.01, -0.002, 0.001, -0.0001}),
      make(full_opencv, {510, 511, 321, 239, -0.1, 0.05, 0.001, -0.002, 0.01, 0.02, -0.01, 0.001}),
      make(fov, {500, 501, 320, 240, 0.9}),
      make(simple_radial_fisheye, {300, 320, 240, -0.02}),
      make(radial_fisheye, {300, 320, 240, -0.02, 0.003}),
      make(thin_prism_fisheye,
           {300, 301, 320, 240, 0.01, -0.02, 0.001, -0.001, 0.003, -0.0004, 0.0009, 0.001}),
      make(rad_tan_thin_prism_fisheye,
           {300.125, 300.25, 320, 240, 0.01, -0.02, 0.003, -0.0004, 5e-5, -6e-6, 0.0007, -0.0008,
            0.0009, 0.001, -0.0011, 0.0012}),
      make(simple_division, {505, 320, 240, -0.15}),
      make(division, {505, 506, 320, 240, -0.175}),
      make(simple_fisheye, {290.5, 320, 240}),
      make(fisheye, {290.5, 291.5, 320, 240}),
      make(eucm, {400, 401, 320, 240, 0.6, 1.1}),
      make(equirectangular, {640, 480}),
  };
}

}  // namespace

TEST_CASE("a pixel's ray projects to the pixel, in every model") {
  for (const camera& c : every_model()) {
    CAPTURE(info(c.model).name);
    for (double x = 0.5; x < 640; x += 31.7) {
      for (double y = 0.5; y < 480; y += 29.3) {
        const auto ray = unproject(c, {x, y});
        REQUIRE(ray);
        CHECK(std::abs(ray->norm() - 1) < 1e-14);
        const auto pixel = project(c, 7.5 * *ray);
        REQUIRE(pixel);
        CHECK((*pixel - Eigen::Vector2d(x, y)).norm() < 1e-9);
      }
    }
  }
}

TEST_CASE("the principal point looks straight ahead") {
  for (const camera& c : every_model()) {
    CAPTURE(info(c.model).name);
    const auto pixel = project(c, {0, 0, 3});
    REQUIRE(pixel);
    const Eigen::Vector2d middle =
        c.has_focal() ? Eigen::Vector2d(c.cx(), c.cy()) : Eigen::Vector2d(320, 240);
    CHECK((*pixel - middle).norm() < 1e-12);
  }
}

TEST_CASE("pixels worked out by hand") {
  const Eigen::Vector3d p(0.3, -0.4, 1);  // r = 0.5
  CHECK((*project(make(camera_model::pinhole, {100, 200, 10, 20}), p) - Eigen::Vector2d(40, -60))
            .norm() < 1e-12);
  // 1 + 0.4 * 0.25 = 1.1
  CHECK(
      (*project(make(camera_model::simple_radial, {100, 0, 0, 0.4}), p) - Eigen::Vector2d(33, -44))
          .norm() < 1e-12);
  // tangential alone: p1 2xy + p2 (r2 + 2x2) = -0.024 + 0.2 * 0.43
  const auto brown = *project(make(camera_model::opencv, {1, 1, 0, 0, 0, 0, 0.1, 0.2}), p);
  CHECK(brown.x() == doctest::Approx(0.3 - 0.024 + 0.086));
  CHECK(brown.y() == doctest::Approx(-0.4 + 0.1 * (0.25 + 0.32) - 0.048));
  // Aria's order is the other way round: p0 belongs to x.
  const Eigen::Vector3d turned(std::tan(0.5) * 0.6, std::tan(0.5) * -0.8, 1);
  std::vector<double> aria(16);
  aria[0] = aria[1] = 1;
  aria[10] = 0.2;
  aria[11] = 0.1;
  const auto by_aria = *project(make(camera_model::rad_tan_thin_prism_fisheye, aria), turned);
  CHECK(by_aria.x() == doctest::Approx(brown.x()));
  CHECK(by_aria.y() == doctest::Approx(brown.y()));
  // An equidistant camera shows 60 degrees at f * pi / 3.
  const Eigen::Vector3d at_60(std::sin(radians(60)), 0, std::cos(radians(60)));
  CHECK(project(make(camera_model::simple_fisheye, {300, 0, 0}), at_60)->x() ==
        doctest::Approx(300 * radians(60)));
  // FOV: atan(2 r tan(w/2)) / w
  CHECK(project(make(camera_model::fov, {1, 1, 0, 0, 0.8}), {0.5, 0, 1})->x() ==
        doctest::Approx(std::atan(std::tan(0.4)) / 0.8));
  // The sphere: right is a quarter of the width further, down at the lower edge.
  CHECK((*project(make(camera_model::equirectangular, {640, 480}), {2, 0, 0}) -
         Eigen::Vector2d(480, 240))
            .norm() < 1e-12);
  CHECK(project(make(camera_model::equirectangular, {640, 480}), {0, 1, 0})->y() ==
        doctest::Approx(480));
  // EUCM with alpha 0 is a pinhole.
  CHECK((*project(make(camera_model::eucm, {100, 200, 10, 20, 0, 1}), p) - Eigen::Vector2d(40, -60))
            .norm() < 1e-12);
}

TEST_CASE("no distortion is the pinhole") {
  using enum camera_model;
  const camera plain = make(pinhole, {500, 505, 320, 240});
  for (const camera& c :
       {make(opencv, {500, 505, 320, 240, 0, 0, 0, 0}), make(fov, {500, 505, 320, 240, 0}),
        make(full_opencv, {500, 505, 320, 240, 0, 0, 0, 0, 0, 0, 0, 0}),
        make(division, {500, 505, 320, 240, 0}), make(eucm, {500, 505, 320, 240, 0, 1})}) {
    CAPTURE(info(c.model).name);
    CHECK((*project(c, {0.4, -0.2, 1.3}) - *project(plain, {0.4, -0.2, 1.3})).norm() < 1e-12);
  }
}

TEST_CASE("what is behind, out of range or not finite has no pixel") {
  using enum camera_model;
  CHECK(!project(make(pinhole, {1, 1, 0, 0}), {0, 0, -1}));
  CHECK(!project(make(pinhole, {1, 1, 0, 0}), {1, 1, 0}));
  CHECK(project(make(fisheye, {1, 1, 0, 0}), {1, 0, -0.2}));
  CHECK(!project(make(simple_division, {1, 0, 0, 5}), {1, 0, 1}));
  CHECK(!project(make(equirectangular, {640, 480}), {0, 0, 0}));
  CHECK(!project(make(pinhole, {1, 1, 0, 0}), {0, 0, std::numeric_limits<double>::quiet_NaN()}));
  CHECK(!unproject(make(simple_fisheye, {1, 0, 0}), {4, 0}));         // beyond 180 degrees
  CHECK(!unproject(make(simple_radial, {100, 0, 0, -1}), {100, 0}));  // r - r^3 ends at 0.385
  CHECK(!unproject(make(eucm, {1, 1, 0, 0, 1, 1}), {2, 0}));
}

TEST_CASE("a camera with too few parameters is refused") {
  CHECK_THROWS_WITH_AS(project(make(camera_model::opencv, {1, 2, 3, 4}), {0, 0, 1}),
                       "camera: OPENCV expects 8 parameters, found 4", aib::argument_error);
}

}  // namespace test_projection
