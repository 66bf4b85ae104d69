// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/io/bytes.hpp>
#include <aib/io/depth.hpp>
#include <aib/io/depth_frame.hpp>
#include <aib/io/npy.hpp>
#if defined(AIB_WITH_NPZ)
#include <aib/io/npz_write.hpp>
#endif

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <support/scratch.hpp>
#include <support/shared.hpp>
#include <utility>
#include <vector>

using namespace aib;

namespace test_depth {

namespace {

const support::scratch scratch;

std::string floats(std::initializer_list<float> values) {
  std::string bytes;
  for (const float v : values) io::store(bytes, v);
  return bytes;
}

std::vector<float> values(const depth::depth_map& map) {
  return {map.values.begin(), map.values.end()};
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

TEST_CASE("a pfm is read in both byte orders, the last row first") {
  const auto little = scratch.file("a.pfm", "Pf\n2 2\n-1.0\n" + floats({3, 4, 1, 2}) + "more");
  CHECK(values(io::read_depth(little)) == std::vector<float>{1, 2, 3, 4});
  std::string big = "Pf 1 2 5.0 ";
  io::store(big, 2.0f, std::endian::big);
  io::store(big, 1.0f, std::endian::big);
  const auto map = io::read_depth(scratch.file("b.pfm", big));
  CHECK(values(map) == std::vector<float>{1, 2});
  CHECK(map.warnings == std::vector<std::string>{"the scale 5 in the header was ignored"});
}

TEST_CASE("a damaged pfm is refused") {
  const auto refused = [](const std::string& bytes) {
    return error_of(scratch.file("c.pfm", bytes));
  };
  CHECK(refused("PF\n1 1\n-1\n" + floats({1, 2, 3})) ==
        ": pfm: a gray map (Pf) expected, found colours (PF)");
  CHECK(refused("P6\n1 1\n-1\n" + floats({1})) == ": pfm: the tag Pf expected at the begin");
  CHECK(refused("Pf\n1 -1\n-1\n" + floats({1})) == ": pfm: the height expected, found \"-1\"");
  CHECK(refused("Pf\n1 1\n0\n" + floats({1})) == ": pfm: a scale other than 0 expected");
  CHECK(refused("Pf\n1 1\nnan\n" + floats({1})) == ": pfm: a scale other than 0 expected");
  CHECK(refused("Pf\n1 1") == ": pfm: the height expected, the header ends");
  CHECK(refused("Pf\n2 2\n-1\n" + floats({1})) == ": 2x2 floats expected, the file has 1");
  CHECK(refused("Pf\n4294967296 4294967296\n-1\n" + floats({1})) ==
        ": 4294967296x4294967296 floats expected, the file has 1");
}

TEST_CASE("depth arrays of any number of frames are read") {
  const auto path = scratch.folder() / "a.npy";
  std::vector<float> numbers(24);
  std::iota(numbers.begin(), numbers.end(), 0.0f);
  const auto write = [&](std::vector<std::size_t> shape) {
    io::write_npy(path, io::make_array<float>(std::move(shape), numbers));
  };
  write({4, 6});
  CHECK(values(io::read_depth(path)) == numbers);
  write({1, 4, 6, 1});
  CHECK(io::read_depth(path).values.width() == 6);
  write({2, 3, 4, 1});
  CHECK(error_of(path) == ": 2 frames in the array; the option index says which to read");
  CHECK(io::read_depth(path, {.index = 1}).values(0, 0) == 12);
  CHECK_THROWS_AS(io::read_depth(path, {.index = 2}), argument_error);
  const auto stack = io::read_depth_stack(path, {.scale = 2});
  REQUIRE(stack.size() == 2);
  CHECK(stack[1].values(3, 2) == 11.5f);
  write({24});
  CHECK(error_of(path) == ": an array of H x W or N x H x W expected, found (24,)");
  write({2, 2, 2, 3});
  CHECK(error_of(path) == ": an array of H x W or N x H x W expected, found (2, 2, 2, 3)");
  CHECK(io::read_depth(path, {.key = "local_points", .index = 1}).values(0, 0) == 14);
}

#if defined(AIB_WITH_NPZ)

TEST_CASE("the depth of an npz is found by its name") {
  const auto array = [](float value) {
    return io::make_array<float>({1, 2}, std::vector{value, 1.0f});
  };
  const auto path = scratch.folder() / "a.npz";
  io::write_npz(path, {{"conf", array(2)}, {"depth", array(3)}});
  CHECK(io::read_depth(path).values(0, 0) == 3);
  CHECK(io::read_depth(path, {.key = "conf"}).values(0, 0) == 2);
  CHECK(error_of(path, {.key = "dept"}) == ": npz: no array \"dept\"; there are conf, depth");
  io::write_npz(path, {{"a", array(2)}, {"b", array(3)}});
  CHECK(error_of(path) == ": npz: no array is called depth; name one of a, b");
  io::write_npz(path, {{"a", array(2)}});
  CHECK(io::read_depth(path).values(0, 0) == 2);
}

#endif

TEST_CASE("openmvs depth is read in both layouts") {
  const auto head = [](const char* tag, int exponent) {
    std::string bytes = tag;
    bytes += '\x03';
    bytes += static_cast<char>(exponent);
    for (const std::uint32_t n : {200u, 100u, 2u, 1u}) io::store(bytes, n);
    bytes += floats({0, 9});
    if (bytes[1] == '2') bytes += floats({1});
    io::store(bytes, std::uint16_t{3});
    bytes += "a.b";
    for (const std::uint32_t n : {2u, 7u, 8u}) io::store(bytes, n);
    return bytes + std::string(21 * 8, '\0');
  };
  const std::string classic = head("DR", 9) + floats({5, 0});
  CHECK(values(io::read_depth(scratch.file("a.dmap", classic))) == std::vector<float>{5, 0});
  std::string quantised = head("D2", -1);
  io::store(quantised, std::uint16_t{0x4200});
  io::store(quantised, std::uint16_t{0});
  CHECK(values(io::read_depth(scratch.file("b.dmap", quantised))) == std::vector<float>{1.5f, 0});
  for (std::size_t n = 0; n < classic.size(); n += 5)
    CHECK_THROWS_AS(io::read_depth(scratch.file("c.dmap", classic.substr(0, n))), format_error);
  std::string no_depth = classic;
  no_depth[2] = 2;
  CHECK(error_of(scratch.file("d.dmap", no_depth)) == ": byte 3: dmap: no depth in the file");
}

TEST_CASE("floats without a header are read where their size is given") {
  const auto path = scratch.file("a.JPG", floats({1, 2, 3, 4, 5, 6}));
  const auto map = io::read_depth(path, {.raw_width = 3, .raw_height = 2});
  CHECK(map.values(2, 1) == 6);
  CHECK_THROWS_AS(io::read_depth(path), format_error);
  CHECK(error_of(path, {.raw_width = 2, .raw_height = 2}) ==
        ": 2x2 floats are 16 bytes, the file has 24");
}

TEST_CASE("distances along rays become planar depth") {
  const auto path = scratch.file("r.bin", "3&1&1&" + floats({5, 5, 5}));
  const auto camera = math::pinhole(6, 2, 3, 3, 3, 1);
  const auto map = io::read_depth(path, {.range_camera = camera});
  // Centres at x = 1, 3, 5 of the camera's pixels: the rays leave by -2/3, 0 and 2/3.
  CHECK(map.values(1, 0) == 5);
  CHECK(map.values(0, 0) == doctest::Approx(5 / std::sqrt(1 + 4.0 / 9)));
  CHECK(map.values(2, 0) == map.values(0, 0));
  auto distorted = camera;
  distorted.model = math::camera_model::radial;
  CHECK_THROWS_AS(io::read_depth(path, {.range_camera = distorted}), argument_error);
}

TEST_CASE("depth that is written is read again in every format") {
  raster::image<float> image(5, 3);
  for (std::size_t i = 0; i < image.size(); ++i) image.data()[i] = 0.5f * static_cast<float>(i);
  for (const char* name : {"w.pfm", "w.npy", "w.exr"}) {
    const auto path = scratch.folder() / name;
    io::write_depth(path, image);
    CHECK(io::read_depth(path).values == image);
  }
  CHECK_THROWS_AS(io::write_depth(scratch.folder() / "w.doc", image), argument_error);
  CHECK_THROWS_AS(io::write_depth(scratch.folder() / "w.pfm", raster::image<float>()),
                  argument_error);
}

#if defined(AIB_WITH_PNG)

TEST_CASE("depth in a png is steps of a unit") {
  raster::image<float> image(4, 1);
  image(0, 0) = 1.5f;
  image(1, 0) = -1;
  image(2, 0) = std::numeric_limits<float>::infinity();
  image(3, 0) = 70;
  const auto path = scratch.folder() / "d.png";
  io::write_depth(path, image);
  const auto map = io::read_depth(path);
  CHECK(values(map) == std::vector<float>{1.5f, 0, 0, 0});
  CHECK(map.warnings.size() == 1);
  io::write_depth(path, image, {.scale = 256});
  const auto kitti = io::read_depth(path, {.scale = 256});
  CHECK(values(kitti) == std::vector<float>{1.5f, 0, 0, 70});
  CHECK(kitti.warnings.empty());
  io::write_png<std::uint8_t>(path, raster::image<std::uint8_t>(2, 2));
  CHECK(error_of(path).starts_with(": png: gray depth of 16 bits expected"));
}

#endif

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

TEST_CASE("a frame is read at the size of its estimate, mask and labels too") {
  raster::image<float> reference(4, 2);
  std::iota(reference.begin(), reference.end(), 1.0f);
  io::depth_frame_files files{"f", scratch.folder() / "est.pfm", scratch.folder() / "ref.npy"};
  io::write_depth(files.estimate, raster::image<float>(2, 1, 2).view());
  io::write_depth(files.reference, reference.view());
  auto frame = io::read_depth_frame(files, {.estimate = {.scale = 2}});
  CHECK(frame.name == "f");
  CHECK(values(frame.estimate) == std::vector<float>{1, 1});
  CHECK(values(frame.reference) == std::vector<float>{6, 8});
  CHECK(frame.mask.empty());
  frame = io::read_depth_frame(files, {.rule = raster::nearest_rule::floor});
  CHECK(values(frame.reference) == std::vector<float>{1, 3});
#if defined(AIB_WITH_PNG)
  raster::label_image labels(4, 2);
  std::iota(labels.begin(), labels.end(), std::uint16_t{0});
  files.mask = files.labels = scratch.folder() / "labels.png";
  io::write_png<std::uint16_t>(files.labels, labels);
  frame = io::read_depth_frame(files, {.rule = raster::nearest_rule::floor});
  CHECK(frame.labels(1, 0) == 2);
  CHECK(frame.mask(0, 0) == 0);
  CHECK(frame.mask(1, 0) == 1);
#endif
  files.reference = scratch.folder() / "nothing.npy";
  CHECK_THROWS_AS((void)io::read_depth_frame(files), io_error);
}

}  // namespace test_depth
