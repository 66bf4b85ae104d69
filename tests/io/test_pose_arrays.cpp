// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/io/npz_write.hpp>
#include <aib/io/pose_arrays.hpp>
#include <aib/io/pose_npz.hpp>

#include <doctest/doctest.h>

#include <string>
#include <support/pose_distance.hpp>
#include <support/scratch.hpp>
#include <support/shared.hpp>
#include <vector>

using namespace aib;

namespace test_pose_arrays {

namespace {

const support::scratch scratch;

const std::vector<double> row_3x4{1, 0, 0, 1, 0, 1, 0, 2, 0, 0, 1, 3};

io::array poses_at(std::vector<std::size_t> shape) {
  std::vector<double> numbers = row_3x4;
  if (shape.back() == 4 && shape[shape.size() - 2] == 4)
    numbers.insert(numbers.end(), {0, 0, 0, 1});
  return io::make_array<double>(std::move(shape), numbers);
}

io::array intrinsics(double f, double cx, double cy) {
  return io::make_array<double>({1, 3, 3}, std::vector<double>{f, 0, cx, 0, f, cy, 0, 0, 1});
}

std::filesystem::path npz(const std::vector<std::pair<std::string, io::array>>& arrays) {
  const auto path = scratch.folder() / "a.npz";
  io::write_npz(path, arrays);
  return path;
}

io::array depth_of(std::vector<std::size_t> shape) {
  std::size_t n = 1;
  for (const std::size_t extent : shape) n *= extent;
  return io::make_array<float>(std::move(shape), std::vector<float>(n));
}

}  // namespace

TEST_CASE("matrices of 3 x 4 and 4 x 4, one or many, with leading ones, are poses") {
  for (const std::vector<std::size_t>& shape :
       {std::vector<std::size_t>{3, 4}, {4, 4}, {1, 3, 4}, {1, 4, 4}, {1, 1, 4, 4}}) {
    const auto t = io::poses_of_array(poses_at(shape), {}, "a.npy");
    REQUIRE(t.size() == 1);
    CHECK(t.world_from_camera[0].translation == Eigen::Vector3d(1, 2, 3));
  }
  const auto t =
      io::poses_of_array(poses_at({3, 4}), {io::pose_convention::camera_from_world}, "a.npy");
  CHECK(t.world_from_camera[0].translation == Eigen::Vector3d(-1, -2, -3));
}

TEST_CASE("arrays that are no poses are refused") {
  CHECK_THROWS_WITH_AS(io::poses_of_array(io::make_array<double>({4, 3}, row_3x4), {}, "a.npy"),
                       "a.npy: poses: shape (N, 4, 4) or (N, 3, 4) expected, found (4, 3)",
                       format_error);
  std::vector<double> twice = row_3x4;
  twice[0] = 2;
  CHECK_THROWS_WITH_AS(
      io::poses_of_array(io::make_array<double>({3, 4}, twice), {}, "a.npy"),
      "a.npy: poses: matrix 0: the rotation part lies 1 from a rotation, at most 0.01 expected",
      format_error);
  CHECK_THROWS_WITH_AS(
      io::poses_of_array(io::make_array<double>({0, 4, 4}, std::vector<double>()), {}, "a.npy"),
      "a.npy: poses: no pose in the file", format_error);
}

TEST_CASE("poses come back from the array that they become") {
  pose::trajectory t;
  t.world_from_camera = {{math::rotation_from(Eigen::Vector3d(0.1, 0.2, 0.3)), {1, 2, 3}}, {}};
  const io::pose_frame frame{io::pose_convention::camera_from_world, io::camera_axes::opengl};
  const auto back = io::poses_of_array(io::array_of_poses(t, frame), frame, "a.npy");
  for (std::size_t i = 0; i < t.size(); ++i) {
    CHECK(support::distance(back.world_from_camera[i], t.world_from_camera[i]) < 1e-15);
  }
}

TEST_CASE("known array names tell the direction of their poses") {
  const auto vggt = io::read_pose_npz(npz({{"depth", depth_of({1, 2, 4, 1})},
                                           {"extrinsic", poses_at({1, 3, 4})},
                                           {"intrinsic", intrinsics(5, 2, 1)}}));
  CHECK(vggt.trajectory.world_from_camera[0].translation == Eigen::Vector3d(-1, -2, -3));
  REQUIRE(vggt.cameras.size() == 1);
  CHECK(vggt.cameras[0].width == 4);
  CHECK(vggt.cameras[0].height == 2);
  CHECK(vggt.cameras[0].parameters == std::vector<double>{5, 5, 2, 1});
  const auto pi3 = io::read_pose_npz(
      npz({{"camera_poses", poses_at({1, 1, 4, 4})}, {"conf", depth_of({1, 1, 2, 4, 1})}}));
  CHECK(pi3.trajectory.world_from_camera[0].translation == Eigen::Vector3d(1, 2, 3));
  CHECK(pi3.cameras.empty());
}

TEST_CASE("an unknown array of poses needs its convention") {
  const auto path = npz({{"stack", poses_at({4, 4})}});
  CHECK_THROWS_WITH_AS(
      io::read_pose_npz(path),
      doctest::Contains("npz: no array of poses known by its name; give one as key: stack"),
      argument_error);
  CHECK_THROWS_WITH_AS(io::read_pose_npz(path, {.key = "stack"}),
                       doctest::Contains("npz: 'stack' does not tell its convention"),
                       argument_error);
  const auto images = io::read_pose_npz(
      path, {.key = "stack", .convention = io::pose_convention::world_from_camera});
  CHECK(images.trajectory.world_from_camera[0].translation == Eigen::Vector3d(1, 2, 3));
}

TEST_CASE("intrinsics of the original image are scaled to the depth map, with a warning") {
  // The images were 40 x 20, the depth map is 4 x 2: a tenth.
  const auto images = io::read_pose_npz(npz({{"depth", depth_of({1, 2, 4})},
                                             {"extrinsics", poses_at({1, 3, 4})},
                                             {"intrinsics", intrinsics(50, 20, 10)}}));
  CHECK(images.cameras[0].fx() == doctest::Approx(5).epsilon(1e-15));
  CHECK(images.cameras[0].cx() == 2);
  CHECK(images.trajectory.warnings ==
        std::vector<std::string>{"1 of 1 intrinsics belong to a larger image than the depth "
                                 "maps: scaled to these"});
}

TEST_CASE("what the networks' own exporters leave is read") {
  if (!support::has_shared("exports of DA3, VGGT, pi3")) return;
  const auto methods = support::shared() / "scenes" / "batched" / "methods";
  const auto da3 = io::read_pose_npz(methods / "da3/crane/batch_000/exports/mini_npz/results.npz");
  CHECK(da3.trajectory.size() == 31);
  CHECK(da3.cameras.at(0).width == 168);
  CHECK(da3.cameras.at(0).height == 98);
  const auto vggt = io::read_pose_npz(methods / "vggt/crane/batch_003/predictions.npz");
  CHECK(vggt.trajectory.size() == 6);
  CHECK(vggt.cameras.at(0).cx() == 70);
  const auto pi3 = io::read_pose_npz(methods / "pi3/crane/batch_006/res.npz");
  CHECK(pi3.trajectory.size() == 9);
  const auto cut3r = io::read_pose_npz(methods / "cut3r/office/batch_000/camera/000003.npz");
  CHECK(cut3r.trajectory.size() == 1);
  const auto folder = io::read_pose_npz_folder(methods / "cut3r/office/batch_000/camera");
  CHECK(folder.trajectory.size() == 22);
  CHECK(folder.trajectory.names.at(3) == "000003");
  CHECK(support::distance(folder.trajectory.world_from_camera.at(3),
                          cut3r.trajectory.world_from_camera.at(0)) == 0);
  CHECK(folder.cameras.size() == 22);
  CHECK(cut3r.cameras.size() == 1);
}

}  // namespace test_pose_arrays
