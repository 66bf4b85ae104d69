// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/io/bytes.hpp>
#include <aib/io/colmap.hpp>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <string>
#include <support/pose_distance.hpp>
#include <support/scratch.hpp>
#include <support/shared.hpp>
#include <vector>

using namespace aib;
using nlohmann::json;

namespace test_colmap {

namespace {

/// The three text files of a model, each of which a test may replace.
struct text_model {
  std::string cameras = "3 PINHOLE 640 480 500 501 320 240\n";
  std::string images =
      "# IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME\n"
      "9 1 0 0 0 1 2 3 3 b.png\n"
      "1.5 2.5 -1 3.5 4.5 7\n"
      "4 0.7071067811865476 0 0 0.7071067811865476 1 0 0 3 sub dir/a 1.png\n"
      "\n";
  std::string points = "7 1 2 3 10 20 30 0.5 9 1 4 0\n8 -1 0 0 0 0 0 -1\n";

  std::filesystem::path write(const support::scratch& scratch, const std::string& folder) const {
    scratch.file(folder + "/cameras.txt", cameras);
    scratch.file(folder + "/points3D.txt", points);
    return scratch.file(folder + "/images.txt", images).parent_path();
  }
};

std::string error_of(const text_model& model) {
  const support::scratch scratch;
  const auto folder = model.write(scratch, "model");
  try {
    static_cast<void>(io::read_colmap(folder));
  } catch (const format_error& e) {
    return std::string(e.what()).substr(folder.string().size() + 1);
  }
  return "no error";
}

/// An images.bin with one image whose observations are `n` of which `written` are there.
std::string images_bin(std::uint64_t n, std::size_t written) {
  std::string bytes;
  io::store(bytes, std::uint64_t{1});
  io::store(bytes, std::uint32_t{4000000000});
  for (const double number : {2.0, 0.0, 0.0, 0.0, 1.0, 2.0, 3.0}) io::store(bytes, number);
  io::store(bytes, std::uint32_t{3});
  bytes += std::string("a b.png") + '\0';
  io::store(bytes, n);
  return bytes + std::string(24 * written, '\x01');
}

std::string cameras_bin(std::int32_t model, std::size_t n_parameters) {
  std::string bytes;
  io::store(bytes, std::uint64_t{1});
  io::store(bytes, std::uint32_t{3});
  io::store(bytes, model);
  io::store(bytes, std::uint64_t{640});
  io::store(bytes, std::uint64_t{480});
  for (std::size_t i = 0; i < n_parameters; ++i) io::store(bytes, 1.0 + static_cast<double>(i));
  return bytes;
}

std::string error_of(const std::string& cameras, const std::string& images) {
  const support::scratch scratch;
  scratch.file("cameras.bin", cameras);
  scratch.file("images.bin", images);
  try {
    static_cast<void>(io::read_colmap(scratch.folder()));
  } catch (const format_error& e) {
    return std::string(e.what()).substr(scratch.folder().string().size() + 1);
  }
  return "no error";
}

json read_json(const std::filesystem::path& path) {
  std::ifstream file(path);
  return json::parse(file);
}

/// Holds a model against the values that its makers expect.
void check_expected(const io::colmap_model& model, const json& expected) {
  CHECK(model.cameras.size() == expected.at("cameras").size());
  for (const auto& [id, camera] : expected.at("cameras").items()) {
    const math::camera& c = model.cameras.at(static_cast<std::uint32_t>(std::stoul(id)));
    CHECK(static_cast<int>(c.model) == camera.at("model_id").get<int>());
    CHECK(c.width == camera.at("width").get<std::uint64_t>());
    CHECK(c.height == camera.at("height").get<std::uint64_t>());
    CHECK(c.parameters == camera.at("params").get<std::vector<double>>());
  }
  REQUIRE(model.trajectory.size() == expected.at("images").size());
  for (std::size_t i = 0; i < model.trajectory.size(); ++i) {
    const json& image = expected.at("images").at(std::to_string(model.image_ids[i]));
    CHECK(model.trajectory.names[i] == image.at("name").get<std::string>());
    CHECK(model.camera_ids[i] == image.at("camera_id").get<std::uint32_t>());
    const math::rigid3& pose = model.trajectory.world_from_camera[i];
    for (Eigen::Index r = 0; r < 3; ++r) {
      const auto row = static_cast<std::size_t>(r);
      const double centre = image.at("centre").at(row).get<double>();
      CHECK(pose.translation[r] == doctest::Approx(centre).epsilon(1e-13).scale(1));
      for (Eigen::Index c = 0; c < 3; ++c) {
        const double element = image.at("R").at(row).at(static_cast<std::size_t>(c)).get<double>();
        CHECK(pose.rotation(c, r) == doctest::Approx(element).epsilon(1e-14).scale(1));
      }
    }
  }
}

}  // namespace

TEST_CASE("a text model is read: two lines an image, names with blanks, sorted by name") {
  const support::scratch scratch;
  const io::colmap_model model = io::read_colmap(text_model().write(scratch, "model"));
  CHECK(model.trajectory.names == std::vector<std::string>{"b.png", "sub dir/a 1.png"});
  CHECK(model.image_ids == std::vector<std::uint32_t>{9, 4});
  CHECK(model.camera(0).parameters == std::vector<double>{500, 501, 320, 240});
  // The first looks along the world's axes from -t; the second is turned by 90 degrees about z:
  // its centre is -R^T t with R^T x = -y.
  CHECK(model.trajectory.world_from_camera[0].translation == Eigen::Vector3d(-1, -2, -3));
  CHECK((model.trajectory.world_from_camera[1].translation - Eigen::Vector3d(0, 1, 0)).norm() <
        1e-15);
  REQUIRE(model.points.size() == 2);
  CHECK(model.points.points[0] == Eigen::Vector3f(1, 2, 3));
  CHECK(model.points.colors[0] == cloud::color{10, 20, 30});
  CHECK(model.point_errors_px == std::vector<double>{0.5, -1});
  CHECK(model.track_lengths == std::vector<std::uint64_t>{2, 0});
  CHECK(model.trajectory.warnings.empty());
}

TEST_CASE("points may be left unread: they are counted") {
  const support::scratch scratch;
  const auto folder = text_model().write(scratch, "model");
  const auto model = io::read_colmap(folder, io::colmap_content::cameras_and_images);
  CHECK(model.points.empty());
  CHECK(model.n_points == 2);
}

TEST_CASE("cameras are found by image name") {
  const support::scratch scratch;
  const auto cameras = io::cameras_by_name(io::read_colmap(text_model().write(scratch, "model")));
  CHECK(cameras.size() == 2);
  CHECK(cameras.at("sub dir/a 1.png").fy() == 501);
}

TEST_CASE("binary wins where a folder has both, as in COLMAP") {
  const support::scratch scratch;
  const auto folder = text_model().write(scratch, "model");
  scratch.file("model/cameras.bin", cameras_bin(1, 4));
  scratch.file("model/images.bin", images_bin(1000, 1000));
  const auto model = io::read_colmap(folder);
  CHECK(model.trajectory.names == std::vector<std::string>{"a b.png"});
  CHECK(model.image_ids == std::vector<std::uint32_t>{4000000000});
  CHECK(model.trajectory.world_from_camera[0].translation == Eigen::Vector3d(-1, -2, -3));
  CHECK(model.points.warnings ==
        std::vector<std::string>{"the model has no points3D file: no points"});
}

TEST_CASE("of several models the one with most images is read, then with most points") {
  const support::scratch scratch;
  text_model small;
  small.images = "9 1 0 0 0 1 2 3 3 b.png\n\n";
  text_model fewer_points;
  fewer_points.points = "";
  small.write(scratch, "run/sparse/0");
  fewer_points.write(scratch, "run/sparse/2");
  text_model().write(scratch, "run/sparse/10");
  text_model().write(scratch, "run/sparse/11");
  const auto found = io::find_colmap_models(scratch.folder() / "run");
  REQUIRE(found.size() == 4);
  CHECK(found[1].filename() == "2");  // the order of the numbers, not of the letters
  const auto model = io::read_colmap(scratch.folder() / "run");
  CHECK(model.path.filename() == "10");
  CHECK(model.trajectory.warnings ==
        std::vector<std::string>{"model 10 of 4 is read (2 images), not 0 (1 images), 2 "
                                 "(2 images), 11 (2 images)"});
}

TEST_CASE("rigs and frames pose the images where they disagree") {
  const support::scratch scratch;
  const auto folder = text_model().write(scratch, "model");
  // Image 9 is the rig's reference; image 4 is a second camera at (1, 0, 0) of the rig; the IMU has
  // no pose.
  scratch.file("model/cameras.txt",
               "3 PINHOLE 640 480 500 501 320 240\n"
               "4 PINHOLE 640 480 500 501 320 240\n");
  scratch.file("model/images.txt", "9 1 0 0 0 1 2 3 3 b.png\n\n4 1 0 0 0 0 0 0 4 c.png\n\n");
  scratch.file("model/rigs.txt", "1 3 CAMERA 3 IMU 5 0 CAMERA 4 1 1 0 0 0 -1 0 0\n");
  scratch.file("model/frames.txt", "7 1 1 0 0 0 10 0 0 2 CAMERA 3 9 CAMERA 4 4\n");
  const auto model = io::read_colmap(folder);
  CHECK(model.trajectory.world_from_camera[0].translation == Eigen::Vector3d(-10, 0, 0));
  CHECK(model.trajectory.world_from_camera[1].translation == Eigen::Vector3d(-9, 0, 0));
  CHECK(model.trajectory.warnings ==
        std::vector<std::string>{"2 of 2 images have another pose in rigs and frames, which wins"});
}

TEST_CASE("a wrong text model is refused with file and line") {
  text_model m;
  m.cameras = "3 PINHOLE 640 480 500 501 320\n";
  CHECK(error_of(m) == "cameras.txt:1: colmap: 4 parameters of PINHOLE expected, found 3");
  m.cameras = "3 PINHOLE2 640 480 500\n";
  CHECK(error_of(m) == "cameras.txt:1: colmap: camera model 'PINHOLE2' is not known");
  m.cameras = "3 PINHOLE 640 480 500 nan 320 240\n";
  CHECK(error_of(m) == "cameras.txt:1: colmap: camera 3 has a parameter that is not finite");
  m.cameras = "3 SIMPLE_PINHOLE 640 480 5 3 2\n3 SIMPLE_PINHOLE 640 480 5 3 2\n";
  CHECK(error_of(m) == "cameras.txt:2: colmap: camera 3 comes twice");
  m.cameras = "5 SIMPLE_PINHOLE 640 480 5 3 2\n";
  CHECK(error_of(m) ==
        "images.txt: colmap: image 'b.png' has camera 3, which is not among the 1 cameras");
  m = {};
  m.images = "9 1 0 0 0 1 2 3 3\n\n";
  CHECK(error_of(m) == "images.txt:1: colmap: image name expected, found the end of the line");
  m.images = "9 1 0 0 0 1 x 3 3 a\n\n";
  CHECK(error_of(m) == "images.txt:1: colmap: translation expected, found 'x'");
  m.images = "9 0 0 0 0 1 2 3 3 a\n\n";
  CHECK(error_of(m) == "images.txt:1: colmap: the quaternion is zero");
  m.images = "9 1 0 0 0 1 inf 3 3 a\n\n";
  CHECK(error_of(m) == "images.txt:1: colmap: the pose is not finite");
  m.images = "9 1 0 0 0 1 2 3 3 a\n\n9 1 0 0 0 1 2 3 3 b\n\n";
  CHECK(error_of(m) == "images.txt: colmap: image 9 comes twice");
  m.images = "9 1 0 0 0 1 2 3 3 a\n10 1 0 0 0 1 2 3 3 b\n";  // the blank lines were stripped
  CHECK(error_of(m) ==
        "images.txt:2: colmap: observations (x, y, point id) or an empty line expected after an "
        "image's line");
  m.images = "# no image\n";
  CHECK(error_of(m) == "images.txt: colmap: no pose in the file");
  m = {};
  m.points = "7 1 2 3 10 20 300 0.5\n";
  CHECK(error_of(m) == "points3D.txt:1: colmap: color expected, found '300'");
  m.points = "7 1 2 3 10 20 30 0.5 9\n";
  CHECK(error_of(m) == "points3D.txt:1: colmap: track: pairs of numbers expected, found 1");
}

TEST_CASE("a wrong binary model is refused with file and byte") {
  CHECK(error_of(cameras_bin(99, 4), images_bin(0, 0)) ==
        "cameras.bin: byte 8: colmap: cameras: camera 3 has model 99, 0 to 17 expected");
  CHECK(error_of(cameras_bin(1, 3), images_bin(0, 0)) ==
        "cameras.bin: byte 56: colmap: camera parameters: 8 bytes expected, 0 left in the file");
  CHECK(error_of(cameras_bin(1, 5), images_bin(0, 0)) ==
        "cameras.bin: byte 64: colmap: 8 bytes after the last of 1 cameras");
  CHECK(error_of(cameras_bin(1, 4), images_bin(3, 2)) ==
        "images.bin: byte 80: colmap: observations: 3 records of at least 24 bytes do not fit in "
        "the 48 bytes left");
  CHECK(error_of(cameras_bin(1, 4), images_bin(~std::uint64_t{0}, 2)) ==
        "images.bin: byte 80: colmap: observations: 18446744073709551615 records of at least 24 "
        "bytes do not fit in the 48 bytes left");
  CHECK(error_of(cameras_bin(1, 4), images_bin(0, 0).substr(0, 60)) ==
        "images.bin: byte 0: colmap: images: 1 records of at least 73 bytes do not fit in the 52 "
        "bytes left");
}

TEST_CASE("a folder without a model is an input error") {
  const support::scratch scratch;
  CHECK_THROWS_WITH_AS(
      io::read_colmap(scratch.folder()),
      doctest::Contains("colmap: cameras and images (.bin or .txt) expected here, in numbered "
                        "folders or in sparse, found none"),
      io_error);
  CHECK_THROWS_WITH_AS(io::read_colmap(scratch.folder() / "none"),
                       doctest::Contains("no such folder"), io_error);
  text_model().write(scratch, "half/sparse/0");
  text_model().write(scratch, "half/sparse/1");
  std::filesystem::remove(scratch.folder() / "half/sparse/1/images.txt");
  CHECK_THROWS_WITH_AS(io::read_colmap(scratch.folder() / "half"),
                       doctest::Contains("images.txt: colmap: not there, though cameras.txt is"),
                       io_error);
}

TEST_CASE("COLMAP 4.2's own model of every camera, rigs and odd names is read as expected") {
  if (!support::has_shared("colmap4_synthetic")) return;
  const auto folder = support::shared() / "scenes" / "colmap4_synthetic";
  const json expected = read_json(folder / "expected.json");
  for (const char* kind : {"bin", "text", "text_in"}) {
    CAPTURE(kind);
    const io::colmap_model model = io::read_colmap(folder / kind);
    check_expected(model, expected);
    CHECK(model.trajectory.warnings.empty());
    CHECK(model.points.size() == expected.at("points3D").size());
  }
}

TEST_CASE("the models of the scenes have the recorded images, points and focal lengths") {
  if (!support::has_shared("models of the scenes")) return;
  const auto scenes = support::shared() / "scenes";
  struct expectation {
    const char* folder;
    std::size_t images;
    std::string model;
  };
  for (const expectation& e :
       {expectation{"colmap/crane", 41, "1"}, expectation{"colmap/office_high", 42, "0"},
        expectation{"colmap_gtposes/crane", 81, "sparse"}, expectation{"glomap/crane", 53, "0"},
        expectation{"colmap42/crane", 39, "1"}}) {
    CAPTURE(e.folder);
    const io::colmap_model model = io::read_colmap(scenes / "methods" / e.folder);
    CHECK(model.trajectory.size() == e.images);
    CHECK(model.path.filename() == e.model);
    CHECK(model.points.size() > 1000);
    CHECK(model.points.colors.size() == model.points.size());
  }
}

TEST_CASE("a model's text and binary files say the same") {
  if (!support::has_shared("text and binary of the scenes")) return;
  const auto folder = support::shared() / "scenes" / "methods";
  for (const auto& [binary, text] :
       {std::pair("colmap/crane/sparse/0", "colmap/crane/sparse_txt/0"),
        std::pair("glomap/crane/sparse/2", "glomap/crane/sparse_txt/2")}) {
    const auto a = io::read_colmap(folder / binary);
    const auto b = io::read_colmap(folder / text);
    CHECK(a.trajectory.names == b.trajectory.names);
    CHECK(a.image_ids == b.image_ids);
    CHECK(a.points.size() == b.points.size());
    CHECK(a.cameras.begin()->second.parameters == b.cameras.begin()->second.parameters);
    for (std::size_t i = 0; i < a.trajectory.size(); ++i) {
      CHECK(support::distance(a.trajectory.world_from_camera[i],
                              b.trajectory.world_from_camera[i]) < 1e-12);
    }
  }
}

}  // namespace test_colmap
