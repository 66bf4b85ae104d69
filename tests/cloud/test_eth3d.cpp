// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/cloud/eth3d.hpp>
#include <aib/core/random.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

using namespace aib;

namespace test_eth3d {

namespace {

/// A wall in the plane x = 4, seen from the origin.
cloud::laser_scan wall() {
  cloud::laser_scan scan{{}, {0, 0, 0}};
  for (int y = -20; y <= 20; ++y) {
    for (int z = -20; z <= 20; ++z) {
      scan.points.points.emplace_back(4.0f, 0.1f * static_cast<float>(y),
                                      0.1f * static_cast<float>(z));
    }
  }
  return scan;
}

cloud::verdict verdict_at(const Eigen::Vector3d& p) {
  const auto scan = wall();
  return cloud::scanned_space(scan, {.start_radius = 0.01}).of(p, std::vector{0.1, 0.5});
}

cloud::eth3d_result score(const cloud::cloud& reconstruction,
                          std::vector<double> tolerances,
                          cloud::eth3d_rule rule = cloud::eth3d_rule::official) {
  const std::vector scans{wall()};
  return cloud::eth3d(reconstruction, scans,
                      {.tolerances = std::move(tolerances),
                       .voxel = 0.05,
                       .beam = {.start_radius = 0.01},
                       .rule = rule});
}

}  // namespace

TEST_CASE("a beam tells what lies in it: on the surface, before it, behind it, beside it") {
  CHECK(verdict_at({3.95, 0, 0}).first_good == 0);
  CHECK(verdict_at({3.7, 0, 0}).first_good == 1);
  CHECK(verdict_at({3.7, 0, 0}).observed);
  CHECK(verdict_at({2, 0, 0}).first_good == 2);
  CHECK(verdict_at({2, 0, 0}).observed);
  CHECK(verdict_at({4.3, 0, 0}).first_good == 1);
  CHECK_FALSE(verdict_at({4.3, 0, 0}).observed);
  CHECK(verdict_at({5, 0, 0}).first_good == 2);
  CHECK_FALSE(verdict_at({5, 0, 0}).observed);
  CHECK_FALSE(verdict_at({2, 0.025, 0}).observed);  // between two beams
  CHECK_FALSE(verdict_at({-2, 0, 0}).observed);     // behind the scanner
  CHECK(verdict_at({0.001, 0, 0}).observed);        // within every beam's start
  CHECK_FALSE(verdict_at({1e-3, 0, 3}).observed);   // above what was scanned
}

TEST_CASE("points behind surfaces are ignored, points in free space are not") {
  cloud::cloud on_wall = wall().points;
  const auto perfect = score(on_wall, {0.1});
  CHECK(perfect.scores[0].completeness == 1);
  CHECK(perfect.scores[0].accuracy == 1);
  CHECK(perfect.scores[0].f_score == 1);
  cloud::cloud with_hidden = on_wall;
  with_hidden.points.emplace_back(6.0f, 0.0f, 0.0f);
  CHECK(score(with_hidden, {0.1}).scores[0].accuracy == 1);
  CHECK(score(with_hidden, {0.1}).n_unobserved[0] == 1);
  cloud::cloud with_ghost = on_wall;
  with_ghost.points.emplace_back(2.0f, 0.0f, 0.0f);
  const double n_voxels = 2.0 * static_cast<double>(on_wall.size()) + 2;
  CHECK(*score(with_ghost, {0.1}).scores[0].accuracy == doctest::Approx(1 - 2 / n_voxels));
}

TEST_CASE("a voxel counts once, however many points lie in it") {
  cloud::cloud half = cloud::select_where(
      wall().points, [](std::size_t i) { return wall().points.points[i].y() < -0.05f; });
  const double sparse = score(half, {0.01}).scores[0].completeness;
  CHECK(sparse == doctest::Approx(20.0 / 41));
  for (int i = 0; i < 5000; ++i) half.points.push_back(half.points[0]);
  CHECK(score(half, {0.01}).scores[0].completeness == sparse);
  CHECK(score(half, {0.01}).scores[0].accuracy == 1);
}

TEST_CASE("the tool's own edge: within a tolerance, but strictly below the largest") {
  cloud::cloud shifted = wall().points;
  for (auto& p : shifted.points) p.x() += 0.125f;
  using enum cloud::eth3d_rule;
  CHECK(score(shifted, {0.0625, 0.125}).scores[1].completeness == 0);
  CHECK(score(shifted, {0.0625, 0.125, 0.2}).scores[1].completeness == 1);
  CHECK(score(shifted, {0.0625, 0.125}, within).scores[1].completeness == 1);
  CHECK(score(shifted, {0.0625, 0.125, 0.2}, below).scores[1].completeness == 0);
}

TEST_CASE("where nothing was observed there is no accuracy") {
  const cloud::cloud hidden{.points = {{8, 0, 0}}};
  const auto r = score(hidden, {0.1});
  CHECK_FALSE(r.scores[0].accuracy.has_value());
  CHECK_FALSE(r.scores[0].f_score.has_value());
  CHECK(r.scores[0].completeness == 0);
  CHECK_THROWS_AS(score(cloud::cloud{}, {0.1}), undefined_error);
  CHECK_THROWS_AS(score(hidden, {}), argument_error);
  CHECK_THROWS_AS(score(hidden, {0.0}), argument_error);
}

}  // namespace test_eth3d
