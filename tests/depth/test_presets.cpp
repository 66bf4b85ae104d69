// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/depth/presets.hpp>

#include <doctest/doctest.h>

#include "synthetic.hpp"
#include <utility>

using namespace aib;
using depth::preset;
using doctest::Approx;

namespace test_presets {

namespace {

/// A frame of the reference depth everywhere and an estimate in the frame's own scale.
depth::frame flat_frame(std::size_t i) {
  const auto depth = static_cast<float>(i + 2);
  const float scale = i % 2 ? 0.5f : 0.25f;
  return {.name = std::to_string(i),
          .estimate = {raster::image<float>(10, 10, depth * scale)},
          .reference = {raster::image<float>(10, 10, depth)}};
}

}  // namespace

TEST_CASE("crops cut the pixels of the published shares") {
  const raster::image<float> kitti(1242, 375, 1);
  const auto garg = depth::cropped(kitti.view(), depth::crop_rule::garg);
  CHECK(garg.width == 1197 - 44);
  CHECK(garg.height == 371 - 153);
  CHECK(garg.data == &kitti(44, 153));
  const auto eigen = depth::cropped(kitti.view(), depth::crop_rule::eigen);
  CHECK(eigen.data == &kitti(44, 124));
  CHECK(eigen.height == 342 - 124);
  CHECK(depth::cropped(kitti.view(), depth::crop_rule::none).size() == kitti.size());
}

TEST_CASE("a crop leaves estimate, reference and mask outside of it alone") {
  raster::image<float> estimate(100, 100, 2), reference(100, 100, 1);
  raster::image<std::uint8_t> mask(100, 100, 1);
  for (std::size_t x = 0; x < 100; ++x) reference(x, 10) = 50;
  const auto result = depth::errors(std::as_const(estimate).view(), std::as_const(reference).view(),
                                    {.mask = mask, .crop = depth::crop_rule::garg});
  CHECK(result.mae == 1);
  CHECK(result.n_reference == (96 - 3) * (99 - 40));
}

TEST_CASE("monodepth2 scales each image by medians, cuts and clamps") {
  const auto options = depth::options_of(preset::monodepth2);
  const auto result = depth::accumulate(4, options, flat_frame).result();
  CHECK(result.mean.mae == Approx(0));
  CHECK(result.mean.scale == Approx(3));
  CHECK(options.errors.clamp_max == 80);
}

TEST_CASE("cut3r and pi3 scale a sequence by one median, so that frames of other scale show") {
  for (const preset p : {preset::cut3r, preset::pi3}) {
    const auto result = depth::accumulate(4, depth::options_of(p), flat_frame);
    // Lower medians: of references 2, 3, 4, 5 it is 3, of estimates 0.5, 1, 1.5, 2.5 it is 1.
    for (const auto& frame : result.frames()) CHECK(frame.transform.scale == 3);
    CHECK(result.result().mean.mae > 0.5);
  }
}

TEST_CASE("paper and kitti compare the maps as they are") {
  for (const preset p : {preset::paper, preset::kitti}) {
    CHECK(depth::options_of(p).errors.align == depth::alignment::none);
    CHECK(depth::accumulate(1, depth::options_of(p), flat_frame).result().mean.mae == 1.5);
  }
}

TEST_CASE("a sequence fit does not depend on the threads, and needs a valid pixel") {
  auto options = depth::options_of(preset::pi3);
  options.threads = 1;
  const double one = depth::accumulate(6, options, flat_frame).result().mean.rmse;
  options.threads = 3;
  CHECK(depth::accumulate(6, options, flat_frame).result().mean.rmse == one);
  const auto nothing = [](std::size_t) {
    return depth::frame{.name = "empty",
                        .estimate = {raster::image<float>(2, 2)},
                        .reference = {raster::image<float>(2, 2)}};
  };
  CHECK_THROWS_AS((void)depth::accumulate(2, options, nothing), undefined_error);
}

}  // namespace test_presets
