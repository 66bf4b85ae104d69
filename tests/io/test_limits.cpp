// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/io/cloud.hpp>
#include <aib/io/depth.hpp>
#include <aib/io/image.hpp>
#include <aib/io/limits.hpp>
#include <aib/io/mesh.hpp>

#include <doctest/doctest.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <support/scratch.hpp>
#include <support/shared.hpp>

using namespace aib;

namespace test_limits {

namespace {

const support::scratch scratch;

/// What a reader says of a file, without the folder; empty where it reads it.
template <class Read>
std::string said(Read&& read) {
  try {
    static_cast<void>(read());
    return "";
  } catch (const format_error& e) {
    const std::string text = e.what();
    return text.substr(text.rfind('/') + 1);
  }
}

TEST_CASE("a depth map larger than the limit is refused, whatever its format") {
  const raster::image<float> depth(4, 3, 1.0f);
  for (const char* name : {"a.exr", "a.png", "a.pfm", "a.npy"}) {
    CAPTURE(name);
    const auto path = scratch.folder() / name;
    io::write_depth(path, depth);
    const auto read = [&](std::uint64_t most) {
      return said([&] { return io::read_depth(path, {.limits = {.max_pixels = most}}); });
    };
    CHECK(read(12).empty());
    CHECK(read(11).ends_with(": 4x3 pixels, at most 11 are allowed (max_pixels)"));
    CHECK(read(11).starts_with(name));
    CHECK(said([&] { return io::read_depth_stack(path, {.limits = {.max_pixels = 11}}); }) ==
          read(11));
  }
}

#if defined(AIB_WITH_PNG)
TEST_CASE("a picture larger than the limit is refused") {
  const auto path = scratch.folder() / "labels.png";
  io::write_image<std::uint16_t>(path, raster::label_image(4, 3));
  const std::string expected = "labels.png: png: 4x3 pixels, at most 11 are allowed (max_pixels)";
  CHECK(said([&] { return io::read_labels(path, {.max_pixels = 11}); }) == expected);
  CHECK(said([&] { return io::read_image(path, {.max_pixels = 11}); }) == expected);
  CHECK(said([&] { return io::is_label_image(path, {.max_pixels = 11}); }) == expected);
  CHECK(said([&] { return io::read_labels(path, {.max_pixels = 12}); }).empty());
}
#endif

#if defined(AIB_WITH_JPEG)
TEST_CASE("a jpeg larger than the limit, or than its bytes can hold, is refused") {
  if (!support::has_shared("io: limits of a jpeg")) return;
  const auto path = support::shared() / "scenes/images_sample/crane/000000.jpg";
  CHECK(said([&] { return io::read_image(path, {.max_pixels = 1000}); }) ==
        "000000.jpg: jpeg: 480x270 pixels, at most 1000 are allowed (max_pixels)");
  std::string bytes = io::read_file(path);
  const std::size_t frame = bytes.find("\xff\xc0");
  REQUIRE(frame != std::string::npos);
  bytes.replace(frame + 5, 4, "\x27\x10\x27\x10");  // 10 000 x 10 000
  const std::string size = std::to_string(bytes.size());
  CHECK(said([&] { return io::read_image(scratch.file("huge.jpg", bytes)); }) ==
        "huge.jpg: jpeg: 10000x10000 pixels in a file of " + size + " bytes");
}
#endif

TEST_CASE("a cloud or a mesh larger than the limit is refused") {
  const auto path = scratch.file("a.obj",
                                 "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
                                 "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  const auto mesh = [&](std::uint64_t most) {
    return said([&] { return io::read_mesh(path, {.limits = {.max_points = most}}); });
  };
  CHECK(mesh(4).empty());
  CHECK(mesh(3) == "a.obj: 4 vertices, at most 3 are allowed (max_points)");
  const auto cloud = [&](std::uint64_t most) {
    return said([&] { return io::read_cloud(path, {.limits = {.max_points = most}}); });
  };
  CHECK(cloud(4).empty());
  CHECK(cloud(3) == "a.obj: 4 points, at most 3 are allowed (max_points)");
  const auto packed = scratch.file("a.pcd",
                                   "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n"
                                   "WIDTH 9\nHEIGHT 1\nPOINTS 9\nDATA binary_compressed\n");
  CHECK(said([&] { return io::read_cloud(packed, {.limits = {.max_points = 8}}); }) ==
        "a.pcd: 9 points, at most 8 are allowed (max_points)");
}

}  // namespace
}  // namespace test_limits
