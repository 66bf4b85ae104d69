// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/io/opensfm.hpp>

#include <doctest/doctest.h>

#include <string>
#include <support/scratch.hpp>
#include <vector>

using namespace aib;

namespace test_opensfm {

namespace {

const support::scratch scratch;

std::string component(const std::string& camera, const std::string& shots) {
  return R"({"cameras": {"c": )" + camera + R"(}, "shots": {)" + shots +
         R"(}, "points": {"1": {"coordinates": [0, 0, 0]}}})";
}

/// A shot turned by 90 degrees about z (camera_from_world) with translation (1, 2, 3).
std::string shot(const std::string& name) {
  return message('"', name, R"(": {"camera": "c", "rotation": [0, 0, 1.5707963267948966],
      "translation": [1, 2, 3]})");
}

const std::string perspective =
    R"({"projection_type": "perspective", "width": 4000, "height": 3000, "focal": 0.8, "k1": 0.1})";

std::vector<io::posed_images> read(const std::string& text) {
  return io::read_opensfm_components(scratch.file("reconstruction.json", text));
}

std::string list(const std::string& components) { return message("[", components, "]"); }

math::camera camera_of(const std::string& json) {
  return read(list(component(json, shot("a")))).at(0).cameras.at(0);
}

}  // namespace

TEST_CASE("an OpenSfM shot is an axis with angle and a translation, camera_from_world") {
  const auto images =
      read(list(component(perspective, message(shot("b.jpg"), ",", shot("a.jpg")))));
  REQUIRE(images.size() == 1);
  CHECK(images[0].trajectory.names == std::vector<std::string>{"a.jpg", "b.jpg"});
  // The centre is -R^T t; R^T turns by -90 degrees: (x, y) -> (y, -x).
  const math::rigid3& pose = images[0].trajectory.world_from_camera[0];
  CHECK((pose.translation - Eigen::Vector3d(-2, 1, -3)).norm() < 1e-15);
  CHECK((pose.rotation.col(0) + Eigen::Vector3d::UnitY()).norm() < 1e-15);
}

TEST_CASE("OpenSfM's lengths are shares of the longer side from the image's centre") {
  const math::camera a = camera_of(perspective);
  CHECK(a.model == math::camera_model::radial);
  CHECK(a.parameters == std::vector<double>{3200, 2000, 1500, 0.1, 0});
  const math::camera b = camera_of(
      R"({"projection_type": "brown", "width": 4000, "height": 3000, "focal_x": 0.8,
          "focal_y": 0.81, "c_x": 0.01, "c_y": -0.02, "k1": 1, "k2": 2, "p1": 3, "p2": 4, "k3": 5})");
  CHECK(b.model == math::camera_model::full_opencv);
  CHECK(b.parameters == std::vector<double>{3200, 4000 * 0.81, 2040, 1420, 1, 2, 3, 4, 5, 0, 0, 0});
  const math::camera c =
      camera_of(R"({"projection_type": "spherical", "width": 2000, "height": 1000})");
  CHECK(c.model == math::camera_model::equirectangular);
}

TEST_CASE("a projection that COLMAP has not gives poses without intrinsics") {
  const auto images = read(
      list(component(R"({"projection_type": "dual", "width": 4000, "height": 3000})", shot("a"))));
  CHECK(images[0].cameras.empty());
  CHECK(images[0].trajectory.warnings ==
        std::vector<std::string>{"intrinsics are known for 0 of 1 images: none are given"});
}

TEST_CASE("of several OpenSfM components the largest is read") {
  const auto path = scratch.file("reconstruction.json",
                                 list(component(perspective, shot("a")) + "," +
                                      component(perspective, message(shot("b"), ",", shot("c")))));
  const auto images = io::read_opensfm(path);
  CHECK(images.trajectory.names == std::vector<std::string>{"b", "c"});
  CHECK(images.trajectory.warnings ==
        std::vector<std::string>{"component 1 of 2 is read (2 images)"});
}

TEST_CASE("a wrong reconstruction.json is refused with its place") {
  const auto error_of = [](const std::string& text) {
    try {
      static_cast<void>(read(text));
    } catch (const format_error& e) {
      return std::string(e.what()).substr(scratch.folder().string().size() + 1);
    }
    return std::string("no error");
  };
  CHECK(error_of("{}") == "reconstruction.json: an array expected, found object");
  CHECK(error_of("[]") == "reconstruction.json: opensfm: no reconstruction in the file");
  CHECK(error_of("[{}]") == "reconstruction.json: [0]: 'cameras' expected, found none");
  CHECK(error_of(list(component(perspective, ""))) ==
        "reconstruction.json: opensfm: no pose in the file");
  CHECK(error_of(list(component(perspective, R"("a": {"camera": "d", "rotation": [0, 0, 0],
        "translation": [0, 0, 0]})"))) ==
        "reconstruction.json: [0].shots.a: no camera 'd' in the file");
  CHECK(error_of(list(component(perspective, R"("a": {"camera": "c", "rotation": [0, 0]})"))) ==
        "reconstruction.json: [0].shots.a.rotation: 3 numbers expected, found 2");
  CHECK(error_of(list(component(R"({"projection_type": "perspective", "width": 0, "height": 1})",
                                shot("a")))) ==
        "reconstruction.json: [0].cameras.c: width and height of 1 or more pixels expected");
}

}  // namespace test_opensfm
