// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/math/projection.hpp>
#include <aib/math/rotation.hpp>
#include <aib/sample/point_map.hpp>
#include <aib/sample/unproject.hpp>

#include <Eigen/Geometry>
#include <doctest/doctest.h>

#include <cmath>
#include <support/stopped.hpp>
#include <vector>

using namespace aib;
using doctest::Approx;
using sample::confidence_rule;

namespace test_unproject {

namespace {

depth::depth_map flat(std::size_t width, std::size_t height, float depth) {
  return {raster::image<float>(width, height, depth)};
}

const math::camera camera = math::pinhole(4, 2, 10, 20, 2, 1);

math::rigid3 some_pose() {
  return {Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix(),
          {3, -2, 5}};
}

}  // namespace

TEST_CASE("a pinhole camera gives the points worked out by hand, row by row") {
  const auto result = sample::unproject(flat(4, 2, 10), camera, {});
  REQUIRE(result.points.size() == 8);
  CHECK(result.points.points[0].isApprox(Eigen::Vector3f(-1.5f, -0.25f, 10)));
  CHECK(result.points.points[7].isApprox(Eigen::Vector3f(1.5f, 0.25f, 10)));
  CHECK(result.n_valid == 8);
}

TEST_CASE("pixel_offset 0 takes a pixel's index for its centre") {
  const auto result = sample::unproject(flat(4, 2, 10), camera, {}, {.pixel_offset = 0});
  CHECK(result.points.points[0].isApprox(Eigen::Vector3f(-2, -0.5f, 10)));
}

TEST_CASE("points project back to their pixels, through any camera and pose") {
  using enum math::camera_model;
  const math::camera cameras[] = {
      math::pinhole(40, 30, 35, 36, 20, 15),
      {opencv, 40, 30, {35, 36, 20, 15, 0.05, -0.02, 0.001, 0.002}},
      {opencv_fisheye, 40, 30, {35, 36, 20, 15, 0.05, -0.02, 0.001, 0.002}}};
  const math::rigid3 pose = some_pose();
  for (const math::camera& c : cameras) {
    const auto result = sample::unproject(flat(40, 30, 7), c, pose, {.stride = 3});
    REQUIRE(result.points.size() == 14 * 10);
    for (std::size_t i = 0; i < result.points.size(); ++i) {
      const Eigen::Vector3d p_in_camera = pose.inverse() * result.points.position(i);
      CHECK(p_in_camera.z() == Approx(7).epsilon(1e-6));
      const auto pixel = math::project(c, p_in_camera);
      REQUIRE(pixel.has_value());
      CHECK(pixel->x() == Approx(3.0 * static_cast<double>(i % 14) + 0.5).epsilon(1e-4));
      CHECK(pixel->y() == Approx(3.0 * static_cast<double>(i / 14) + 0.5).epsilon(1e-4));
    }
  }
}

TEST_CASE("a map smaller than the camera is scaled to it") {
  const auto large = math::pinhole(400, 200, 1000, 2000, 200, 100);
  const auto small = sample::unproject(flat(4, 2, 10), large, {});
  const auto same = sample::unproject(flat(4, 2, 10), camera, {});
  for (std::size_t i = 0; i < 8; ++i) CHECK(small.points.points[i].isApprox(same.points.points[i]));
}

TEST_CASE("a range is measured from the camera centre") {
  const auto result =
      sample::unproject(flat(4, 2, 10), camera, {}, {.meaning = sample::depth_meaning::range});
  for (const auto& p : result.points.points) CHECK(p.norm() == Approx(10).epsilon(1e-6));
}

TEST_CASE("pixels without a depth give no point") {
  auto map = flat(4, 2, 10);
  map.values(0, 0) = 0;
  map.values(1, 0) = NAN;
  map.values(2, 0) = INFINITY;
  const auto result = sample::unproject(map, camera, {});
  CHECK(result.points.size() == 5);
  CHECK(result.n_valid == 5);
}

TEST_CASE("the confidence rule says what is compared") {
  const auto map = flat(4, 2, 10);
  raster::image<float> confidence(4, 2);
  for (std::size_t i = 0; i < 8; ++i) confidence.data()[i] = static_cast<float>(i) / 4;
  const auto kept = [&](double least, confidence_rule rule) {
    const auto result = sample::unproject(
        map, camera, {}, {.confidence = confidence, .min_confidence = least, .rule = rule});
    CHECK(result.n_unsure + result.points.size() == 8);
    return result.points.size();
  };
  CHECK(kept(0.75, confidence_rule::raw) == 4);      // 0.75 itself is not above it
  CHECK(kept(0.5, confidence_rule::sigmoid) == 7);   // logits above 0
  CHECK(kept(0.75, confidence_rule::sigmoid) == 3);  // logits above ln 3
  CHECK(kept(0.5, confidence_rule::percentile) == 4);
  CHECK(kept(0, confidence_rule::percentile) == 8);
}

TEST_CASE("colours come along") {
  raster::color_image colors(4, 2);
  colors(3, 1) = {1, 2, 3};
  const auto result =
      sample::unproject(flat(4, 2, 10), camera, {}, {.colors = std::as_const(colors).view()});
  REQUIRE(result.points.colors.size() == 8);
  CHECK(result.points.colors[7] == raster::rgb{1, 2, 3});
}

TEST_CASE("map coordinates keep millimetres") {
  math::rigid3 far;
  far.translation = {500000.123, 4649776.456, 12.789};
  const auto result = sample::unproject(flat(4, 2, 10), camera, far);
  CHECK((result.points.position(0) - far.translation - Eigen::Vector3d(-1.5, -0.25, 10)).norm() <
        1e-6);
}

TEST_CASE("the points do not depend on the number of threads") {
  const auto map = flat(64, 200, 3);
  const auto c = math::pinhole(64, 200, 50, 50, 32, 100);
  CHECK(sample::unproject(map, c, some_pose(), {.threads = 1}).points.points ==
        sample::unproject(map, c, some_pose(), {.threads = 3}).points.points);
}

TEST_CASE("what does not fit together is refused") {
  const auto map = flat(4, 2, 10);
  const raster::image<float> small(2, 2);
  const auto refuses = [&](const sample::unproject_options& options) {
    CHECK_THROWS_AS((void)sample::unproject(map, camera, {}, options), argument_error);
  };
  refuses({.confidence = small, .min_confidence = 0.5});
  refuses({.min_confidence = 0.5});
  refuses({.confidence = map.values});
  refuses({.stride = 0});
  refuses({.confidence = map.values, .min_confidence = 2, .rule = confidence_rule::sigmoid});
  math::rigid3 nowhere;
  nowhere.translation.x() = NAN;
  CHECK_THROWS_AS((void)sample::unproject(map, camera, nowhere), argument_error);
  CHECK(sample::unproject({}, camera, {}).points.empty());
}

TEST_CASE("unprojecting stops") {
  const auto how = support::stopped();
  CHECK_THROWS_AS((void)sample::unproject(flat(4, 2, 1), camera, {}, {.control = how}),
                  stopped_error);
  const std::vector<float> points(24, 1.0f);
  CHECK_THROWS_AS((void)sample::place_point_map(points, 4, 2, {}, {.control = how}), stopped_error);
}

}  // namespace test_unproject
