// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/io/tum.hpp>

#include <doctest/doctest.h>

#include <clocale>
#include <string>
#include <support/scratch.hpp>
#include <vector>

using namespace aib;

namespace test_tum {

namespace {

const support::scratch scratch;

pose::trajectory read(const std::string& text, const io::tum_options& options = {}) {
  return io::read_tum(scratch.file("walk.txt", text), options);
}

std::string error_of(const std::string& text) {
  try {
    static_cast<void>(read(text));
  } catch (const format_error& e) {
    return std::string(e.what()).substr(scratch.folder().string().size() + 1);
  }
  return "no error";
}

}  // namespace

TEST_CASE("a TUM line is stamp, position and quaternion with w last") {
  // A turn by 90 degrees about z: the camera's x axis points to the world's y.
  const auto t = read("1.5 1 2 3 0 0 0.7071067811865476 0.7071067811865476\n");
  REQUIRE(t.size() == 1);
  CHECK(t.stamps_s == std::vector<double>{1.5});
  CHECK(t.names.empty());
  CHECK(t.warnings.empty());
  const math::rigid3& pose = t.world_from_camera[0];
  CHECK(pose.translation == Eigen::Vector3d(1, 2, 3));
  CHECK((pose.rotation.col(0) - Eigen::Vector3d::UnitY()).norm() < 1e-15);
}

TEST_CASE("a quaternion and its negative are one rotation") {
  const auto t = read("0 1 2 3 0.1 -0.2 0.3 0.9\n1 1 2 3 -0.1 0.2 -0.3 -0.9\n");
  CHECK((t.world_from_camera[0].rotation - t.world_from_camera[1].rotation).norm() < 1e-15);
}

TEST_CASE("a TUM file is read with w first where told so") {
  const auto t = read("0 1 2 3 0.7071067811865476 0 0 0.7071067811865476\n",
                      {.quaternion = io::quaternion_order::wxyz});
  CHECK((t.world_from_camera[0].rotation.col(0) - Eigen::Vector3d::UnitY()).norm() < 1e-15);
}

TEST_CASE("blanks, commas, comments, line ends and a byte order mark do not matter") {
  const auto t = read(
      "\xEF\xBB\xBF# stamp tx ty tz qx qy qz qw\r\n"
      "\r\n"
      "0\t1  2 3 0 0 0 1   \r\n"
      "  # a comment\n"
      "1, 4,5 ,6,0,0,0,1\n"
      "2e0 +7 8.0E0 9 0 0 0 1");
  CHECK(t.stamps_s == std::vector<double>{0, 1, 2});
  CHECK(t.world_from_camera[1].translation == Eigen::Vector3d(4, 5, 6));
  CHECK(t.world_from_camera[2].translation == Eigen::Vector3d(7, 8, 9));
}

TEST_CASE("the decimal point is a point in every locale") {
  const char* german = std::setlocale(LC_ALL, "de_DE.UTF-8");
  const auto t = read("0.5 1.5 0 0 0 0 0 1\n");
  CHECK(t.stamps_s[0] == 0.5);
  CHECK(t.world_from_camera[0].translation.x() == 1.5);
  if (german != nullptr) std::setlocale(LC_ALL, "C");
}

TEST_CASE("what a TUM reader doubts is in the warnings") {
  const auto t = read(
      "0 0 0 0 0 0 0 2\n"
      "2 nan 0 0 0 0 0 1\n"
      "1 0 0 0 0 0 0 1\n"
      "1 0 0 0 0 0 0 1\n");
  CHECK(t.warnings ==
        std::vector<std::string>{"1 quaternions are not of length 1: normalised",
                                 "1 of 4 poses are not finite: not registered",
                                 "1 of 4 poses repeat a stamp",
                                 "1 of 4 poses have an earlier stamp than the pose before"});
  CHECK(t.world_from_camera[0].rotation == Eigen::Matrix3d::Identity());
  CHECK_FALSE(t.world_from_camera[1].is_finite());
}

TEST_CASE("a wrong TUM file is refused with its line") {
  CHECK(error_of("0 0 0 0 0 0 0 1\n# \n1 0 0 0 0 0 0\n") ==
        "walk.txt:3: tum: 8 numbers (stamp tx ty tz qx qy qz qw) expected, found 7");
  CHECK(error_of("0 0 0 0 0 0 0 one\n") == "walk.txt:1: tum: a number expected, found 'one'");
  CHECK(error_of("0,,0 0 0 0 0 0 1\n") == "walk.txt:1: tum: a number expected, found ''");
  CHECK(error_of("0 0 0 0 0 0 0 0\n") == "walk.txt:1: tum: the quaternion is zero");
  CHECK(error_of("inf 0 0 0 0 0 0 1\n") == "walk.txt:1: tum: the stamp is not finite");
  CHECK(error_of("# nothing\n") == "walk.txt: tum: no pose in the file");
  CHECK(error_of("") == "walk.txt: tum: no pose in the file");
}

TEST_CASE("a trajectory comes back from a TUM file bit for bit where its quaternions do") {
  pose::trajectory t;
  for (const double x : {0.1, 1.0 / 3, 12345.678901234567}) {
    t.world_from_camera.push_back({Eigen::Matrix3d::Identity(), {x, -x, 2 * x}});
    t.stamps_s.push_back(1e9 + x);
  }
  const auto path = scratch.folder() / "out.tum";
  io::write_tum(path, t);
  const auto back = io::read_tum(path);
  CHECK(back.stamps_s == t.stamps_s);
  for (std::size_t i = 0; i < t.size(); ++i)
    CHECK(back.world_from_camera[i].matrix() == t.world_from_camera[i].matrix());
}

TEST_CASE("writing TUM leaves out what is not registered and counts where there are no stamps") {
  pose::trajectory t;
  t.world_from_camera = {io::unregistered_pose(), {}};
  const auto path = scratch.folder() / "out.tum";
  io::write_tum(path, t);
  CHECK(io::read_file(path) == "1 0 0 0 0 0 0 1\n");
  t.world_from_camera.pop_back();
  CHECK_THROWS_WITH_AS(io::write_tum(path, t), "write_tum: no registered pose to write",
                       argument_error);
  CHECK(io::read_file(path) == "1 0 0 0 0 0 0 1\n");
}

}  // namespace test_tum
