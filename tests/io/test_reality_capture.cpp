// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/io/reality_capture.hpp>

#include <doctest/doctest.h>

#include <string>
#include <support/scratch.hpp>
#include <vector>

using namespace aib;

namespace test_reality_capture {

namespace {

const support::scratch scratch;

const std::string header = "#name,x,y,alt,heading,pitch,roll,f,px,py,k1,k2,k3,k4,t1,t2\n";

io::posed_images read(const std::string& text, const io::image_extent& size = {}) {
  return io::read_reality_capture(scratch.file("cameras.csv", text), size);
}

}  // namespace

TEST_CASE("a RealityCapture camera without angles looks down, its image's top to the north") {
  const auto images = read(header + "a.jpg,1,2,3,0,0,0,50,0,0,0,0,0,0,0,0\n");
  CHECK(images.trajectory.names == std::vector<std::string>{"a.jpg"});
  const math::rigid3& pose = images.trajectory.world_from_camera[0];
  CHECK(pose.translation == Eigen::Vector3d(1, 2, 3));
  CHECK((pose.rotation.col(2) + Eigen::Vector3d::UnitZ()).norm() < 1e-15);
  CHECK((pose.rotation.col(1) + Eigen::Vector3d::UnitY()).norm() < 1e-15);
}

TEST_CASE("heading turns clockwise from north, pitch raises the view") {
  // Pitched by 90 degrees and headed east: the camera looks along x.
  const auto images = read(header + "a.jpg,0,0,0,90,90,0,50,0,0,0,0,0,0,0,0\n");
  CHECK((images.trajectory.world_from_camera[0].rotation.col(2) - Eigen::Vector3d::UnitX()).norm() <
        1e-15);
}

TEST_CASE("the 35 mm equivalent focal length needs the images' size") {
  const std::string text = header + "a.jpg,0,0,0,0,0,0,50,0,0,0.1,0,0,0,0,0\n";
  CHECK(read(text).cameras.empty());
  const auto images = read(text, {.width = 1920, .height = 1080});
  CHECK(images.cameras[0].fx() == doctest::Approx(50.0 / 36 * 1920).epsilon(1e-15));
  CHECK(images.cameras[0].cy() == 540);
  CHECK(images.trajectory.warnings ==
        std::vector<std::string>{"principal points and distortion are left out of the intrinsics"});
}

TEST_CASE("a wrong RealityCapture file is refused with its line") {
  CHECK_THROWS_WITH_AS(read(""), doctest::Contains("reality_capture: the file is empty"),
                       format_error);
  CHECK_THROWS_WITH_AS(read(header), doctest::Contains("reality_capture: no pose in the file"),
                       format_error);
  CHECK_THROWS_WITH_AS(
      read(header + "a.jpg,1,2\n"),
      doctest::Contains("cameras.csv:2: reality_capture: 16 columns expected, found 3"),
      format_error);
  CHECK_THROWS_WITH_AS(
      read("#name,x,y\na,1,2\n"),
      doctest::Contains("cameras.csv:2: reality_capture: no column 'heading' in the first line"),
      format_error);
  CHECK_THROWS_WITH_AS(
      read("#name,x,y,alt,heading,pitch,roll\na,1,2,3,north,0,0\n"),
      doctest::Contains(
          "cameras.csv:2: reality_capture: heading: a number expected, found 'north'"),
      format_error);
  CHECK_THROWS_WITH_AS(
      read("#name,x,y,alt,heading,pitch,roll\na,1,2,high,0,0,0\n"),
      doctest::Contains("cameras.csv:2: reality_capture: alt: a number expected, found 'high'"),
      format_error);
}

}  // namespace test_reality_capture
