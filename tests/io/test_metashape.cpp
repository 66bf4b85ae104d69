// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/io/metashape.hpp>

#include <doctest/doctest.h>

#include <string>
#include <support/scratch.hpp>
#include <vector>

using namespace aib;

namespace test_metashape {

namespace {

const support::scratch scratch;

const std::string sensors = R"(
<sensors><sensor id="0" label="X"><resolution width="4000" height="3000"/>
  <calibration type="frame" class="initial"><f>1</f></calibration>
  <calibration type="frame" class="adjusted"><resolution width="4000" height="3000"/>
    <f>3000</f><cx>10</cx><cy>-20</cy><b1>5</b1><k1>0.1</k1><k2>0.2</k2><k3>0.3</k3>
    <p1>0.01</p1><p2>0.02</p2></calibration>
</sensor></sensors>)";

const std::string at_1_2_3 = "<transform>1 0 0 1 0 1 0 2 0 0 1 3 0 0 0 1</transform>";

const std::string world = R"(<transform><rotation>0 -1 0 1 0 0 0 0 1</rotation>
  <translation>10 20 30</translation><scale>2</scale></transform>)";

std::string camera(const std::string& label, const std::string& content) {
  return R"(<camera id="0" sensor_id="0" component_id="0" label=")" + label + "\">" + content +
         "</camera>";
}

io::posed_images read(const std::string& chunk) {
  return io::read_metashape(
      scratch.file("cameras.xml", "<?xml version=\"1.0\"?><document version=\"1.4.0\"><chunk>" +
                                      chunk + "</chunk></document>"));
}

std::string error_of(const std::string& chunk) {
  try {
    static_cast<void>(read(chunk));
  } catch (const format_error& e) {
    return std::string(e.what()).substr(scratch.folder().string().size() + 1);
  }
  return "no error";
}

}  // namespace

TEST_CASE("Metashape cameras are moved to the world of their chunk") {
  const auto images = read(sensors + "<cameras>" + camera("a.jpg", at_1_2_3) + "<group>" +
                           camera("b.jpg", "") + "</group></cameras>" + world);
  CHECK(images.trajectory.names == std::vector<std::string>{"a.jpg", "b.jpg"});
  // 2 R (1, 2, 3) + (10, 20, 30) with R a turn by 90 degrees about z.
  const math::rigid3& pose = images.trajectory.world_from_camera[0];
  CHECK((pose.translation - Eigen::Vector3d(6, 22, 36)).norm() < 1e-14);
  CHECK((pose.rotation.col(0) - Eigen::Vector3d::UnitY()).norm() < 1e-15);
  CHECK_FALSE(images.trajectory.world_from_camera[1].is_finite());
  CHECK(images.trajectory.warnings ==
        std::vector<std::string>{"1 of 2 poses are not finite: not registered"});
}

TEST_CASE("a component's own transform wins over the chunk's") {
  const auto images = read(
      sensors + R"(<components><component id="0"><transform><rotation>1 0 0 0 1 0 0 0 1</rotation>
      <translation>0 0 0</translation><scale>10</scale></transform></component></components>)" +
      "<cameras>" + camera("a", at_1_2_3) + "</cameras>" + world);
  CHECK(images.trajectory.world_from_camera[0].translation == Eigen::Vector3d(10, 20, 30));
}

TEST_CASE("without a transform the poses stay in the chunk's frame, with a warning") {
  const auto images = read(sensors + "<cameras>" + camera("a", at_1_2_3) + "</cameras>");
  CHECK(images.trajectory.world_from_camera[0].translation == Eigen::Vector3d(1, 2, 3));
  CHECK(images.trajectory.warnings ==
        std::vector<std::string>{"no transform to the world: the frame and unit of the chunk"});
}

TEST_CASE("of several chunks the first is read, with a warning") {
  const auto images = read(sensors + "<cameras>" + camera("a.jpg", at_1_2_3) + "</cameras>" +
                           world + "</chunk><chunk>");
  CHECK(images.trajectory.size() == 1);
  CHECK(images.trajectory.warnings == std::vector<std::string>{"the first of 2 chunks is read"});
}

TEST_CASE("Metashape's adjusted calibration becomes COLMAP's parameters") {
  const auto images = read(sensors + "<cameras>" + camera("a", at_1_2_3) + "</cameras>" + world);
  REQUIRE(images.cameras.size() == 1);
  CHECK(images.cameras[0].model == math::camera_model::full_opencv);
  CHECK(images.cameras[0].parameters ==
        std::vector<double>{3005, 3000, 2010, 1480, 0.1, 0.2, 0.02, 0.01, 0.3, 0, 0, 0});
}

TEST_CASE("a wrong Metashape file is refused with its place") {
  CHECK(error_of("<cameras/>") == "cameras.xml: metashape: no pose in the file");
  CHECK(error_of("<cameras>" + camera("a", "<transform>1 2 3</transform>") + "</cameras>") ==
        "cameras.xml: metashape: <transform>: 16 numbers expected, found 3");
  CHECK(error_of("<cameras>" + camera("a", "<transform>1 x</transform>") + "</cameras>") ==
        "cameras.xml: metashape: <transform>: a number expected, found 'x'");
  CHECK(error_of("<cameras>" +
                 camera("a", "<transform>2 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</transform>") +
                 "</cameras>") ==
        "cameras.xml: metashape: camera 'a': the rotation part lies 1 from a rotation, at most "
        "0.01 expected");
  CHECK_THROWS_WITH_AS(io::read_metashape(scratch.file("x.xml", "<document/>")),
                       doctest::Contains("metashape: <document><chunk> expected"), format_error);
  CHECK_THROWS_WITH_AS(io::read_metashape(scratch.file("x.xml", "<document>")),
                       doctest::Contains("xml: "), format_error);
}

}  // namespace test_metashape
