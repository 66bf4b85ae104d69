// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/raster/colormap.hpp>

#include <doctest/doctest.h>

#include <cmath>

using namespace aib;
using doctest::Approx;
using raster::rgb;

namespace test_colormap {

namespace {

double distance(const rgb& a, const rgb& b) {
  const auto x = raster::to_oklab(a), y = raster::to_oklab(b);
  return std::hypot(x.lightness - y.lightness, x.a - y.a, x.b - y.b);
}

}  // namespace

TEST_CASE("OKLab has the published values, and leads back") {
  const auto red = raster::to_oklab({255, 0, 0});
  CHECK(red.lightness == Approx(0.628).epsilon(1e-3));
  CHECK(red.a == Approx(0.225).epsilon(1e-2));
  CHECK(red.b == Approx(0.126).epsilon(1e-2));
  for (const rgb& c : {rgb{0, 0, 0}, rgb{255, 255, 255}, rgb{12, 200, 99}, rgb{255, 0, 255}})
    CHECK(raster::to_rgb(raster::to_oklab(c)) == c);
}

TEST_CASE("the sequential colours get lighter in equal steps") {
  const double whole = distance(raster::sequential_color(0), raster::sequential_color(1));
  for (int i = 0; i < 16; ++i) {
    const rgb a = raster::sequential_color(i / 16.0), b = raster::sequential_color((i + 1) / 16.0);
    CHECK(raster::to_oklab(a).lightness < raster::to_oklab(b).lightness);
    CHECK(distance(a, b) == Approx(whole / 16).epsilon(0.12));
  }
}

TEST_CASE("the diverging colours are light in the middle and as dark at both ends") {
  const auto lightness = [](double t) {
    return raster::to_oklab(raster::diverging_color(t)).lightness;
  };
  CHECK(lightness(-1) == Approx(lightness(1)).epsilon(0.15));
  CHECK(lightness(0) > 0.9);
  CHECK(lightness(-0.5) < lightness(0));
  CHECK(lightness(0.5) < lightness(0));
}

TEST_CASE("numbers beyond the ends, and NaN, have the colour of an end") {
  CHECK(raster::sequential_color(7) == raster::sequential_color(1));
  CHECK(raster::sequential_color(-7) == raster::sequential_color(0));
  CHECK(raster::sequential_color(NAN) == raster::sequential_color(0));
  CHECK(raster::diverging_color(-7) == raster::diverging_color(-1));
  CHECK(raster::diverging_color(NAN) == raster::diverging_color(0));
}

}  // namespace test_colormap
