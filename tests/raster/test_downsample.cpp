// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/raster/downsample.hpp>

#include <doctest/doctest.h>

using namespace aib;
using raster::nearest_rule;

namespace test_downsample {

TEST_CASE("the centre rule takes the pixel under the centre, the floor rule OpenCV's") {
  CHECK(raster::nearest_index(0, 480, 160, nearest_rule::centre) == 1);
  CHECK(raster::nearest_index(0, 480, 160, nearest_rule::floor) == 0);
  CHECK(raster::nearest_index(159, 480, 160, nearest_rule::centre) == 478);
  // 1920 -> 504: the exact tie (2*3+1)*1920/(2*504) is settled in integers.
  CHECK(raster::nearest_index(3, 1920, 504, nearest_rule::centre) == (7 * 1920) / 1008);
}

TEST_CASE("a target of the same size is the source") {
  raster::image<int> source(3, 2);
  int n = 0;
  for (int& p : source) p = n++;
  for (const auto rule : {nearest_rule::centre, nearest_rule::floor}) {
    CHECK(raster::resample_nearest<int>(source.view(), 3, 2, rule) == source);
  }
}

TEST_CASE("values are picked, never mixed") {
  raster::image<int> source(6, 3);
  int n = 0;
  for (int& p : source) p = n++;
  const auto target = raster::resample_nearest<int>(source.view(), 2, 1);
  CHECK(target(0, 0) == 6 + 1);
  CHECK(target(1, 0) == 6 + 4);
}

TEST_CASE("an image that is larger than memory can be is refused, not overflowed") {
  const auto side = std::size_t{1} << 32;
  CHECK_THROWS_WITH_AS(raster::image<float>(side, side),
                       "an image of 4294967296 x 4294967296 pixels is larger than memory can be",
                       argument_error);
}

TEST_CASE("an empty image or target is refused") {
  const raster::image<int> none;
  CHECK_THROWS_AS(raster::resample_nearest<int>(none.view(), 2, 2), argument_error);
  CHECK_THROWS_AS(raster::resample_nearest<int>(raster::image<int>(2, 2).view(), 0, 2),
                  argument_error);
}

}  // namespace test_downsample
