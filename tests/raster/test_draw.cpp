// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/raster/draw.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

using namespace aib;
using raster::color_image;
using raster::rgb;

namespace test_draw {

namespace {

constexpr rgb black = {0, 0, 0}, white = {255, 255, 255}, red = {255, 0, 0};

std::ptrdiff_t count(const color_image& image, const rgb& color) {
  return std::count(image.begin(), image.end(), color);
}

}  // namespace

TEST_CASE("paste cuts off what lies outside") {
  color_image onto(4, 4, white);
  raster::paste(onto, color_image(3, 3, red), 2, 3);
  CHECK(count(onto, red) == 2);
  raster::paste(onto, color_image(3, 3, red), 9, 9);
  CHECK(count(onto, red) == 2);
}

TEST_CASE("a number is drawn in dots of the scale") {
  color_image image(30, 20, white);
  raster::draw_number(image, "1", 0, 0, black, 1);
  CHECK(count(image, black) == 8);
  CHECK(image(1, 0) == black);
  CHECK(image(0, 4) == black);
  CHECK(image(0, 0) == white);
  raster::draw_number(image, "-", 10, 0, black, 2);
  CHECK(count(image, black) == 8 + 3 * 4);
}

TEST_CASE("unknown characters are blank and numbers stop at the edge") {
  color_image image(5, 5, white);
  raster::draw_number(image, "x", 0, 0, black, 1);
  CHECK(count(image, black) == 0);
  raster::draw_number(image, "888888", 3, 3, black, 2);
  CHECK(count(image, black) > 0);
}

TEST_CASE("a contact sheet sets pictures in rows on white") {
  const std::vector<color_image> pictures(5, color_image(40, 20, red));
  const auto sheet = raster::contact_sheet(pictures, 3, 20);
  CHECK(sheet.width() == 3 * 26 + 6);
  CHECK(sheet.height() == 2 * 16 + 6);
  CHECK(count(sheet, red) == 5 * 20 * 10);
  CHECK(raster::contact_sheet({}, 3, 20).empty());
}

}  // namespace test_draw
