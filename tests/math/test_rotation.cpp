// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/core/random.hpp>
#include <aib/math/nearest_rotation.hpp>
#include <aib/math/rotation.hpp>

#include <doctest/doctest.h>

#include <limits>

using namespace aib;
using namespace aib::math;

namespace test_rotation {

namespace {

Eigen::Vector3d some_vector(random_engine& engine) {
  return {engine.normal(), engine.normal(), engine.normal()};
}

}  // namespace

TEST_CASE("quaternion and axis-angle give the same rotation and come back") {
  random_engine engine(1);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d axis = some_vector(engine).normalized();
    const double angle = engine.uniform(0, std::numbers::pi - 1e-6);
    const Eigen::Matrix3d r = rotation_from(Eigen::Vector3d(axis * angle));
    CHECK((rotation_from(quaternion_from(r)) - r).norm() < 1e-14);
    CHECK((axis_angle_from(r) - axis * angle).norm() < 1e-9);
    CHECK(rotation_angle(r) == doctest::Approx(angle).epsilon(1e-12));
  }
}

TEST_CASE("a small angle keeps its digits") {
  const Eigen::Matrix3d r = rotation_from(Eigen::Vector3d(1e-9, 0, 0));
  CHECK(rotation_angle(r) == doctest::Approx(1e-9).epsilon(1e-9));
}

TEST_CASE("the length and the sign of a quaternion do not matter") {
  const quaternion q{0.5, -0.5, 0.5, 0.5};
  const quaternion scaled{-1.5, 1.5, -1.5, -1.5};
  CHECK((rotation_from(q) - rotation_from(scaled)).norm() < 1e-15);
}

TEST_CASE("a quaternion without a direction is refused") {
  CHECK_THROWS_WITH_AS(rotation_from(quaternion{0, 0, 0, 0}),
                       "math::rotation_from: quaternion (0, 0, 0, 0) has no direction",
                       argument_error);
  CHECK_THROWS_AS(rotation_from(quaternion{std::numeric_limits<double>::quiet_NaN(), 0, 0, 0}),
                  argument_error);
}

TEST_CASE("the nearest rotation of a rounded rotation is close, of a mirror there is none") {
  const Eigen::Matrix3d r = rotation_from(Eigen::Vector3d(0.3, -0.2, 0.9));
  Eigen::Matrix3d rounded = (r * 1e6).array().round() / 1e6;
  const auto near = nearest_rotation(rounded);
  REQUIRE(near);
  CHECK(near->residual < 2e-6);
  CHECK((near->rotation.transpose() * near->rotation - Eigen::Matrix3d::Identity()).norm() < 1e-14);
  CHECK(!nearest_rotation(-r));
  rounded(0, 0) = std::numeric_limits<double>::infinity();
  CHECK(!nearest_rotation(rounded));
}

}  // namespace test_rotation
