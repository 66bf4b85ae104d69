// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/io/transforms.hpp>
#include <aib/io/tum.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <support/pose_distance.hpp>
#include <support/scratch.hpp>
#include <support/shared.hpp>
#include <vector>

using namespace aib;

namespace test_transforms {

namespace {

const support::scratch scratch;

io::posed_images read(const std::string& text, const io::transforms_options& options = {}) {
  return io::read_transforms(scratch.file("transforms.json", text), options);
}

std::string error_of(const std::string& text) {
  try {
    static_cast<void>(read(text));
  } catch (const format_error& e) {
    return std::string(e.what()).substr(scratch.folder().string().size() + 1);
  }
  return "no error";
}

/// A frame at (1, 2, 3) with the axes of the world, and further members.
std::string frame(const std::string& name, const std::string& more = "") {
  return R"({"file_path": ")" + name +
         R"(", "transform_matrix": [[1,0,0,1],[0,1,0,2],[0,0,1,3],[0,0,0,1]])" + more + "}";
}

}  // namespace

TEST_CASE("transforms.json has OpenGL axes: the camera looks along -z, y is up") {
  const auto images = read(R"({"frames": [)" + frame("./images/a.png") + "]}");
  REQUIRE(images.trajectory.size() == 1);
  CHECK(images.trajectory.names[0] == "images/a.png");
  const math::rigid3& pose = images.trajectory.world_from_camera[0];
  CHECK(pose.translation == Eigen::Vector3d(1, 2, 3));
  CHECK(pose.rotation.col(2) == Eigen::Vector3d(0, 0, -1));
  CHECK(pose.rotation.col(1) == Eigen::Vector3d(0, -1, 0));
}

TEST_CASE("the axes and the direction of transforms.json are options") {
  const auto images = read(R"({"frames": [)" + frame("a") + "]}",
                           {.frame = {io::pose_convention::camera_from_world}});
  CHECK(images.trajectory.world_from_camera[0].rotation == Eigen::Matrix3d::Identity());
  CHECK(images.trajectory.world_from_camera[0].translation == Eigen::Vector3d(-1, -2, -3));
}

TEST_CASE("intrinsics are those of the frame, else of the file") {
  const auto images = read(R"({"w": 640, "h": 480, "fl_x": 500, "cx": 321, "frames": [)" +
                           frame("a") + "," + frame("b", R"(, "fl_x": 510, "fl_y": 511)") + "]}");
  REQUIRE(images.cameras.size() == 2);
  CHECK(images.cameras[0].model == math::camera_model::pinhole);
  CHECK(images.cameras[0].width == 640);
  CHECK(images.cameras[0].parameters == std::vector<double>{500, 500, 321, 240});
  CHECK(images.cameras[1].parameters == std::vector<double>{510, 511, 321, 240});
}

TEST_CASE("an angle of view becomes a focal length where the width is known") {
  const std::string text =
      R"({"camera_angle_x": 1.5707963267948966, "frames": [)" + frame("a") + "]}";
  const auto images = read(text, {.size = {800, 600}});  // 90 degrees: f = w / 2
  REQUIRE(images.cameras.size() == 1);
  CHECK(images.cameras[0].fx() == doctest::Approx(400).epsilon(1e-15));
  CHECK(images.cameras[0].cy() == 300);
  const auto without = read(text);
  CHECK(without.cameras.empty());
  CHECK(without.trajectory.warnings ==
        std::vector<std::string>{"intrinsics are known for 0 of 1 images: none are given"});
}

TEST_CASE("distortion chooses COLMAP's model") {
  const auto model = [](const std::string& members) {
    const auto images = read(R"({"w": 640, "h": 480, "fl_x": 500, )" + members + R"("frames": [)" +
                             frame("a") + "]}");
    return images.cameras.empty() ? std::string("none")
                                  : std::string(math::info(images.cameras[0].model).name);
  };
  CHECK(model("") == "PINHOLE");
  CHECK(model(R"("k1": 0.1, "p2": 0.01, )") == "OPENCV");
  CHECK(model(R"("camera_model": "SIMPLE_RADIAL", "k1": 0.1, )") == "OPENCV");
  CHECK(model(R"("k1": 0.1, "k3": 0.01, )") == "FULL_OPENCV");
  CHECK(model(R"("camera_model": "OPENCV_FISHEYE", "k4": 0.1, )") == "OPENCV_FISHEYE");
  CHECK(model(R"("camera_model": "EQUIRECTANGULAR", )") == "EQUIRECTANGULAR");
  CHECK(model(R"("camera_model": "FISHEYE624", )") == "none");
}

TEST_CASE("a wrong transforms.json is refused with its place") {
  CHECK(error_of("{}") == "transforms.json: 'frames' expected, found none");
  CHECK(error_of(R"({"frames": 3})") == "transforms.json: frames: an array expected, found number");
  CHECK(error_of(R"({"frames": []})") == "transforms.json: transforms: no pose in the file");
  CHECK(error_of(R"({"frames": [{"file_path": "a"}]})") ==
        "transforms.json: frames[0]: 'transform_matrix' expected, found none");
  CHECK(error_of(R"({"frames": [{"transform_matrix": []}]})") ==
        "transforms.json: frames[0]: 'file_path' expected, found none");
  CHECK(error_of(R"({"frames": [{"file_path": "a", "transform_matrix": [[1,0],[0,1]]}]})") ==
        "transforms.json: frames[0].transform_matrix: 4 or 3 rows expected, found 2");
  CHECK(error_of(R"({"frames": [{"file_path": "a", "transform_matrix":
                  [[1,0,0,0],[0,1,0,0],[0,0,1,"x"]]}]})") ==
        "transforms.json: frames[0].transform_matrix[2][3]: a number expected, found string");
  CHECK(error_of(R"({"frames": [{"file_path": "a", "transform_matrix":
                  [[2,0,0,0],[0,2,0,0],[0,0,2,0],[0,0,0,1]]}]})") ==
        "transforms.json: frames[0].transform_matrix: the rotation part lies 1.7320508075688772 "
        "from a rotation, at most 0.01 expected");
  CHECK(error_of(R"({"frames": [{"file_path": "a", "transform_matrix":
                  [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,1,1]]}]})") ==
        "transforms.json: frames[0].transform_matrix[3]: 0 0 0 1 expected in the last row");
  CHECK(error_of(R"({"frames": [)")
            .starts_with("transforms.json: byte 13: json: parse error at line 1, column 13"));
}

TEST_CASE("poses and intrinsics come back from the transforms.json that we write") {
  io::posed_images images;
  images.trajectory.names = {"a.png", "lost.png", "b.png"};
  images.trajectory.world_from_camera = {
      {math::rotation_from(Eigen::Vector3d(0.1, 0.2, 0.3)), {1, 2, 3}},
      io::unregistered_pose(),
      {}};
  images.cameras = {
      math::pinhole(640, 480, 500, 501, 320, 240),
      math::pinhole(640, 480, 500, 501, 320, 240),
      {math::camera_model::opencv_fisheye, 640, 480, {500, 501, 320, 240, 0.1, 0.2, 0.3, 0.4}}};
  const auto path = scratch.folder() / "out.json";
  io::write_transforms(path, images);
  const auto back = io::read_transforms(path);
  CHECK(back.trajectory.names == std::vector<std::string>{"a.png", "b.png"});
  CHECK(support::distance(back.trajectory.world_from_camera[0],
                          images.trajectory.world_from_camera[0]) < 1e-15);
  CHECK(back.cameras[0].parameters == images.cameras[0].parameters);
  CHECK(back.cameras[1].model == math::camera_model::opencv_fisheye);
  CHECK(back.cameras[1].parameters == images.cameras[2].parameters);
}

TEST_CASE("what transforms.json cannot hold is not written") {
  const auto path = scratch.folder() / "never.json";
  io::posed_images images;
  images.trajectory.world_from_camera = {{}};
  CHECK_THROWS_WITH_AS(io::write_transforms(path, images), "write_transforms: the poses need names",
                       argument_error);
  images.trajectory.names = {"a"};
  images.cameras = {{math::camera_model::fov, 640, 480, {500, 501, 320, 240, 0.1}}};
  CHECK_THROWS_WITH_AS(io::write_transforms(path, images),
                       "write_transforms: camera model FOV is not one of SIMPLE_PINHOLE, PINHOLE, "
                       "OPENCV, OPENCV_FISHEYE",
                       argument_error);
  CHECK_FALSE(std::filesystem::exists(path));
}

TEST_CASE("the scenes' transforms.json and TUM files hold the same poses") {
  if (!support::has_shared("transforms.json of the scenes")) return;
  for (const char* scene : {"crane", "office"}) {
    const auto folder = support::shared() / "scenes" / "gt" / scene;
    const auto a = io::read_transforms(folder / "transforms.json").trajectory;
    const auto b = io::read_tum(folder / "poses" / "poses.tum");
    REQUIRE(a.size() == b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
      // matrices of floats, quaternions of 9 digits
      CHECK(support::distance(a.world_from_camera[i], b.world_from_camera[i]) < 1e-6);
    }
  }
}

}  // namespace test_transforms
