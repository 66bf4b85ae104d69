// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/depth/accumulate.hpp>

#include <doctest/doctest.h>

#include "synthetic.hpp"
#include <cstring>
#include <string>
#include <vector>

using namespace aib;
using doctest::Approx;

namespace test_accumulate {

namespace {

depth::frame numbered_frame(std::size_t i) {
  auto maps = synthetic::noisy_frame(
      {.width = 40 + 10 * i, .height = 30, .scale = 0.3 + 0.1 * static_cast<double>(i)});
  return {.name = "frame " + std::to_string(i),
          .estimate = {std::move(maps.estimate)},
          .reference = {std::move(maps.reference)}};
}

void add(depth::accumulator& to, const depth::frame& f) {
  to.add(f.name, f.estimate.values.view(), f.reference.values.view());
}

bool same_bits(const depth::error_summary& a, const depth::error_summary& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

}  // namespace

TEST_CASE("the mean is over frames, pooled over pixels") {
  depth::accumulator all;
  const raster::image<double> one(1, 1, 1), two(3, 1, 2), reference1(1, 1, 1), reference2(3, 1, 1);
  all.add("exact", one.view(), reference1.view());
  all.add("twice as far", two.view(), reference2.view());
  const auto result = all.result();
  CHECK(result.mean.abs_rel == Approx(0.5));
  CHECK(result.pooled.abs_rel == Approx(0.75));
  CHECK(result.mean.srmse == Approx(0));  // each frame has its own scale
  CHECK(result.pooled.srmse > 0.05);      // all pixels have one
  CHECK(result.mean.n_valid == 4);
  CHECK(result.pooled.n_valid == 4);
}

TEST_CASE("a frame without a valid pixel is named, lowers the coverage and spoils nothing else") {
  depth::accumulator all;
  const raster::image<float> depths(4, 4, 2), nothing(4, 4);
  all.add("good", depths.view(), depths.view());
  all.add("lost", nothing.view(), depths.view());
  all.add("sky", nothing.view(), nothing.view());
  const auto result = all.result();
  CHECK(result.n_frames == 3);
  CHECK(result.n_defined == 1);
  CHECK(result.undefined == std::vector<std::string>{"lost", "sky"});
  CHECK(result.mean.mae == 0);
  CHECK(result.mean.delta1 == 1);
  CHECK(result.mean.coverage == 0.5);
  CHECK(result.pooled.coverage == 0.5);
}

TEST_CASE("merged parts are one run to the last bit") {
  depth::accumulator whole({.align = depth::alignment::median});
  depth::accumulator first({.align = depth::alignment::median});
  depth::accumulator second({.align = depth::alignment::median});
  for (std::size_t i = 0; i < 5; ++i) {
    add(whole, numbered_frame(i));
    add(i < 2 ? first : second, numbered_frame(i));
  }
  first += second;
  CHECK(same_bits(first.result().mean, whole.result().mean));
  CHECK(same_bits(first.result().pooled, whole.result().pooled));
}

TEST_CASE("frames loaded by many threads give the bits of one") {
  const auto with = [](unsigned threads) {
    return depth::accumulate(7, {.threads = threads}, numbered_frame).result();
  };
  for (const unsigned threads : {2u, 4u}) {
    CHECK(same_bits(with(threads).mean, with(1).mean));
    CHECK(same_bits(with(threads).pooled, with(1).pooled));
  }
}

TEST_CASE("what a loader throws comes out") {
  const auto load = [](std::size_t i) {
    if (i == 3) throw argument_error("frame 3 is gone");
    return numbered_frame(i);
  };
  CHECK_THROWS_WITH_AS((void)depth::accumulate(5, {}, load), "frame 3 is gone", argument_error);
}

TEST_CASE("the mask of a frame is its own") {
  depth::accumulator all;
  const raster::image<float> estimate(2, 1, 2), reference(2, 1, 1);
  raster::image<std::uint8_t> mask(2, 1, 1);
  mask(0, 0) = 0;
  all.add("masked", estimate.view(), reference.view(), std::as_const(mask).view());
  CHECK(all.result().mean.n_valid == 1);
}

TEST_CASE("worst_first sorts by a field and puts undefined frames last") {
  depth::accumulator all;
  const raster::image<double> reference(2, 1, 1), off(2, 1, 3), near(2, 1, 1.5), nothing(2, 1);
  all.add("lost", nothing.view(), reference.view());
  all.add("near", near.view(), reference.view());
  all.add("off", off.view(), reference.view());
  CHECK(depth::worst_first(all.frames(), &depth::error_summary::mae) ==
        std::vector<std::size_t>{2, 1, 0});
}

TEST_CASE("no frame at all, or none that is valid, is undefined") {
  CHECK_THROWS_AS((void)depth::accumulator().result(), undefined_error);
  depth::accumulator all;
  const raster::image<float> nothing(2, 2);
  all.add("lost", nothing.view(), nothing.view());
  CHECK_THROWS_AS((void)all.result(), undefined_error);
}

}  // namespace test_accumulate
