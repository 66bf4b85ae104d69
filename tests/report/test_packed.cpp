// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/report/packed.hpp>
#include <aib/report/packed_depth.hpp>
#include <aib/report/packed_points.hpp>

#include <doctest/doctest.h>
#include <zlib.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

using namespace aib;
using doctest::Approx;

namespace {

constexpr float nothing = std::numeric_limits<float>::quiet_NaN();

std::string inflated(const std::string& stream, std::size_t size) {
  std::string bytes(size, '\0');
  auto n = static_cast<uLongf>(size);
  REQUIRE(uncompress(reinterpret_cast<Bytef*>(bytes.data()), &n,
                     reinterpret_cast<const Bytef*>(stream.data()),
                     static_cast<uLong>(stream.size())) == Z_OK);
  CHECK(n == size);
  return bytes;
}

std::string decoded(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  for (std::size_t i = 0; i < text.size(); i += 4) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 4; ++k)
      group = group << 6 | static_cast<std::uint32_t>(digits.find(text[i + k]) & 63);
    for (std::size_t k = 0; k < 3 && text[i + k + 1] != '='; ++k)
      bytes += static_cast<char>(group >> (16 - 8 * k) & 0xff);
  }
  return bytes;
}

/// A plane of 100 x 100 points, a metre apart.
cloud::cloud plane() {
  cloud::cloud c;
  for (int y = 0; y < 100; ++y)
    for (int x = 0; x < 100; ++x)
      c.points.emplace_back(static_cast<float>(x), static_cast<float>(y), 0.0F);
  return c;
}

}  // namespace

TEST_CASE("base64 has the values of RFC 4648") {
  CHECK(report::base64("").empty());
  CHECK(report::base64("f") == "Zg==");
  CHECK(report::base64("fo") == "Zm8=");
  CHECK(report::base64("foo") == "Zm9v");
  CHECK(report::base64("foobar") == "Zm9vYmFy");
  CHECK(report::base64("\xff\xfe") == "//4=");
}

TEST_CASE("what is deflated comes back") {
  const std::string text(10000, 'x');
  const std::string stream = report::deflated(text);
  CHECK(stream.size() < 100);
  CHECK(inflated(stream, text.size()) == text);
}

TEST_CASE("steps go from the low end to the high end, the last one is for NaN") {
  const report::range r{-1, 3};
  CHECK(report::step_of<std::uint16_t>(-1, r) == 0);
  CHECK(report::step_of<std::uint16_t>(1, r) == 32767);
  CHECK(report::step_of<std::uint16_t>(3, r) == 65534);
  CHECK(report::step_of<std::uint16_t>(1e300, r) == 65534);
  CHECK(report::step_of<std::uint16_t>(-INFINITY, r) == 0);
  CHECK(report::step_of<std::uint8_t>(NAN, r) == 255);
  CHECK(report::step_of<std::uint8_t>(7, {7, 7}) == 0);
}

TEST_CASE("a range passes over what is not finite") {
  const std::vector<float> values = {nothing, 2, -1, INFINITY};
  const auto r = report::range_of<float>(values);
  CHECK(r.low == -1);
  CHECK(r.high == 2);
  const auto none = report::range_of<float>(std::vector<float>{nothing});
  CHECK(none.low == 0);
  CHECK(none.high == 0);
}

TEST_CASE("a cloud is thinned to a point a voxel, no more than the limit") {
  auto points = plane();
  points.points[7].x() = nothing;
  const auto all = report::thin(points, 20000);
  CHECK(all.index.size() == 9999);
  CHECK(all.voxel == 0);
  const auto some = report::thin(points, 1000);
  CHECK(some.index.size() <= 1000);
  CHECK(some.index.size() > 500);
  CHECK(some.voxel > 2);
  CHECK_THROWS_AS((void)report::thin(points, 0), argument_error);
  CHECK(report::thin(cloud::cloud{}, 10).index.empty());
}

TEST_CASE("positions are right to a step of the box, wherever the cloud lies") {
  auto points = plane();
  points.origin = {500000, 5400000, 100};
  std::vector<std::size_t> index(points.size());
  std::iota(index.begin(), index.end(), 0);
  const auto packed = report::packed(points, index);
  CHECK(packed.box.low.x() == 500000);
  const std::string bytes = inflated(decoded(packed.data), 6 * points.size());
  const auto step = [&](std::size_t i) {
    return static_cast<std::uint8_t>(bytes[2 * i]) +
           256U * static_cast<std::uint8_t>(bytes[2 * i + 1]);
  };
  const std::size_t i = 4321;  // x 21, y 43
  CHECK(99.0 * step(3 * i) / 65534 == Approx(21).epsilon(1e-4));
  CHECK(99.0 * step(3 * i + 1) / 65534 == Approx(43).epsilon(1e-4));
}

TEST_CASE("a frame is shrunk to every k-th pixel, and nothing stays nothing") {
  depth::depth_map estimate, reference;
  estimate.values = raster::image<float>(10, 6, 2.2F);
  reference.values = raster::image<float>(10, 6, 2.0F);
  reference.values(1, 1) = 0;
  reference.values(9, 5) = 4.0F;
  const auto frame = report::packed(estimate, reference, {}, 5);
  CHECK(frame.width == 5);
  CHECK(frame.height == 3);
  CHECK(frame.depths.low == Approx(2));
  const std::string error = inflated(decoded(frame.error), 15);
  CHECK(static_cast<std::uint8_t>(error[0]) == 255);
  CHECK(static_cast<std::uint8_t>(error[1]) > 127);
  CHECK(static_cast<std::uint8_t>(error[14]) < 127);
  const auto whole = report::packed(estimate, reference, {}, 100);
  CHECK(whole.width == 10);
}
