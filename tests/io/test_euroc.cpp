// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/io/euroc.hpp>

#include <doctest/doctest.h>

#include <string>
#include <support/scratch.hpp>

using namespace aib;

namespace test_euroc {

namespace {

const support::scratch scratch;

pose::trajectory read(const std::string& text) {
  return io::read_euroc(scratch.file("data.csv", text));
}

}  // namespace

TEST_CASE("a EuRoC line is a stamp in nanoseconds, position, quaternion with w first, and more") {
  const auto t = read(
      "#timestamp [ns], p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], ...\n"
      "1403636580838555648,1,2,3,0.7071067811865476,0,0,0.7071067811865476,9,9,9,9,9,9,9,9,9\n");
  REQUIRE(t.size() == 1);
  CHECK(t.stamps_s[0] == 1403636580.838555648);
  CHECK(t.world_from_camera[0].translation == Eigen::Vector3d(1, 2, 3));
  CHECK((t.world_from_camera[0].rotation.col(0) - Eigen::Vector3d::UnitY()).norm() < 1e-15);
}

TEST_CASE("a wrong EuRoC file is refused with its line") {
  CHECK_THROWS_WITH_AS(
      read("1403636580838555648,1,2,3,1,0,0\n"),
      doctest::Contains("data.csv:1: euroc: at least 8 numbers (stamp x y z qw qx qy qz) expected, "
                        "found 7"),
      format_error);
  CHECK_THROWS_WITH_AS(
      read("1.5,1,2,3,1,0,0,0\n"),
      doctest::Contains("data.csv:1: euroc: a stamp in whole nanoseconds expected, found '1.5'"),
      format_error);
  CHECK_THROWS_WITH_AS(read("1403636580838555648,1,2,3,0,0,0,0\n"),
                       doctest::Contains("data.csv:1: euroc: the quaternion is zero"),
                       format_error);
}

}  // namespace test_euroc
