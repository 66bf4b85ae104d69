// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/math/camera.hpp>

#include <doctest/doctest.h>

using namespace aib;
using namespace aib::math;

namespace test_camera {

TEST_CASE("models are found by COLMAP's number and name") {
  CHECK(find_camera_model(2) == camera_model::simple_radial);
  CHECK(find_camera_model("THIN_PRISM_FISHEYE") == camera_model::thin_prism_fisheye);
  CHECK(!find_camera_model(18));
  CHECK(!find_camera_model(-1));
  CHECK(!find_camera_model("PINHOLE "));
}

TEST_CASE("focal length and principal point are read in the model's own order") {
  const camera shared{camera_model::simple_radial, 640, 480, {500, 320, 240, 0.1}};
  CHECK(shared.fx() == 500);
  CHECK(shared.fy() == 500);
  CHECK(shared.cx() == 320);
  CHECK(shared.cy() == 240);
  const camera own = pinhole(640, 480, 500, 510, 320, 240);
  CHECK(own.fy() == 510);
  CHECK(own.cy() == 240);
}

TEST_CASE("a camera without a focal length says so") {
  const camera panorama{camera_model::equirectangular, 2000, 1000, {2000, 1000}};
  CHECK(!panorama.has_focal());
  CHECK_THROWS_WITH_AS((void)panorama.fx(), "camera: EQUIRECTANGULAR has no focal length",
                       argument_error);
  CHECK_THROWS_WITH_AS((void)(camera{camera_model::pinhole, 2, 2, {1}}.cx()),
                       "camera: PINHOLE expects 4 parameters, found 1", argument_error);
}

}  // namespace test_camera
