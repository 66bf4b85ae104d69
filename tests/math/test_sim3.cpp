// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/math/sim3.hpp>

#include <doctest/doctest.h>

using namespace aib::math;

namespace test_sim3 {

namespace {

const sim3 b_from_a{2.5, rotation_from(Eigen::Vector3d(0.3, -0.2, 0.9)), {1, -2, 3}};
const sim3 c_from_b{0.4, rotation_from(Eigen::Vector3d(-1, 0.1, 0.2)), {0, 5, 1}};
const Eigen::Vector3d p_in_a(7, 8, -9);

}  // namespace

TEST_CASE("transforms compose as their matrices do") {
  CHECK(((c_from_b * b_from_a).matrix() - c_from_b.matrix() * b_from_a.matrix()).norm() < 1e-13);
  CHECK(((c_from_b * b_from_a) * p_in_a - c_from_b * (b_from_a * p_in_a)).norm() < 1e-13);
}

TEST_CASE("a transform times its inverse is the identity") {
  CHECK(((b_from_a * b_from_a.inverse()).matrix() - Eigen::Matrix4d::Identity()).norm() < 1e-14);
  const rigid3 pose{b_from_a.rotation, b_from_a.translation};
  CHECK(((pose.inverse() * pose).matrix() - Eigen::Matrix4d::Identity()).norm() < 1e-14);
}

TEST_CASE("a similarity moves a pose's position as a point and turns its axes") {
  const rigid3 pose{rotation_from(Eigen::Vector3d(0, 1, 0)), p_in_a};
  const rigid3 moved = b_from_a * pose;
  CHECK((moved.translation - b_from_a * p_in_a).norm() < 1e-13);
  CHECK((moved.rotation - b_from_a.rotation * pose.rotation).norm() < 1e-15);
}

}  // namespace test_sim3
