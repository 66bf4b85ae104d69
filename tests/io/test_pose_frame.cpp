// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/io/pose_frame.hpp>

#include <doctest/doctest.h>

#include <limits>
#include <support/pose_distance.hpp>

using namespace aib;
using namespace aib::io;
using support::distance;

namespace test_pose_frame {

namespace {

constexpr pose_frame camera_from_world{pose_convention::camera_from_world, camera_axes::opencv};
constexpr pose_frame opengl{pose_convention::world_from_camera, camera_axes::opengl};

const math::rigid3 world_from_camera{math::rotation_from(Eigen::Vector3d(0.3, -0.7, 1.1)),
                                     {4, -5, 6}};

pose_matrix upper(const math::rigid3& pose) { return pose.matrix().topRows<3>(); }

}  // namespace

TEST_CASE("a matrix is read in the frame that it is written in") {
  CHECK(distance(pose_from_matrix(upper(world_from_camera)), world_from_camera) < 1e-14);
  CHECK(distance(pose_from_matrix(upper(world_from_camera.inverse()), camera_from_world),
                 world_from_camera) < 1e-14);
}

TEST_CASE("OpenGL's camera looks along -z with y up, OpenCV's along z with y down") {
  const math::rigid3 pose = pose_from_matrix(upper(world_from_camera), opengl);
  CHECK((pose.rotation.col(0) - world_from_camera.rotation.col(0)).norm() < 1e-14);
  CHECK((pose.rotation.col(1) + world_from_camera.rotation.col(1)).norm() < 1e-14);
  CHECK((pose.rotation.col(2) + world_from_camera.rotation.col(2)).norm() < 1e-14);
  CHECK(pose.translation == world_from_camera.translation);
}

TEST_CASE("a pose comes back from every frame") {
  for (const auto convention :
       {pose_convention::world_from_camera, pose_convention::camera_from_world}) {
    for (const auto axes : {camera_axes::opencv, camera_axes::opengl}) {
      const pose_frame frame{convention, axes};
      const math::rigid3 written = pose_in_frame(world_from_camera, frame);
      CHECK(distance(pose_from_matrix(upper(written), frame), world_from_camera) < 1e-14);
      CHECK(distance(pose_from_quaternion(math::quaternion_from(written.rotation),
                                          written.translation, frame),
                     world_from_camera) < 1e-14);
    }
  }
}

TEST_CASE("the centre is that of the matrix as written, the rotation the nearest one") {
  // A = 1.001 I: the nearest rotation is I, the centre -A^T t = -1.001 t.
  pose_matrix matrix = pose_matrix::Zero();
  matrix.leftCols<3>() = 1.001 * Eigen::Matrix3d::Identity();
  matrix.col(3) << 1, 2, 3;
  const math::rigid3 pose = pose_from_matrix(matrix, camera_from_world);
  CHECK((pose.rotation - Eigen::Matrix3d::Identity()).norm() < 1e-15);
  CHECK((pose.translation + 1.001 * Eigen::Vector3d(1, 2, 3)).norm() < 1e-15);
}

TEST_CASE("a matrix that is no rotation is refused beyond a residual of 0.01") {
  // s I lies sqrt(3) |s - 1| from I.
  pose_matrix matrix = pose_matrix::Identity();
  matrix.leftCols<3>() *= 1.0057;
  CHECK(pose_from_matrix(matrix).is_finite());
  matrix.leftCols<3>() = 2 * Eigen::Matrix3d::Identity();
  CHECK_THROWS_WITH_AS(
      pose_from_matrix(matrix),
      "the rotation part lies 1.7320508075688772 from a rotation, at most 0.01 expected",
      argument_error);
  matrix = pose_matrix::Identity();
  matrix(2, 2) = -1;
  CHECK_THROWS_WITH_AS(pose_from_matrix(matrix), "the rotation part has determinant -1, 1 expected",
                       argument_error);
}

TEST_CASE("numbers that are not finite make a pose that is not registered") {
  pose_matrix matrix = pose_matrix::Identity();
  matrix(0, 3) = -std::numeric_limits<double>::infinity();
  CHECK_FALSE(pose_from_matrix(matrix).is_finite());
  CHECK_FALSE(pose_from_quaternion({1, 0, 0, 0}, {0, 0, std::nan("")}).is_finite());
  CHECK_FALSE(pose_from_quaternion({std::nan(""), 0, 0, 0}, {0, 0, 0}).is_finite());
}

TEST_CASE("a quaternion of any length is normalised, zero refused") {
  const math::rigid3 pose = pose_from_quaternion({3, 0, 0, 3}, {0, 0, 0});  // 90 degrees about z
  CHECK((pose.rotation * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm() < 1e-15);
  CHECK_THROWS_WITH_AS(pose_from_quaternion({0, 0, 0, 0}, {0, 0, 0}), "the quaternion is zero",
                       argument_error);
}

}  // namespace test_pose_frame
