// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/depth/planes.hpp>
#include <aib/depth/risk_coverage.hpp>
#include <aib/depth/surface_errors.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

using namespace aib;
using doctest::Approx;

namespace test_surface {

namespace {

constexpr std::size_t width = 64, height = 48;
constexpr double focal = 80;  ///< pixels of the photo, which is twice as large as the maps

math::camera photo() { return math::pinhole(2 * width, 2 * height, focal, focal, width, height); }

/// A plane whose normal is turned by `slant` about the y axis, `distance` from the camera.
raster::image<float> plane(double slant, double distance, const math::camera& camera = photo()) {
  const auto rays = depth::rays(camera, width, height);
  const Eigen::Vector3d normal(std::sin(slant), 0, std::cos(slant));
  raster::image<float> map(width, height);
  for (std::size_t i = 0; i < map.size(); ++i)
    map.data()[i] = static_cast<float>(distance / normal.dot(depth::point_at(rays.data()[i], 1)));
  return map;
}

template <class T>
raster::view<const T> view(const raster::image<T>& image) {
  return image.view();
}

}  // namespace

TEST_CASE("rays go through pixel centres, scaled to the size of the photo") {
  const auto rays = depth::rays(photo(), width, height);
  CHECK(rays(0, 0).x() == Approx((1 - 64.0) / focal));
  CHECK(rays(width - 1, height - 1).y() == Approx((95 - 48.0) / focal));
}

TEST_CASE("normals of a plane are its own, towards the camera, and end at its border") {
  const auto map = plane(0.5, 4);
  const auto normals = depth::normals(view(map), depth::rays(photo(), width, height));
  CHECK(normals(0, 5).isZero(0));
  CHECK(normals(20, 20).z() == Approx(-std::cos(0.5)).epsilon(1e-4));
  CHECK(normals(20, 20).x() == Approx(-std::sin(0.5)).epsilon(1e-4));
}

TEST_CASE("a jump of the depth and a hole have no normal") {
  auto map = plane(0, 4);
  map(10, 10) = 5;
  map(30, 30) = 0;
  const auto normals = depth::normals(view(map), depth::rays(photo(), width, height));
  for (const auto& [x, y] : {std::pair{10, 10}, {11, 10}, {10, 9}, {30, 30}, {30, 31}})
    CHECK(normals(static_cast<std::size_t>(x), static_cast<std::size_t>(y)).isZero(0));
  CHECK_FALSE(normals(11, 11).isZero(0));
}

TEST_CASE("normal errors of a turned plane are the angle between both, whatever the scale") {
  const auto reference = plane(0.2, 4), estimate = plane(0.5, 7);
  const auto rays = depth::rays(photo(), width, height);
  const auto e = depth::normal_errors(view(estimate), view(reference), rays, {.tau = {0.29, 0.31}});
  CHECK(e.mean == Approx(0.3).epsilon(1e-3));
  CHECK(e.median == Approx(0.3).epsilon(1e-3));
  CHECK(e.below == std::vector<double>{0, 1});
  CHECK(e.n_valid == (width - 2) * (height - 2));
  const raster::image<float> empty(width, height);
  CHECK_THROWS_AS((void)depth::normal_errors(view(empty), view(reference), rays), undefined_error);
  CHECK_THROWS_AS((void)depth::normals(view(reference), depth::rays(photo(), 3, 3)),
                  argument_error);
}

TEST_CASE("the distance of a parallel plane is its offset, at any slant") {
  for (const double slant : {0.0, 0.6}) {
    const auto reference = plane(slant, 4), estimate = plane(slant, 4.05);
    const auto e = depth::surface_errors(view(estimate), view(reference), photo());
    CHECK(e.n_without_normal == 2 * (width + height) - 4);
    CHECK(e.distance.median == Approx(0.05).epsilon(1e-3));
    const auto ray = depth::surface_errors(view(estimate), view(reference), photo(),
                                           {.distance = depth::surface_distance::ray});
    CHECK(ray.distance.mean > e.distance.mean);
    CHECK(ray.n_without_normal == 0);
  }
}

TEST_CASE(
    "ground sampling distance is the photo's, and shares are of pixels and of the reference") {
  raster::image<float> reference(width, height, 8), estimate(width, height, 8.15f);
  for (std::size_t x = 0; x < width; ++x) estimate(x, 3) = 0;
  for (std::size_t x = 0; x < width; ++x) estimate(x, 5) = 8.45f;
  raster::image<std::uint8_t> inner(width, height);  // where the reference has normals
  for (std::size_t y = 1; y + 1 < height; ++y)
    for (std::size_t x = 1; x + 1 < width; ++x) inner(x, y) = 1;
  const auto e = depth::surface_errors(view(estimate), view(reference), photo(),
                                       {.tau = {1, 2, 5}, .mask = inner});
  CHECK(e.mean_gsd == Approx(0.1));
  CHECK(e.gsd.median == Approx(1.5).epsilon(1e-5));
  CHECK(e.coverage == Approx(45.0 / 46));
  CHECK(e.within[0] == 0);
  CHECK(e.within[1] == Approx(44.0 / 45));
  CHECK(e.within_total[1] == Approx(44.0 / 46));
  CHECK(e.within[2] == 1);
  const auto scaled = depth::surface_errors(view(estimate), view(reference), photo(),
                                            {.transform = {.scale = 8 / 8.15}});
  CHECK(scaled.distance.median == Approx(0).epsilon(1e-6));
  const raster::image<float> empty(width, height);
  CHECK_THROWS_AS((void)depth::surface_errors(view(empty), view(reference), photo()),
                  undefined_error);
}

TEST_CASE("a camera without a focal length has no ground sampling distance") {
  const auto map = plane(0, 4);
  for (const double f : {0.0, -80.0, std::nan("")}) {
    const math::camera camera = math::pinhole(width, height, f, f, 32, 24);
    CHECK_THROWS_AS(depth::surface_errors(view(map), view(map), camera), argument_error);
  }
}

TEST_CASE("plane errors: a wall that is turned, moved and wavy; what is no plane is left out") {
  const auto reference = plane(0.2, 4);
  auto estimate = plane(0.3, 4);
  raster::image<std::uint16_t> labels(width, height, 7);
  for (std::size_t x = 0; x < width; ++x) labels(x, 0) = 0;
  labels(3, 0) = labels(4, 0) = 9;
  const auto rays = depth::rays(photo(), width, height);
  auto found = depth::plane_errors(view(estimate), view(reference), rays, view(labels));
  REQUIRE(found.size() == 1);
  CHECK(found.at(7).orientation == Approx(0.1).epsilon(1e-4));
  CHECK(found.at(7).flatness < 1e-5);
  CHECK(found.at(7).n_valid == width * (height - 1));
  estimate = plane(0.2, 4.5);
  found = depth::plane_errors(view(estimate), view(reference), rays, view(labels));
  CHECK(found.at(7).offset == Approx(0.5).epsilon(1e-4));
  CHECK(found.at(7).orientation < 1e-4);
  for (std::size_t i = 0; i < estimate.size(); ++i) estimate.data()[i] += i % 2 ? 0.01f : -0.01f;
  found = depth::plane_errors(view(estimate), view(reference), rays, view(labels));
  CHECK(found.at(7).flatness == Approx(0.0098).epsilon(0.05));
  CHECK(found.at(7).reference_flatness < 1e-5);
}

TEST_CASE("plane errors: a row of pixels is no plane, though rounded depths span one") {
  const math::camera far = math::pinhole(width, height, 4000, 4000, 32, 24);
  const auto reference = plane(0.3, 10, far);
  const auto estimate = plane(0.3, 11, far);
  raster::image<std::uint16_t> labels(width, height, 0);
  for (std::size_t x = 0; x < width; ++x) labels(x, height / 2) = 1;
  for (std::size_t y = 0; y < height; ++y) labels(y, y) = 2;
  const auto rays = depth::rays(far, width, height);
  CHECK(depth::plane_errors(view(estimate), view(reference), rays, view(labels)).empty());
}

TEST_CASE("risk and coverage: a confidence that knows, one that does not, one that misleads") {
  raster::image<float> reference(100, 1, 1), estimate(100, 1), right(100, 1), wrong(100, 1);
  for (std::size_t i = 0; i < 100; ++i) {
    estimate(i, 0) = 1 + static_cast<float>(i) / 128;
    right(i, 0) = -static_cast<float>(i);
    wrong(i, 0) = static_cast<float>(i);
  }
  const raster::image<float> same(100, 1, 3);
  const auto curve = [&](const raster::image<float>& confidence) {
    return depth::risk_coverage(view(estimate), view(reference), view(confidence));
  };
  CHECK(curve(right).ause == Approx(0));
  CHECK(curve(right).risk[9] == Approx(4.5 / 128));
  CHECK(curve(same).risk[9] == Approx(49.5 / 128));
  // Mean of 1 - k / 100 ... over the curves: the oracle's risk at k pixels is (k - 1) / 2.
  double expected = 0;
  for (int k = 1; k <= 100; ++k) expected += (49.5 - (k - 1) / 2.0) / 49.5 / 100;
  CHECK(curve(same).ause == Approx(expected));
  CHECK(curve(wrong).ause == Approx(2 * expected));
  CHECK(curve(wrong).coverage.back() == 1);
  CHECK(curve(wrong).risk.back() == Approx(49.5 / 128));
}

TEST_CASE("risk and coverage: pixels without a confidence come last; a perfect map has no ause") {
  const raster::image<float> reference(2, 1, 1);
  raster::image<float> estimate(2, 1, 1), confidence(2, 1, 5);
  estimate(1, 0) = 2;
  confidence(1, 0) = std::nanf("");
  auto curve =
      depth::risk_coverage(view(estimate), view(reference), view(confidence), {.steps = 2});
  CHECK(curve.risk == std::vector<double>{0, 0.5});
  CHECK(curve.n_unsure == 1);
  curve = depth::risk_coverage(view(reference), view(reference), view(confidence));
  CHECK(curve.ause == 0);
  const raster::image<float> empty(2, 1);
  CHECK_THROWS_AS((void)depth::risk_coverage(view(empty), view(reference), view(confidence)),
                  undefined_error);
}

}  // namespace test_surface
