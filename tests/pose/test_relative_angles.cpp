// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/math/rotation.hpp>
#include <aib/pose/pair_histogram.hpp>
#include <aib/pose/relative_angles.hpp>

#include <doctest/doctest.h>

#include "synthetic.hpp"
#include <limits>

using namespace aib;

namespace test_relative_angles {

TEST_CASE("one frame turned by 10 degrees spoils its own pairs alone") {
  const pose::trajectory reference = synthetic::orbit({.frames = 5});
  pose::trajectory estimate = reference;
  estimate.world_from_camera[4].rotation *= math::rotation_from(Eigen::Vector3d(0, 0, 0.17453));
  const auto r = pose::relative_angles(estimate, reference, {.tau_deg = {5, 15}});
  CHECK(r.n_pairs == 10);
  CHECK(r.rra[0] == doctest::Approx(0.6));  // 6 of 10 pairs are without frame 4
  CHECK(r.rra[1] == 1);
  CHECK(r.rta[0] == 1);  // directions are those seen from the first camera of a pair
}

TEST_CASE("a pose that is not finite is not registered") {
  const pose::trajectory reference = synthetic::orbit({.frames = 5});
  pose::trajectory estimate = reference;
  estimate.world_from_camera[2].translation[1] = std::numeric_limits<double>::quiet_NaN();
  const auto r = pose::relative_angles(estimate, reference);
  CHECK(r.n_pairs == 6);
  CHECK(r.n_unregistered == 1);
}

TEST_CASE("in one place there are rotations but no directions") {
  pose::trajectory reference = synthetic::orbit();
  for (auto& pose : reference.world_from_camera) pose.translation.setConstant(3);
  const auto r = pose::relative_angles(reference, reference);
  CHECK(r.n_zero_baseline == r.n_pairs);
  CHECK(r.rra[0] == 1);
  CHECK(r.rta[2] == 0);
}

TEST_CASE("what has no pairs is undefined, what is not associated refused") {
  const pose::trajectory one = synthetic::orbit({.frames = 1});
  CHECK_THROWS_WITH_AS(pose::relative_angles(one, one),
                       "relative_angles: 2 registered frames expected, found 1 of 1",
                       undefined_error);
  CHECK_THROWS_AS(pose::relative_angles({}, {}), undefined_error);
  pose::trajectory other = synthetic::orbit({.frames = 2});
  CHECK_THROWS_WITH_AS(pose::relative_angles(one, other),
                       "relative_angles: 1 estimated and 2 reference poses; associate them first",
                       argument_error);
  pose::trajectory renamed = other;
  renamed.names[1] = "x.png";
  CHECK_THROWS_AS(pose::relative_angles(renamed, other), argument_error);
  CHECK_THROWS_AS(pose::relative_angles(other, other, {.tau_deg = {0}}), argument_error);
}

TEST_CASE("the joint histogram of all pairs holds every rra and rta") {
  const pose::trajectory reference = synthetic::orbit({.frames = 60});
  pose::trajectory estimate = synthetic::noisy(reference, {.rotation_deg = 8, .position = 0.1});
  estimate.world_from_camera[3].translation = estimate.world_from_camera[4].translation;
  const auto h = pose::pair_histogram(estimate, reference,
                                      {.rotation_deg = {15, 5, 5}, .translation_deg = {10, 90}});
  CHECK(h.rotation_deg == std::vector<double>{5, 15});
  REQUIRE(h.counts.size() == 3);
  REQUIRE(h.counts[0].size() == 3);
  CHECK(h.n_zero_baseline == 1);
  std::uint64_t sum = 0, below_15 = 0, towards_10 = 0;
  for (std::size_t r = 0; r < 3; ++r) {
    for (const std::uint64_t n : h.counts[r]) {
      sum += n;
      below_15 += r < 2 ? n : 0;
    }
    sum += h.without_direction[r];
    below_15 += r < 2 ? h.without_direction[r] : 0;
    towards_10 += h.counts[r][0];
  }
  CHECK(sum == h.n_pairs);
  const auto angles = pose::relative_angles(estimate, reference, {.tau_deg = {10, 15}});
  const auto n = static_cast<double>(h.n_pairs);
  CHECK(static_cast<double>(below_15) / n == angles.rra[1]);
  CHECK(static_cast<double>(towards_10) / n == angles.rta[0]);
  CHECK_THROWS_AS(pose::pair_histogram(estimate, reference, {.rotation_deg = {0}}), argument_error);
}

TEST_CASE("rra does not change with the order of the frames") {
  const pose::trajectory reference = synthetic::orbit({.frames = 40});
  const pose::trajectory estimate =
      synthetic::noisy(reference, {.rotation_deg = 8, .position = 0.1});
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < 40; ++i) order.push_back(i * 7 % 40);
  CHECK(pose::relative_angles(estimate, reference).rra ==
        pose::relative_angles(select(estimate, order), select(reference, order)).rra);
}

}  // namespace test_relative_angles
