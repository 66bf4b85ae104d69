// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/raster/canny.hpp>

#include <doctest/doctest.h>

#include <cstddef>
#include <cstdint>
#include <limits>

using namespace aib;

namespace test_canny {

namespace {

raster::image<float> step(std::size_t at, float height) {
  raster::image<float> picture(40, 30);
  for (std::size_t y = 0; y < 30; ++y)
    for (std::size_t x = at; x < 40; ++x) picture(x, y) = height;
  return picture;
}

std::size_t count(const raster::image<std::uint8_t>& edges) {
  std::size_t n = 0;
  for (const std::uint8_t e : edges) n += e;
  return n;
}

}  // namespace

TEST_CASE("a step is an edge along it, and the border is none") {
  const auto edges = raster::canny(step(20, 1).view());
  for (std::size_t y = 1; y < 29; ++y) CHECK(edges(19, y) + edges(20, y) >= 1);
  for (std::size_t y = 0; y < 30; ++y) {
    CHECK(edges(17, y) == 0);
    CHECK(edges(22, y) == 0);
  }
  for (std::size_t x = 0; x < 40; ++x) CHECK(edges(x, 0) + edges(x, 29) == 0);
}

TEST_CASE("a weak step continues an edge and begins none") {
  const raster::canny_options options{.low = 0.2, .high = 1};
  CHECK(count(raster::canny(step(20, 0.25F).view(), options)) == 0);
  auto picture = step(20, 0.25F);
  for (std::size_t y = 0; y < 30; ++y)
    for (std::size_t x = 20; x < 40; ++x) picture(x, y) = 1 - 0.025F * static_cast<float>(y);
  const auto edges = raster::canny(picture.view(), options);
  CHECK(edges(19, 25) + edges(20, 25) >= 1);
}

TEST_CASE("NaN hides the edges near it and no others") {
  auto picture = step(20, 1);
  picture(20, 5) = std::numeric_limits<float>::quiet_NaN();
  const auto edges = raster::canny(picture.view());
  CHECK(edges(19, 5) + edges(20, 5) == 0);
  CHECK(edges(19, 25) + edges(20, 25) >= 1);
}

TEST_CASE("flat, tiny and empty pictures have no edge") {
  CHECK(count(raster::canny(raster::image<float>(20, 20, 3).view())) == 0);
  CHECK(count(raster::canny(raster::image<float>(2, 2, 3).view())) == 0);
  CHECK(raster::canny(raster::image<float>().view()).empty());
}

}  // namespace test_canny
