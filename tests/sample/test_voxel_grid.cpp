// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/core/random.hpp>
#include <aib/sample/voxel_grid.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace aib;

namespace test_voxel_grid {

namespace {

cloud::cloud noise(std::size_t n, std::uint64_t seed, const Eigen::Vector3d& origin) {
  random_engine random(seed);
  cloud::cloud c;
  c.origin = origin;
  for (std::size_t i = 0; i < n; ++i) {
    c.points.emplace_back(static_cast<float>(random.uniform(-1, 1)),
                          static_cast<float>(random.uniform(-1, 1)),
                          static_cast<float>(random.uniform(-1, 1)));
    c.colors.push_back({static_cast<std::uint8_t>(i % 256), 10, 255});
  }
  return c;
}

}  // namespace

TEST_CASE("clouds added one by one are the voxels of all of them") {
  for (const Eigen::Vector3d& origin : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(4e5, 5e6, 100)}) {
    const cloud::cloud first = noise(3000, 1, origin), second = noise(2000, 2, origin);
    cloud::cloud all = first;
    all.points.insert(all.points.end(), second.points.begin(), second.points.end());
    all.colors.insert(all.colors.end(), second.colors.begin(), second.colors.end());
    const auto expected = sample::voxel(all, {.size = 0.25});
    sample::voxel_grid grid({.size = 0.25});
    grid.add(first);
    grid.add(second);
    grid.add(cloud::cloud());
    CHECK(grid.n_points() == 5000);
    const auto found = grid.result();
    REQUIRE(found.size() == expected.size());
    CHECK(found.size() == grid.size());
    CHECK(found.colors.size() == found.size());
    CHECK(found.colors[0][1] == 10);
    for (std::size_t i = 0; i < found.size(); ++i)
      CHECK((found.position(i) - expected.position(i)).norm() < 1e-6);
  }
}

TEST_CASE("a voxel grid is the same for any number of threads, and leaves out what is not finite") {
  cloud::cloud c = noise(20000, 3, Eigen::Vector3d::Zero());
  c.points[7].x() = std::numeric_limits<float>::quiet_NaN();
  sample::voxel_grid one({.size = 0.1, .threads = 1}), three({.size = 0.1, .threads = 3});
  for (sample::voxel_grid* grid : {&one, &three}) {
    grid->add(c);
    grid->add(c);
  }
  CHECK(one.n_points() == 2 * 19999);
  CHECK(one.result().points == three.result().points);
  CHECK_THROWS_AS(sample::voxel_grid({.size = 0}), argument_error);
}

TEST_CASE("a cloud without colours leaves the grid without") {
  cloud::cloud colored = noise(10, 4, Eigen::Vector3d::Zero()), plain = colored;
  plain.colors.clear();
  sample::voxel_grid grid({.size = 1});
  grid.add(colored);
  CHECK_FALSE(grid.result().colors.empty());
  grid.add(plain);
  CHECK(grid.result().colors.empty());
}

}  // namespace test_voxel_grid
