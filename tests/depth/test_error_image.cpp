// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/depth/error_image.hpp>

#include <doctest/doctest.h>

#include <utility>

using namespace aib;

namespace test_error_image {

namespace {

constexpr std::size_t gap = 6;

/// A 60x40 frame: left half right, right half 10 % too far, a hole and a sky corner.
struct frame {
  depth::depth_map estimate{raster::image<float>(60, 40)};
  depth::depth_map reference{raster::image<float>(60, 40)};

  frame() {
    for (std::size_t y = 0; y < 40; ++y) {
      for (std::size_t x = 0; x < 60; ++x) {
        const auto depth = static_cast<float>(2 + x);
        reference.values(x, y) = depth;
        estimate.values(x, y) = x < 30 ? depth : 1.1f * depth;
      }
    }
    estimate.values(3, 3) = 0;
    reference.values(50, 30) = 0;
  }
};

}  // namespace

TEST_CASE("an error image has three panels above their scales") {
  const frame f;
  const auto image = depth::error_image(f.estimate, f.reference);
  CHECK(image.width() == 3 * 60 + 4 * gap);
  CHECK(image.height() > 40 + 3 * gap + 12);
  CHECK(image(0, 0) == raster::rgb{255, 255, 255});
}

TEST_CASE("depths share one scale, errors are grey, red where too far, blue where too near") {
  const frame f;
  const auto image =
      depth::error_image(f.estimate, f.reference, {.near = 2, .far = 61, .largest = 0.1});
  const std::size_t second = 60 + 2 * gap, third = 2 * 60 + 3 * gap;
  CHECK(image(gap, gap) == raster::sequential_color(0));
  CHECK(image(gap, gap) == image(second, gap));
  CHECK(image(second + 59, gap) == raster::sequential_color(1));
  CHECK(image(third + 10, gap + 5) == raster::diverging_color(0));
  CHECK(image(third + 40, gap + 5) == raster::diverging_color(1));
  const auto swapped = depth::error_image(f.reference, f.estimate, {.largest = 0.05});
  CHECK(swapped(third + 40, gap + 5) == raster::diverging_color(-1));
}

TEST_CASE("pixels without a value are hatched, in the panels where they have none") {
  const frame f;
  const auto image = depth::error_image(f.estimate, f.reference);
  const auto is_grey = [&](std::size_t x, std::size_t y) {
    return image(x, y) == raster::rgb{95, 95, 95} || image(x, y) == raster::rgb{120, 120, 120};
  };
  const std::size_t second = 60 + 2 * gap, third = 2 * 60 + 3 * gap;
  CHECK(is_grey(gap + 3, gap + 3));
  CHECK_FALSE(is_grey(second + 3, gap + 3));
  CHECK(is_grey(third + 3, gap + 3));
  CHECK(is_grey(second + 50, gap + 30));
}

TEST_CASE("the estimate is shown as it is aligned") {
  frame f;
  f.estimate = f.reference;
  for (float& v : f.estimate.values) v *= 0.37f;
  const auto image = depth::error_image(
      f.estimate, f.reference, {.errors = {.align = depth::alignment::median}, .largest = 0.01});
  CHECK(image(2 * 60 + 3 * gap + 10, gap + 5) == raster::diverging_color(0));
}

TEST_CASE("nothing to show is undefined, two sizes are refused") {
  const frame f;
  const depth::depth_map nothing{raster::image<float>(60, 40)}, small{raster::image<float>(6, 4)};
  CHECK_THROWS_AS((void)depth::error_image(nothing, f.reference), undefined_error);
  CHECK_THROWS_AS((void)depth::error_image(small, f.reference), argument_error);
}

}  // namespace test_error_image
