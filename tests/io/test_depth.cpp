// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/io/bytes.hpp>
#include <aib/io/depth.hpp>

#include <doctest/doctest.h>

#include <string>
#include <support/scratch.hpp>
#include <support/shared.hpp>
#include <vector>

using namespace aib;

namespace {

const support::scratch scratch;

std::string floats(std::initializer_list<float> values) {
  std::string bytes;
  for (const float v : values) io::store(bytes, v);
  return bytes;
}

std::string error_of(const std::filesystem::path& path, const io::depth_options& options = {}) {
  try {
    static_cast<void>(io::read_depth(path, options));
  } catch (const error& e) {
    return std::string(e.what()).substr(path.string().size());
  }
  return "no error";
}

}  // namespace

TEST_CASE("a dense map of colmap is read") {
  const auto path = scratch.file("a.photometric.bin", "3&2&1&" + floats({1, 2, 3, 4, 0, -1}));
  const auto map = io::read_depth(path);
  CHECK(map.values.width() == 3);
  CHECK(map.values(0, 1) == 4);
  CHECK(map.values(2, 1) == -1);
  const auto small = io::read_depth(path, {.scale = 2, .width = 1, .height = 2});
  CHECK(small.values(0, 0) == 1);
  CHECK(small.values(0, 1) == 0);
}

TEST_CASE("a damaged map of colmap is refused") {
  CHECK(error_of(scratch.file("b.bin", "3&2&3&" + floats({1, 2, 3, 4, 5, 6}))) ==
        ": colmap map: 1 channel expected, found 3");
  CHECK(error_of(scratch.file("b.bin", "3&2&1&" + floats({1, 2, 3, 4, 5}))) ==
        ": 3x2 floats expected, the file has 5");
  CHECK(error_of(scratch.file("b.bin", "0&2&1&" + floats({1}))) ==
        ": 0x2 floats expected, the file has 1");
  CHECK(error_of(scratch.file("b.bin", "99999999999&99999999999&1&" + floats({1}))) ==
        ": 99999999999x99999999999 floats expected, the file has 1");
  CHECK(error_of(scratch.file("b.bin", "99999999999999999999999&2&1&" + floats({1}))) ==
        ": colmap map: \"WIDTH&HEIGHT&CHANNELS&\" expected at the begin");
}

TEST_CASE("pixels at max_depth and beyond become 0 and are counted") {
  const auto path = scratch.file("c.bin", "3&1&1&" + floats({1, 20, 30}));
  const auto map = io::read_depth(path, {.max_depth = 20});
  CHECK(map.values(0, 0) == 1);
  CHECK(map.values(1, 0) == 0);
  CHECK(map.values(2, 0) == 0);
  CHECK(map.warnings == std::vector<std::string>{"2 of 3 pixels are at max_depth 20 or beyond"});
}

TEST_CASE("what is no depth map, and options without meaning, are refused") {
  CHECK_THROWS_AS(io::read_depth(scratch.file("d.doc", "hello")), format_error);
  CHECK_THROWS_AS(io::read_depth(scratch.folder() / "missing.exr"), io_error);
  const auto path = scratch.file("e.bin", "1&1&1&" + floats({1}));
  CHECK_THROWS_AS(io::read_depth(path, {.scale = -1}), argument_error);
  CHECK_THROWS_AS(io::read_depth(path, {.max_depth = 0}), argument_error);
}

TEST_CASE("a dense map that colmap wrote is read") {
  if (!support::has_shared("io: colmap map")) return;
  const auto map = io::read_depth(
      support::shared() /
      "scenes/methods/sgbm_gtposes/crane/stereo/depth_maps/000005.png.photometric.bin");
  CHECK(map.values.width() == 480);
  CHECK(map.values.height() == 270);
}
