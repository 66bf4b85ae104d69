// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/pose/kitti_odometry.hpp>
#include <aib/pose/sub_trajectory.hpp>

#include <doctest/doctest.h>

#include "synthetic.hpp"
#include <cmath>

using namespace aib;

namespace test_odometry {

namespace {

/// A straight drive along z, a frame a metre, whose estimate is `scale` times as long and turns by
/// `turn` radians a metre about y.
pose::trajectory drive(double scale, double turn) {
  pose::trajectory t;
  math::rigid3 pose;
  const math::rigid3 step{math::rotation_from(Eigen::Vector3d(0, turn, 0)), {0, 0, scale}};
  for (int i = 0; i < 1000; ++i) {
    t.world_from_camera.push_back(pose);
    pose = pose * step;
  }
  return t;
}

}  // namespace

TEST_CASE("a drive that is 2 % too long has a translation error of 2 %") {
  const auto r = pose::kitti_odometry(drive(1.02, 0), drive(1, 0));
  // A segment ends where it is longer than its length: 101 m for 100 m.
  CHECK(r.by_length[0].translation_percent == doctest::Approx(2 * 1.01));
  CHECK(r.all.rotation_deg_per_m == doctest::Approx(0));
  CHECK(r.lengths_m.size() == 8);
  CHECK(r.by_length[7].n == 20);  // starts 0, 10, .. 190
  CHECK(r.all.n == 90 + 80 + 70 + 60 + 50 + 40 + 30 + 20);
}

TEST_CASE("a turn of 1 degree in 100 m is 0.01 degrees a metre") {
  const auto r = pose::kitti_odometry(drive(1, math::radians(0.01)), drive(1, 0));
  CHECK(r.by_length[3].rotation_deg_per_m == doctest::Approx(0.01 * 401 / 400));
}

TEST_CASE("kitti_odometry keeps under rigid motions, and needs a path") {
  const math::sim3 moved{1, synthetic::some_sim3().rotation, {1, 2, 3}};
  const auto a = pose::kitti_odometry(drive(1.01, 1e-4), drive(1, 0));
  const auto b = pose::kitti_odometry(moved * drive(1.01, 1e-4), drive(1, 0));
  CHECK(a.all.translation_percent == doctest::Approx(b.all.translation_percent));
  const pose::trajectory shorter = synthetic::orbit();
  CHECK_THROWS_AS(pose::kitti_odometry(shorter, shorter), undefined_error);
  CHECK_THROWS_AS(pose::kitti_odometry({}, {}), undefined_error);
  CHECK_THROWS_AS(pose::kitti_odometry(shorter, shorter, {.lengths_m = {-1}}), argument_error);
}

TEST_CASE("sub-trajectories: length, percent, yaw and gravity") {
  // The world's z is the drive's z: turning about y is what gravity would tell.
  const auto r = pose::sub_trajectories(drive(1.02, math::radians(0.01)), drive(1, 0),
                                        {.lengths = {100, 5000}});
  REQUIRE(r.size() == 1);
  CHECK(r[0].length == 100);
  CHECK(r[0].translation.count == 920);  // from 80 m on one may be short of 20 %
  CHECK(r[0].rotation_deg.median == doctest::Approx(1));
  CHECK(r[0].rotation_deg_per_m.median == doctest::Approx(0.01));
  CHECK(r[0].gravity_deg.median == doctest::Approx(1));
  CHECK(r[0].yaw_deg.max < 1e-9);
  const auto straight = pose::sub_trajectories(drive(1.02, 0), drive(1, 0));
  REQUIRE(straight.size() == 5);
  CHECK(straight[0].translation_percent.median == doctest::Approx(2).epsilon(0.01));
  CHECK_THROWS_AS(pose::sub_trajectories({}, {}), undefined_error);
  const auto still = [] { return drive(0, 0); };
  CHECK_THROWS_AS(pose::sub_trajectories(still(), still()), undefined_error);
  CHECK_THROWS_AS(pose::sub_trajectories(still(), still(), {.lengths = {0}}), argument_error);
}

}  // namespace test_odometry
