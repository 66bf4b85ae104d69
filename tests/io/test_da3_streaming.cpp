// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/io/da3_streaming.hpp>

#include <doctest/doctest.h>

#include <support/scratch.hpp>

using namespace aib;

namespace test_da3_streaming {

TEST_CASE("streaming leaves poses and intrinsics line by line") {
  const support::scratch scratch;
  scratch.file("camera_poses.txt",
               "1 0 0 1 0 1 0 2 0 0 1 3 0 0 0 1\n1 0 0 4 0 1 0 5 0 0 1 6 0 0 0 1\n");
  CHECK(io::read_da3_streaming(scratch.folder()).cameras.empty());
  scratch.file("intrinsic.txt", "500 501 252 140\n510 511 252 140\n");
  const auto images = io::read_da3_streaming(scratch.folder());
  CHECK(images.trajectory.world_from_camera[1].translation == Eigen::Vector3d(4, 5, 6));
  CHECK(images.cameras[1].fy() == 511);
  scratch.file("intrinsic.txt", "500 501 252 140\n");
  CHECK_THROWS_WITH_AS(
      io::read_da3_streaming(scratch.folder() / "camera_poses.txt"),
      doctest::Contains("intrinsic.txt: a line for each of the 2 poses expected, found 1"),
      format_error);
}

}  // namespace test_da3_streaming
