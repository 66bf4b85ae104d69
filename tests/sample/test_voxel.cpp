// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/core/random.hpp>
#include <aib/sample/voxel.hpp>

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

using namespace aib;

namespace test_voxel {

namespace {

cloud::cloud four_points() {
  cloud::cloud c{
      .points = {{0.1f, 0.1f, 0.1f}, {0.5f, 0.1f, 0.1f}, {-0.5f, 0, 0}, {0.75f, 0.1f, 0.1f}}};
  c.labels = {1, 2, 3, 4};
  return c;
}

}  // namespace

TEST_CASE("a voxel becomes the mean, the centre, or a point") {
  const auto mean = sample::voxel(four_points(), {.size = 1});
  REQUIRE(mean.size() == 2);
  CHECK(mean.points[0] == Eigen::Vector3f(-0.5f, 0, 0));
  CHECK(mean.points[1].x() == doctest::Approx(0.45));
  CHECK(mean.labels == std::vector<std::uint32_t>{3, 2});
  const auto centre = sample::voxel(four_points(), {.size = 1, .pick = sample::voxel_pick::centre});
  CHECK(centre.points[0] == Eigen::Vector3f(-0.5f, 0.5f, 0.5f));
  CHECK(centre.points[1] == Eigen::Vector3f(0.5f, 0.5f, 0.5f));
  const auto nearest =
      sample::voxel(four_points(), {.size = 1, .pick = sample::voxel_pick::nearest});
  CHECK(nearest.points[1] == Eigen::Vector3f(0.5f, 0.1f, 0.1f));
}

TEST_CASE("the lattice of the world stays where it is when a stray point comes in") {
  random_engine random(1);
  cloud::cloud c;
  for (int i = 0; i < 5000; ++i) {
    const float x = static_cast<float>(random.uniform()), y = static_cast<float>(random.uniform());
    c.points.push_back({x, y, 0.01f});
  }
  const auto before = sample::voxel(c, {.size = 0.05});
  c.points.push_back({-7.77f, -3.33f, -1.11f});
  const auto after = sample::voxel(c, {.size = 0.05});
  REQUIRE(after.size() == before.size() + 1);
  CHECK(std::equal(before.points.begin(), before.points.end(), after.points.begin() + 1));
}

TEST_CASE("voxels of a cloud too wide for one sort are those of plain grouping") {
  random_engine random(2);
  cloud::cloud c;
  const auto place = [&] { return static_cast<float>(std::floor(random.uniform(-4, 4)) * 1e5); };
  for (int i = 0; i < 4000; ++i) c.points.emplace_back(place(), place(), place());
  c.points.emplace_back(0, std::numeric_limits<float>::infinity(), 0);
  const double size = 1e-3;
  std::map<std::array<double, 3>, Eigen::Vector3d> expected;  // z, y, x
  for (std::size_t i = 0; i + 1 < c.size(); ++i) {
    const Eigen::Vector3d p = c.position(i);
    const auto cell = [&](double x) { return std::floor(x / size); };
    expected[{cell(p.z()), cell(p.y()), cell(p.x())}] = p;
  }
  for (const unsigned threads : {1u, 3u}) {
    const auto found = sample::voxel(c, {.size = size, .threads = threads});
    REQUIRE(found.size() == expected.size());
    std::size_t i = 0;
    for (const auto& voxel : expected) CHECK(found.position(i++) == voxel.second);
  }
}

TEST_CASE("voxels: map coordinates, threads, nothing, and what is refused") {
  cloud::cloud c = four_points();
  c.origin = {458000, 5429000, 100};
  CHECK(sample::voxel(c, {.size = 1}).size() == 2);
  CHECK(sample::voxel(c, {.size = 1, .threads = 3}).points ==
        sample::voxel(c, {.size = 1, .threads = 1}).points);
  CHECK(sample::voxel({}, {.size = 1}).empty());
  c.points.push_back({std::numeric_limits<float>::quiet_NaN(), 0, 0});
  c.labels.push_back(5);
  CHECK(sample::voxel(c, {.size = 1}).size() == 2);
  CHECK_THROWS_AS(static_cast<void>(sample::voxel(c, {.size = 0})), argument_error);
  CHECK_THROWS_AS(static_cast<void>(sample::voxel(c, {.size = 1e-300})), argument_error);
}

}  // namespace test_voxel
