// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/cloud/crop.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

using namespace aib;

namespace test_crop {

namespace {

/// Points 0.5, 1.5 ... 3.5 on the diagonal of the plane z = 1, and one that is not finite.
cloud::cloud diagonal() {
  cloud::cloud c;
  c.origin = {100, 0, 0};
  for (int i = 0; i < 4; ++i) {
    const float x = static_cast<float>(i) + 0.5f;
    c.points.push_back({x, x, 1});
    c.labels.push_back(static_cast<std::uint32_t>(i));
  }
  c.points.push_back({std::numeric_limits<float>::quiet_NaN(), 1, 1});
  c.labels.push_back(9);
  return c;
}

using labels = std::vector<std::uint32_t>;

}  // namespace

TEST_CASE("a box keeps what lies in it or on its faces") {
  const cloud::box box{{101.5, 0, 0}, {103, 9, 1}};
  const cloud::cloud c = cloud::crop(diagonal(), box);
  CHECK(c.labels == labels{1, 2});
  CHECK(c.position(0) == Eigen::Vector3d(101.5, 1.5, 1));
}

TEST_CASE("an oriented box is turned about its centre") {
  Eigen::Matrix3d turned;  // 45 degrees about z: the box's x lies on the diagonal
  const double h = std::sqrt(0.5);
  turned << h, -h, 0, h, h, 0, 0, 0, 1;
  const cloud::oriented_box along{{102, 2, 1}, turned, {3, 0.01, 1}};
  CHECK(cloud::crop(diagonal(), along).labels == labels{1, 2});
  const cloud::oriented_box across{{102, 2, 1}, turned, {0.01, 9, 1}};
  CHECK(cloud::crop(diagonal(), across).empty());
}

TEST_CASE("a polygon volume keeps what its polygon surrounds, between two planes") {
  cloud::polygon_volume v{2, 0, 2, {{101, 0, 7}, {104, 0, 7}, {104, 3, 7}, {101, 3, 7}}};
  CHECK(cloud::crop(diagonal(), v).labels == labels{1, 2});
  v.low = 1.5;
  CHECK(cloud::crop(diagonal(), v).empty());
  // Seen along x: y in 1..4, z in 0..2, x in 100..103.
  const cloud::polygon_volume x{0, 100, 103, {{0, 1, 0}, {0, 4, 0}, {0, 4, 2}, {0, 1, 2}}};
  CHECK(cloud::crop(diagonal(), x).labels == labels{1, 2});
}

TEST_CASE("a concave polygon leaves its notch out") {
  const cloud::polygon_volume v{
      2, 0, 2, {{100, 0, 0}, {104, 0, 0}, {104, 4, 0}, {102, 1, 0}, {100, 4, 0}}};
  CHECK(cloud::crop(diagonal(), v).labels == labels{0, 1});
}

TEST_CASE("a half space leaves its plane out") {
  const cloud::cloud c{.points = {{0, 0, 1}, {0, 0, 2}, {0, 0, 3}}};
  CHECK(cloud::crop(c, cloud::half_space{{0, 0, 1, -2}}).size() == 1);
}

TEST_CASE("a grid has its cells around their centres, and nothing outside") {
  cloud::occupancy_grid grid{.low = {10, 0, 0}, .resolution = 2, .size = {2, 1, 2}};
  grid.cells = {0, 1, 0, 0};
  CHECK(grid.contains({10, 0, 2}));
  CHECK(grid.contains({9.1, 0.9, 2.9}));
  CHECK_FALSE(grid.contains({10, 0, 0}));
  CHECK_FALSE(grid.contains({10, 0, 4}));
  CHECK_FALSE(grid.contains({10, -2, 2}));
  CHECK_FALSE(grid.contains({12, 0, 2}));
  CHECK_FALSE(grid.contains({std::numeric_limits<double>::quiet_NaN(), 0, 2}));
}

}  // namespace test_crop
