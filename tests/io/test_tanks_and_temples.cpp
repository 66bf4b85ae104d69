// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/io/tanks_and_temples.hpp>

#include <doctest/doctest.h>

#include <string>
#include <support/scratch.hpp>

using namespace aib;

namespace test_tanks_and_temples {

namespace {

const support::scratch scratch;

const std::string identity = "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";

pose::trajectory read(const std::string& text) {
  return io::read_tanks_and_temples(scratch.file("scene.log", text));
}

}  // namespace

TEST_CASE("a log record is three numbers and a 4 x 4 matrix") {
  const auto t = read("0 0 0\n" + identity + "1\t1 0\n1 0 0 4\n0 1 0 5\n0 0 1 6\n0 0 0 1\n");
  REQUIRE(t.size() == 2);
  CHECK(t.world_from_camera[1].translation == Eigen::Vector3d(4, 5, 6));
}

TEST_CASE("identity with -1 is a frame that was not registered; it keeps its place") {
  const auto t = read("0 -1 0\n" + identity + "1 1 0\n" + identity);
  CHECK_FALSE(t.world_from_camera[0].is_finite());
  CHECK(t.world_from_camera[1].is_finite());
  CHECK(t.warnings == std::vector<std::string>{"1 of 2 poses are not finite: not registered"});
}

TEST_CASE("a wrong log file is refused with its line") {
  CHECK_THROWS_WITH_AS(read("0 0\n" + identity),
                       doctest::Contains("scene.log:1: log: 3 numbers (frame, frame, 0) expected"),
                       format_error);
  CHECK_THROWS_WITH_AS(read("0 0 0\n1 0 0 0\n0 1 0 0\n"),
                       doctest::Contains("scene.log:3: log: the file ends within a matrix"),
                       format_error);
  CHECK_THROWS_WITH_AS(
      read("0 0 0\n1 0 0\n"),
      doctest::Contains("scene.log:2: log: 4 numbers (row of a 4 x 4 matrix) expected, found 3"),
      format_error);
}

}  // namespace test_tanks_and_temples
