// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/io/npz_write.hpp>
#include <aib/io/trajectory.hpp>
#include <aib/io/trajectory_write.hpp>

#include <doctest/doctest.h>

#include <cstdlib>
#include <string>
#include <support/pose_distance.hpp>
#include <support/scratch.hpp>
#include <support/shared.hpp>
#include <vector>

using namespace aib;
using io::pose_format;

namespace test_trajectory {

namespace {

const support::scratch scratch;

const std::string tum_line = "0 1 2 3 0 0 0 1\n";
const std::string kitti_line = "1 0 0 1 0 1 0 2 0 0 1 3\n";
const std::string transforms =
    R"({"w": 8, "h": 6, "fl_x": 5, "frames": [{"file_path": "a.png", "transform_matrix":
    [[1,0,0,1],[0,-1,0,2],[0,0,-1,3],[0,0,0,1]]}]})";

/// A stack of one pose at (1, 2, 3).
io::array stack() {
  const std::vector<double> numbers{1, 0, 0, 1, 0, 1, 0, 2, 0, 0, 1, 3};
  return io::make_array<double>({1, 3, 4}, numbers);
}

void write_colmap_text(const std::string& folder) {
  scratch.file(folder + "/cameras.txt", "1 PINHOLE 8 6 5 5 4 3\n");
  scratch.file(folder + "/images.txt", "1 1 0 0 0 -1 -2 -3 1 a.png\n\n");
}

void check_is(pose_format format, const std::filesystem::path& path) {
  CAPTURE(path);
  CHECK(name(io::detect_pose_format(path)) == name(format));
}

io::posed_images three_images() {
  io::posed_images images;
  images.trajectory.names = {"a.png", "lost.png", "sub/b.png"};
  images.trajectory.world_from_camera = {
      {math::rotation_from(Eigen::Vector3d(0.1, -0.2, 2)), {1, 2, 3}},
      io::unregistered_pose(),
      {math::rotation_from(Eigen::Vector3d(1, 0, 0)), {-4, 5, 1.0 / 3}}};
  images.cameras = {math::pinhole(640, 480, 500, 501, 320, 240),
                    math::pinhole(640, 480, 500, 501, 320, 240),
                    {math::camera_model::opencv, 640, 480, {500, 501, 320, 240, 1, 2, 3, 4}}};
  return images;
}

}  // namespace

TEST_CASE("the format of poses is told from the content, whatever the name") {
  check_is(pose_format::tum, scratch.file("a", tum_line));
  check_is(pose_format::tum, scratch.file("a.csv", "# comment\n0,1,2,3,0,0,0,1\n"));
  check_is(pose_format::kitti, scratch.file("a", kitti_line));
  check_is(pose_format::euroc, scratch.file("a", "1403636580838555648,1,2,3,1,0,0,0\n"));
  check_is(pose_format::euroc, scratch.file("a", "#timestamp [ns],x\n1,1,2,3,1,0,0,0\n"));
  check_is(pose_format::log, scratch.file("a", "0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n"));
  check_is(pose_format::da3, scratch.file("a", "1 0 0 1 0 1 0 2 0 0 1 3 0 0 0 1\n"));
  check_is(pose_format::transforms, scratch.file("a", "\xEF\xBB\xBF\n" + transforms));
  check_is(pose_format::opensfm, scratch.file("a", "[{}]"));
  check_is(pose_format::metashape, scratch.file("a", "<?xml version=\"1.0\"?><document/>"));
  check_is(pose_format::reality_capture, scratch.file("a", "#name,x,y,alt\n"));
  check_is(pose_format::npy, scratch.file("a", io::npy_bytes(stack())));
  io::write_npz(scratch.folder() / "a", {{"w2c", stack()}});
  check_is(pose_format::npz, scratch.folder() / "a");
}

TEST_CASE("folders and files of models are told from what lies in them") {
  write_colmap_text("model");
  check_is(pose_format::colmap, scratch.folder() / "model");
  check_is(pose_format::colmap, scratch.folder() / "model" / "images.txt");
  check_is(pose_format::da3, scratch.file("s/camera_poses.txt", "").parent_path());
  check_is(pose_format::transforms, scratch.file("t/transforms.json", "").parent_path());
  check_is(pose_format::opensfm, scratch.file("o/reconstruction.json", "").parent_path());
  check_is(pose_format::npz, scratch.file("c/camera/000000.npz", "").parent_path().parent_path());
}

TEST_CASE("what is not known to hold poses is refused") {
  CHECK_THROWS_WITH_AS(
      static_cast<void>(io::detect_pose_format(scratch.file("a", "1 2 3 4 5 6 7\n"))),
      doctest::Contains("the format of the poses cannot be told from "
                        "'1 2 3 4 5 6 7'; give one as format: tum, kitti"),
      format_error);
  CHECK_THROWS_WITH_AS(
      static_cast<void>(io::detect_pose_format(scratch.file("e/none", "").parent_path())),
      doctest::Contains("expected in the folder, found none"), format_error);
  CHECK_THROWS_WITH_AS(static_cast<void>(io::detect_pose_format(scratch.folder() / "nowhere")),
                       doctest::Contains("cannot open: No such file or directory"), io_error);
}

TEST_CASE("every format comes to the same pose") {
  write_colmap_text("model");
  io::write_npz(scratch.folder() / "c.npz", {{"c2w", stack()}});
  for (const auto& path : {scratch.file("tum.txt", tum_line), scratch.file("kitti.txt", kitti_line),
                           scratch.file("transforms.json", transforms), scratch.folder() / "model",
                           scratch.folder() / "c.npz"}) {
    CAPTURE(path);
    const auto t = io::read_trajectory(path);
    REQUIRE(t.size() == 1);
    CHECK(t.world_from_camera[0].translation == Eigen::Vector3d(1, 2, 3));
    CHECK(t.world_from_camera[0].rotation == Eigen::Matrix3d::Identity());
  }
}

TEST_CASE("options change how poses are read, and are refused where they do not fit") {
  const auto kitti = scratch.file("kitti.txt", kitti_line);
  const auto inverse =
      io::read_trajectory(kitti, {.convention = io::pose_convention::camera_from_world});
  CHECK(inverse.world_from_camera[0].translation == Eigen::Vector3d(-1, -2, -3));
  CHECK(io::read_trajectory(kitti, {.names = {"a.png"}}).names[0] == "a.png");
  CHECK_THROWS_WITH_AS(io::read_trajectory(kitti, {.names = {"a", "b"}}),
                       doctest::Contains("2 names for 1 poses"), format_error);
  CHECK_THROWS_WITH_AS(io::read_trajectory(kitti, {.key = "poses"}),
                       doctest::Contains("the option key does not fit the format kitti"),
                       argument_error);
  CHECK_THROWS_WITH_AS(io::read_trajectory(kitti, {.format = pose_format::tum}),
                       doctest::Contains("kitti.txt:1: tum: 8 numbers"), format_error);
  write_colmap_text("model");
  CHECK_THROWS_WITH_AS(
      io::read_trajectory(scratch.folder() / "model", {.axes = io::camera_axes::opengl}),
      doctest::Contains("the option axes does not fit the format colmap"), argument_error);
  const auto npy = scratch.file("a.npy", io::npy_bytes(stack()));
  CHECK_THROWS_WITH_AS(io::read_trajectory(npy),
                       doctest::Contains("an array does not tell its convention"), argument_error);
}

TEST_CASE("cameras are found by image name, else by index") {
  write_colmap_text("model");
  CHECK(io::read_cameras(scratch.folder() / "model").at("a.png").fx() == 5);
  CHECK(io::read_cameras(scratch.file("transforms.json", transforms)).at("a.png").cx() == 4);
  scratch.file("s/camera_poses.txt", "1 0 0 1 0 1 0 2 0 0 1 3 0 0 0 1\n");
  scratch.file("s/intrinsic.txt", "5 6 7 8\n");
  CHECK(io::read_cameras(scratch.folder() / "s").at("0").fy() == 6);
  CHECK_THROWS_WITH_AS(io::read_cameras(scratch.file("tum.txt", tum_line)),
                       doctest::Contains("no intrinsics in the file"), format_error);
}

TEST_CASE("images come back from the files that we write") {
  const io::posed_images images = three_images();
  for (const char* target : {"out.json", "out_binary", "out_text", "out.tum"}) {
    CAPTURE(target);
    const auto path = scratch.folder() / target;
    const bool text = std::string(target) == "out_text";
    io::write_trajectory(
        path, images, {.encoding = text ? io::colmap_encoding::text : io::colmap_encoding::binary});
    const auto back = io::read_posed_images(path);
    REQUIRE(back.trajectory.size() == 2);
    for (const auto& [written, read] : {std::pair<std::size_t, std::size_t>(0, 0), {2, 1}}) {
      CHECK(support::distance(images.trajectory.world_from_camera.at(written),
                              back.trajectory.world_from_camera.at(read)) < 1e-14);
    }
    if (std::string(target) == "out.tum") continue;
    CHECK(back.trajectory.names == std::vector<std::string>{"a.png", "sub/b.png"});
    CHECK(back.cameras.at(1).parameters == images.cameras[2].parameters);
  }
}

TEST_CASE("a written model keeps its points") {
  io::colmap_model model = io::make_colmap_model(three_images());
  CHECK(model.cameras.size() == 2);
  model.points.origin = {1000, 2000, 3000};
  model.points.points = {{0.5f, 0, 0}, {0, 0.25f, 0}};
  model.points.colors = {{1, 2, 3}, {4, 5, 6}};
  model.point_errors_px = {0.5, 0.75};
  for (const auto encoding : {io::colmap_encoding::text, io::colmap_encoding::binary}) {
    const auto folder = scratch.folder() / "points";
    io::write_colmap(folder, model, encoding);
    const auto back = io::read_colmap(folder);
    REQUIRE(back.points.size() == 2);
    CHECK(back.points.position(0) == Eigen::Vector3d(1000.5, 2000, 3000));
    CHECK(back.points.colors[1] == cloud::color{4, 5, 6});
    CHECK(back.point_errors_px == model.point_errors_px);
  }
}

TEST_CASE("what a format cannot hold is refused before anything is written") {
  const io::posed_images images = three_images();
  CHECK_THROWS_WITH_AS(io::write_trajectory(scratch.folder() / "x.kitti", images),
                       "write_kitti: pose 1 is not registered, which the format cannot say",
                       argument_error);
  CHECK_THROWS_WITH_AS(io::write_trajectory(scratch.folder() / "x.xyz", images),
                       doctest::Contains("the extension .txt, .tum, .kitti, .json or .npy"),
                       argument_error);
  CHECK_THROWS_WITH_AS(
      io::write_trajectory(scratch.folder() / "x", images, {.format = pose_format::euroc}),
      "write_trajectory: euroc is not written; tum, kitti, colmap, transforms, npy are",
      argument_error);
  CHECK_THROWS_WITH_AS(
      io::write_trajectory(scratch.folder() / "x", {images.trajectory, {}}),
      "make_colmap_model: names and cameras for 3 poses expected, found 3 names and 0 cameras",
      argument_error);
  io::posed_images nameless = images;
  nameless.trajectory.names[0] = "line\nend.png";
  CHECK_THROWS_WITH_AS(io::write_trajectory(scratch.folder() / "x", nameless),
                       "write_colmap: pose 0 has a name that cannot be written", argument_error);
  CHECK_FALSE(std::filesystem::exists(scratch.folder() / "x"));
}

TEST_CASE("COLMAP itself reads the models that we write") {
  if (std::system("command -v colmap >/dev/null 2>&1") != 0) {
    MESSAGE("SKIPPED: models read back by COLMAP: colmap is not installed");
    return;
  }
  const io::posed_images images = three_images();
  for (const auto encoding : {io::colmap_encoding::text, io::colmap_encoding::binary}) {
    const auto written = scratch.folder() / "ours";
    const auto converted = scratch.folder() / "converted";
    std::filesystem::remove_all(written);
    std::filesystem::remove_all(converted);
    std::filesystem::create_directories(converted);
    io::write_trajectory(written, images, {.format = pose_format::colmap, .encoding = encoding});
    const std::string command =
        "QT_QPA_PLATFORM=offscreen colmap model_converter --output_type TXT --input_path '" +
        written.string() + "' --output_path '" + converted.string() + "' >/dev/null 2>&1";
    REQUIRE(std::system(command.c_str()) == 0);
    const auto back = io::read_posed_images(converted);
    CHECK(back.trajectory.names == std::vector<std::string>{"a.png", "sub/b.png"});
    CHECK(back.cameras.at(1).parameters == images.cameras[2].parameters);
  }
}

TEST_CASE("the golden stacks of matrices are read as they are") {
  if (!support::has_shared("golden stacks of poses")) return;
  const auto path = support::shared() / "golden" / "auc" / "syn_orbit_noise_a_gt_w2c.npy";
  const auto t = io::read_trajectory(path, {.convention = io::pose_convention::camera_from_world});
  const io::array written = io::read_npy(path);
  REQUIRE(t.size() == written.shape.at(0));
  for (std::size_t i = 0; i < t.size(); ++i) {
    const Eigen::Matrix4d camera_from_world = t.world_from_camera[i].inverse().matrix();
    const std::vector<double> numbers = written.at(i).values<double>();
    for (std::size_t k = 0; k < 12; ++k) {
      const auto r = static_cast<Eigen::Index>(k / 4);
      const auto c = static_cast<Eigen::Index>(k % 4);
      CHECK(camera_from_world(r, c) == doctest::Approx(numbers[k]).epsilon(1e-12).scale(1));
    }
  }
}

}  // namespace test_trajectory
