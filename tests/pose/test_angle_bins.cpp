// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/core/random.hpp>
#include <aib/pose/angle_bins.hpp>
#include <aib/pose/frame_pairs.hpp>

#include <doctest/doctest.h>

#include "synthetic.hpp"
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

using namespace aib;

namespace test_angle_bins {

namespace {

/// Counts by the exact angle of every pair.
pose::joint_counts counted_one_by_one(const pose::frame_pairs& pairs,
                                      const pose::angle_bins& rotation,
                                      const pose::angle_bins& translation) {
  pose::joint_counts out(rotation, translation);
  std::vector<std::uint64_t> counts(out.places());
  for (std::size_t i = 0; i < pairs.frames(); ++i) {
    for (std::size_t j = i + 1; j < pairs.frames(); ++j) {
      const pose::pair_error e = pairs.error(i, j);
      ++counts[out.place(e.rotation_deg, e.translation_deg)];
    }
  }
  out.add(counts);
  return out;
}

bool equal(const pose::joint_counts& a, const pose::joint_counts& b) {
  for (std::size_t r = 1; r <= a.rotation().size(); ++r) {
    for (std::size_t c = 0; c < a.columns(); ++c) {
      if (a.sum(r, c, c + 1) != b.sum(r, c, c + 1)) return false;
    }
  }
  return true;
}

pose::frame_pairs pairs_of(const pose::trajectory& a, const pose::trajectory& b) {
  return pose::frame_pairs(a.world_from_camera, b.world_from_camera);
}

}  // namespace

TEST_CASE("an angle is in the bin of the edges that it reaches") {
  const pose::angle_bins bins({10, 5, 5});
  CHECK(bins.size() == 3);
  CHECK(bins.find(0) == 0);
  CHECK(bins.find(5) == 1);
  CHECK(bins.find(9.999) == 1);
  CHECK(bins.find(180) == 2);
  CHECK(bins.bins_below(10) == 2);
  CHECK_THROWS_AS((void)bins.bins_below(7), argument_error);
  CHECK_THROWS_AS(pose::angle_bins({0.0}), argument_error);
}

TEST_CASE("pairs counted without their angles are those counted by their angles") {
  const pose::trajectory reference = synthetic::orbit({.frames = 150, .turns = 3, .climb = 4});
  std::vector<double> edges;
  for (int k = 1; k <= 180; ++k) edges.push_back(k);
  const pose::angle_bins many(edges), few({0.001, 0.5, 0.5000001, 30, 89.99, 90, 90.01, 179.9});
  for (const double noise : {0.0, 0.01, 1.0, 30.0, 90.0}) {
    const pose::trajectory estimate =
        synthetic::noisy(reference, {.rotation_deg = noise, .position = noise / 50});
    const pose::frame_pairs pairs = pairs_of(estimate, reference);
    CHECK(equal(pairs.count(many, many), counted_one_by_one(pairs, many, many)));
    CHECK(equal(pairs.count(few, few), counted_one_by_one(pairs, few, few)));
  }
}

TEST_CASE("mirrored centres have opposite directions, and are counted so") {
  const pose::trajectory reference = synthetic::orbit();
  pose::trajectory estimate = reference;
  for (auto& pose : estimate.world_from_camera) pose.translation *= -1;
  const pose::joint_counts counts =
      pairs_of(estimate, reference).count(pose::angle_bins({1}), pose::angle_bins({1, 179}));
  CHECK(counts.sum(1, 2, 3) == counts.pairs());
}

TEST_CASE("counts do not depend on the number of threads") {
  const pose::trajectory reference = synthetic::orbit({.frames = 200, .turns = 5});
  const pose::frame_pairs pairs =
      pairs_of(synthetic::noisy(reference, {.rotation_deg = 10, .position = 0.3}), reference);
  const pose::angle_bins bins({1, 5, 10, 20, 30});
  CHECK(equal(pairs.count(bins, bins, 1), pairs.count(bins, bins, 3)));
}

TEST_CASE("many errors at once are those of each pair") {
  pose::trajectory reference = synthetic::orbit({.frames = 100, .turns = 2});
  reference.world_from_camera[70].translation = reference.world_from_camera[71].translation;
  for (const double noise : {0.0, 1e-7, 10.0, 90.0}) {
    const pose::trajectory estimate =
        synthetic::noisy(reference, {.rotation_deg = noise, .position = noise});
    const pose::frame_pairs pairs = pairs_of(estimate, reference);
    double worst = 0;
    std::size_t visited = 0;
    for (std::size_t i = 0; i < 100; ++i) {
      pairs.for_each_error(i, {3, 99}, [&](std::size_t j, double rotation, double translation) {
        if (j == i) return;
        ++visited;
        const pose::pair_error e = pairs.error(i, j);
        worst = std::max(worst, std::abs(rotation - e.rotation_deg));
        CHECK(std::isnan(translation) == !e.translation_deg);
        if (e.translation_deg) worst = std::max(worst, std::abs(translation - *e.translation_deg));
      });
    }
    CHECK(visited == 100 * 96 - 96);
    CHECK(worst < 1e-12);
  }
}

TEST_CASE("baselines of a billionth of the longest have no direction") {
  pose::trajectory reference = synthetic::orbit({.frames = 3});
  reference.world_from_camera[1].translation = reference.world_from_camera[0].translation;
  reference.world_from_camera[1].translation[0] += 2e-9;
  pose::trajectory estimate = synthetic::orbit({.frames = 3});
  CHECK(!pairs_of(estimate, reference).error(0, 1).translation_deg);
  reference.world_from_camera[1].translation[0] += 4e-9;
  CHECK(pairs_of(estimate, reference).error(0, 1).translation_deg);
}

TEST_CASE("map coordinates and tiny worlds keep their directions") {
  for (const double scale : {1e-200, 1e-9, 1e200}) {
    const pose::trajectory reference = synthetic::orbit();
    const math::sim3 moved{scale, Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero()};
    const pose::frame_pairs pairs = pairs_of(moved * reference, reference);
    const pose::angle_bins bins({0.001});
    const pose::joint_counts counts = pairs.count(bins, bins);
    CHECK(counts.sum(1, 0, 1) == counts.pairs());
  }
}

}  // namespace test_angle_bins
