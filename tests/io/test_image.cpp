// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/io/image.hpp>

#include <doctest/doctest.h>

#include <cstdint>
#include <string>
#include <support/scratch.hpp>
#include <support/shared.hpp>

using namespace aib;

namespace test_image {

namespace {

const support::scratch scratch;

}  // namespace

#if defined(AIB_WITH_PNG)

TEST_CASE("images that are written are read again as they were") {
  const auto path = scratch.folder() / "a.png";
  raster::color_image color(3, 2);
  color(2, 1) = {10, 20, 30};
  io::write_image<raster::rgb>(path, color);
  CHECK(io::read_image(path) == color);
  CHECK_FALSE(io::is_label_image(path));
  CHECK_THROWS_AS(io::read_labels(path), format_error);

  raster::label_image labels(3, 2);
  labels(0, 1) = 40000;
  io::write_image<std::uint16_t>(path, labels);
  CHECK(io::is_label_image(path));
  CHECK(io::read_labels(path) == labels);

  raster::image<std::uint8_t> gray(3, 2);
  gray(1, 0) = 200;
  io::write_image<std::uint8_t>(path, gray);
  CHECK(io::read_labels(path)(1, 0) == 200);
  CHECK(io::read_image(path)(1, 0) == raster::rgb{200, 200, 200});

  raster::image<std::array<std::uint8_t, 4>> rgba(3, 2);
  rgba(1, 1) = {1, 2, 3, 4};
  io::write_image<std::array<std::uint8_t, 4>>(path, rgba);
  CHECK(io::read_png_rgba(path) == rgba);
  CHECK(io::read_image(path)(1, 1) == raster::rgb{1, 2, 3});
  CHECK_THROWS_AS(io::read_labels(path), format_error);
}

TEST_CASE("a png that is cut or changed is refused, or read, nothing worse") {
  raster::label_image labels(40, 30);
  for (std::size_t i = 0; i < labels.size(); ++i) labels.data()[i] = static_cast<std::uint16_t>(i);
  const auto path = scratch.folder() / "b.png";
  io::write_image<std::uint16_t>(path, labels);
  const std::string whole = io::read_file(path);
  for (std::size_t n = 0; n + 40 < whole.size(); n += 1 + n / 40)
    CHECK_THROWS_AS(io::read_png_gray(scratch.file("cut.png", whole.substr(0, n))), format_error);
  for (std::size_t at = 0; at < whole.size(); at += 3) {
    std::string changed = whole;
    changed[at] = static_cast<char>(changed[at] ^ (1 << at % 8));
    const auto file = scratch.file("changed.png", changed);
    try {
      static_cast<void>(io::read_png_gray(file));
    } catch (const format_error&) {
    }
  }
}

TEST_CASE("writing an image refuses what it cannot write") {
  CHECK_THROWS_AS(
      io::write_image<raster::rgb>(scratch.folder() / "a.bmp", raster::color_image(1, 1)),
      argument_error);
  CHECK_THROWS_AS(io::write_image<raster::rgb>(scratch.folder() / "a.png", raster::color_image()),
                  argument_error);
}

#endif

#if defined(AIB_WITH_JPEG)

TEST_CASE("a jpeg of the rendered scenes is read, one that is cut is refused") {
  const auto cut = scratch.file("cut.jpg", "\xff\xd8\xff\xe0 no more");
  CHECK_THROWS_AS(io::read_image(cut), format_error);
  if (!support::has_shared("io: jpeg")) return;
  const auto path = support::shared() / "scenes/images_sample/crane/000000.jpg";
  const auto image = io::read_image(path);
  CHECK(image.width() == 480);
  CHECK(image.height() == 270);
  const std::string whole = io::read_file(path);
  CHECK_THROWS_AS(io::read_image(scratch.file("half.jpg", whole.substr(0, whole.size() / 2))),
                  format_error);
}

#endif

TEST_CASE("what is no image is refused") {
  CHECK_THROWS_AS(io::read_image(scratch.file("a.doc", "hello")), format_error);
  CHECK_THROWS_AS(io::read_labels(scratch.file("a.doc", "hello")), format_error);
  CHECK_THROWS_AS(io::read_image(scratch.folder() / "missing.png"), io_error);
}

}  // namespace test_image
