// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/io/kitti.hpp>

#include <doctest/doctest.h>

#include <string>
#include <support/scratch.hpp>

using namespace aib;

namespace test_kitti {

namespace {

const support::scratch scratch;

std::string error_of(const std::string& text) {
  try {
    static_cast<void>(io::read_kitti(scratch.file("poses.txt", text)));
  } catch (const format_error& e) {
    return std::string(e.what()).substr(scratch.folder().string().size() + 1);
  }
  return "no error";
}

}  // namespace

TEST_CASE("a KITTI line is the matrix [R | t] by rows") {
  // A turn by 90 degrees about z, at (1, 2, 3).
  const auto t = io::read_kitti(scratch.file("poses.txt", "0 -1 0 1 1 0 0 2 0 0 1 3\r\n"));
  REQUIRE(t.size() == 1);
  CHECK(t.names.empty());
  CHECK(t.stamps_s.empty());
  CHECK(t.world_from_camera[0].rotation.col(0) == Eigen::Vector3d::UnitY());
  CHECK(t.world_from_camera[0].translation == Eigen::Vector3d(1, 2, 3));
}

TEST_CASE("a wrong KITTI file is refused with its line") {
  CHECK(error_of("1 0 0 0 0 1 0 0 0 0 1\n") ==
        "poses.txt:1: kitti: 12 numbers (3 x 4 matrix by rows) expected, found 11");
  CHECK(error_of("1 0 0 0 0 1 0 0 0 0 1 0\n2 0 0 0 0 1 0 0 0 0 1 0\n") ==
        "poses.txt:2: kitti: the rotation part lies 1 from a rotation, at most 0.01 expected");
  CHECK(error_of("1 0 0 0 0 1 0 0 0 0 -1 0\n") ==
        "poses.txt:1: kitti: the rotation part has determinant -1, 1 expected");
}

TEST_CASE("a lost frame keeps its place") {
  const auto t = io::read_kitti(
      scratch.file("poses.txt", "-inf -inf -inf -inf 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 0\n"));
  CHECK_FALSE(t.world_from_camera[0].is_finite());
  CHECK(t.world_from_camera[1].is_finite());
  CHECK(t.warnings == std::vector<std::string>{"1 of 2 poses are not finite: not registered"});
}

TEST_CASE("poses come back from a KITTI file") {
  pose::trajectory t;
  t.world_from_camera = {{math::rotation_from(Eigen::Vector3d(0.1, 0.2, 0.3)), {1, 2, 1.0 / 3}}};
  const auto path = scratch.folder() / "out.txt";
  io::write_kitti(path, t);
  const auto back = io::read_kitti(path);
  CHECK(back.world_from_camera[0].translation == t.world_from_camera[0].translation);
  CHECK(
      (back.world_from_camera[0].rotation - t.world_from_camera[0].rotation).cwiseAbs().maxCoeff() <
      1e-15);
  t.world_from_camera.push_back(io::unregistered_pose());
  CHECK_THROWS_WITH_AS(io::write_kitti(path, t),
                       "write_kitti: pose 1 is not registered, which the format cannot say",
                       argument_error);
  CHECK_THROWS_WITH_AS(io::write_kitti(path, {}), "write_kitti: no pose to write", argument_error);
}

TEST_CASE("lines of 16 numbers are 4 x 4 matrices") {
  const auto t =
      io::read_matrix_lines(scratch.file("camera_poses.txt", "1 0 0 4 0 1 0 5 0 0 1 6 0 0 0 1\n"));
  CHECK(t.world_from_camera[0].translation == Eigen::Vector3d(4, 5, 6));
  CHECK_THROWS_WITH_AS(
      io::read_matrix_lines(scratch.file("camera_poses.txt", "1 2 3\n")),
      doctest::Contains(
          "camera_poses.txt:1: matrix lines: 16 numbers (4 x 4 matrix by rows) expected, found 3"),
      format_error);
}

}  // namespace test_kitti
