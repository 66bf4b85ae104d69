// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/io/bytes.hpp>
#include <aib/io/depth.hpp>
#include <aib/io/exr.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <string>
#include <support/scratch.hpp>
#include <support/shared.hpp>
#include <vector>

#if defined(AIB_TEST_TINYEXR)
#include <tinyexr.h>
#endif

using namespace aib;

namespace test_exr {

namespace {

const support::scratch scratch;

/// A smooth slope with a step, and noise in the lowest bits.
raster::image<float> slope(std::size_t width, std::size_t height) {
  raster::image<float> image(width, height);
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      const auto noise = static_cast<float>((x * 7919 + y * 104729) % 64);
      image(x, y) = 2.0f + 0.01f * static_cast<float>(x + 3 * y) + 1e-6f * noise +
                    (x > width / 2 ? 1.0f : 0.0f);
    }
  }
  return image;
}

std::filesystem::path written(const raster::image<float>& image,
                              const io::exr_write_options& options = {}) {
  const auto path = scratch.folder() / "a.exr";
  io::write_exr(path, image, options);
  return path;
}

/// An EXR file without compression, one line a block, channels of one type.
struct handmade {
  std::vector<std::string> channels = {"Z"};
  io::exr_pixel type = io::exr_pixel::float32;
  io::exr_window data = {0, 0, 1, 0};
  io::exr_window display = {0, 0, 1, 0};
  std::uint32_t version = 2;
  std::uint8_t compression = 0;
  std::int32_t sampling = 1;
  std::string pixels = {};  ///< line after line, in each channel after channel
  std::int32_t first_line_shift = 0;

  [[nodiscard]] std::string bytes() const {
    std::string out;
    io::store(out, std::uint32_t{20000630});
    io::store(out, version);
    std::string list;
    for (const std::string& name : channels) {
      list += name + '\0';
      for (const std::int32_t field : {static_cast<std::int32_t>(type), 0, sampling, sampling})
        io::store(list, field);
    }
    attribute(out, "channels", "chlist", list + '\0');
    attribute(out, "compression", "compression", std::string(1, static_cast<char>(compression)));
    attribute(out, "dataWindow", "box2i", window(data));
    attribute(out, "displayWindow", "box2i", window(display));
    out += '\0';
    const std::size_t n = data.height();
    const std::size_t line = pixels.size() / n;
    const std::size_t first = out.size() + 8 * n;
    for (std::size_t i = 0; i < n; ++i) io::store(out, std::uint64_t{first + i * (line + 8)});
    for (std::size_t i = 0; i < n; ++i) {
      io::store(out, static_cast<std::int32_t>(i) + data.min_y + first_line_shift);
      io::store(out, static_cast<std::int32_t>(line));
      out += pixels.substr(i * line, line);
    }
    return out;
  }

  [[nodiscard]] std::filesystem::path file() const { return scratch.file("h.exr", bytes()); }

 private:
  static void attribute(std::string& out,
                        const std::string& name,
                        const std::string& type,
                        const std::string& value) {
    out += name + '\0' + type + '\0';
    io::store(out, static_cast<std::int32_t>(value.size()));
    out += value;
  }
  static std::string window(const io::exr_window& w) {
    std::string out;
    for (const std::int32_t corner : {w.min_x, w.min_y, w.max_x, w.max_y}) io::store(out, corner);
    return out;
  }
};

std::string floats(std::initializer_list<float> values) {
  std::string bytes;
  for (const float v : values) io::store(bytes, v);
  return bytes;
}

std::string halves(std::initializer_list<int> bits) {
  std::string bytes;
  for (const int b : bits) io::store(bytes, static_cast<std::uint16_t>(b));
  return bytes;
}

std::vector<float> values(const depth::depth_map& map) {
  return {map.values.begin(), map.values.end()};
}

std::string error_of(const std::filesystem::path& path, const io::exr_options& options = {}) {
  try {
    static_cast<void>(io::read_exr(path, options));
  } catch (const format_error& e) {
    return std::string(e.what()).substr(path.string().size());
  }
  return "no error";
}

}  // namespace

TEST_CASE_TEMPLATE_DEFINE("exr: what is written is read again bit by bit", Size, round_trip) {
  for (const auto compression :
       {io::exr_compression::none, io::exr_compression::zips, io::exr_compression::zip}) {
    const auto image = slope(Size::width, Size::height);
    CHECK(io::read_exr(written(image, {.compression = compression})).values == image);
  }
}
template <std::size_t W, std::size_t H>
struct size {
  static constexpr std::size_t width = W, height = H;
};
TEST_CASE_TEMPLATE_INVOKE(round_trip, size<1, 1>, size<3, 17>, size<37, 16>, size<160, 45>);

TEST_CASE("exr: differences and halves undo each other for every length") {
  for (std::size_t n = 2; n < 200; n += 2) {
    std::vector<std::uint8_t> bytes(n), differences(n), back(n);
    for (std::size_t i = 0; i < n; ++i) bytes[i] = static_cast<std::uint8_t>(i * i * 31 + n);
    io::take_differences(bytes.data(), differences.data(), n);
    io::sum_differences(differences.data(), n);
    io::interleave(differences.data(), differences.data() + n / 2, back.data(), n);
    CHECK(back == bytes);
  }
}

TEST_CASE("exr: a smaller picture equals the nearest pixels of the whole one") {
  const auto image = slope(96, 54);
  for (const auto rule : {raster::nearest_rule::centre, raster::nearest_rule::floor}) {
    for (const auto compression : {io::exr_compression::none, io::exr_compression::zip}) {
      const auto path = written(image, {.compression = compression});
      for (const std::size_t width : {7u, 96u, 200u}) {
        const auto small =
            io::read_exr(path, {.width = width, .height = width / 2, .rule = rule}).values;
        CHECK(small == raster::resample_nearest<float>(image, width, width / 2, rule));
      }
    }
  }
}

TEST_CASE("exr: background becomes 0 and is counted") {
  constexpr float inf = std::numeric_limits<float>::infinity();
  const auto path =
      handmade{.data = {0, 0, 3, 0}, .display = {0, 0, 3, 0}, .pixels = floats({1e10f, 2, inf, 30})}
          .file();
  const auto map = io::read_exr(path);
  CHECK(values(map) == std::vector<float>{0, 2, 0, 30});
  CHECK(map.warnings == std::vector<std::string>{"2 of 4 pixels are background (depth >= 1e+09)"});
  CHECK(values(io::read_exr(path, {.max_depth = 30})) == std::vector<float>{0, 2, 0, 0});
  CHECK(values(io::read_depth(path, {.max_depth = 30})) == std::vector<float>{0, 2, 0, 0});
}

TEST_CASE("exr: half depth loses its 65504 and says how coarse it is") {
  const auto map = io::read_exr(
      handmade{.type = io::exr_pixel::half, .pixels = halves({0x7bff, 0x4200})}.file());
  CHECK(values(map) == std::vector<float>{0, 3});
  CHECK(map.warnings.size() == 2);
  CHECK(map.warnings[1] == "channel Z is half: 11 bits, 1.6 cm at a depth of 20 m");
}

TEST_CASE("exr: the channel is chosen by name") {
  const auto chosen = [](std::vector<std::string> channels, const std::string& wanted = {}) {
    std::string pixels;
    for (std::size_t i = 0; i < channels.size(); ++i)
      pixels += floats({1.0f + static_cast<float>(i), 1.0f + static_cast<float>(i)});
    const auto path = handmade{.channels = channels, .pixels = pixels}.file();
    const auto map = io::read_exr(path, {.channel = wanted});
    return channels.at(static_cast<std::size_t>(map.values(0, 0)) - 1);
  };
  CHECK(chosen({"View Layer.Combined.R", "View Layer.Depth.Z", "View Layer.Mist.Z"}) ==
        "View Layer.Depth.Z");
  CHECK(chosen({"A", "B", "Z"}) == "Z");
  CHECK(chosen({"A", "Depth.V"}) == "Depth.V");
  CHECK(chosen({"A", "Y"}) == "Y");
  CHECK(chosen({"distance"}) == "distance");
  CHECK(chosen({"A", "B", "Z"}, "B") == "B");
  CHECK(io::exr_channel_names(
            handmade{.channels = {"A", "N.X"}, .pixels = floats({1, 1, 2, 2})}.file()) ==
        std::vector<std::string>{"A", "N.X"});
  const auto path = handmade{.channels = {"A", "N.X"}, .pixels = floats({1, 1, 2, 2})}.file();
  CHECK(error_of(path) == ": exr: no channel looks like depth; name one of A, N.X");
  CHECK(error_of(path, {.channel = "Z"}) == ": exr: no channel \"Z\"; there are A, N.X");
}

TEST_CASE("exr: R is depth where G and B are its copies") {
  const auto path = [](float blue) {
    return handmade{.channels = {"B", "G", "R"}, .pixels = floats({blue, 2, 1, 2, 1, 2})}.file();
  };
  CHECK(values(io::read_exr(path(1))) == std::vector<float>{1, 2});
  CHECK(error_of(path(7)) == ": exr: R, G and B differ, this is no depth; name one of B, G, R");
}

TEST_CASE("exr: the data window is pasted into the display window") {
  const auto path =
      handmade{.data = {1, -1, 2, 1}, .display = {0, 0, 1, 2}, .pixels = floats({1, 2, 3, 4, 5, 6})}
          .file();
  const auto map = io::read_exr(path);
  CHECK(map.values.width() == 2);
  CHECK(values(map) == std::vector<float>{0, 3, 0, 5, 0, 0});
  CHECK(map.warnings.size() == 1);
}

TEST_CASE("exr: a display window far larger than its data asks for no memory") {
  const auto path = handmade{.data = {1, -1, 2, 1},
                             .display = {0, 0, 9999, 9999},
                             .pixels = floats({1, 2, 3, 4, 5, 6})}
                        .file();
  CHECK_THROWS_WITH_AS(static_cast<void>(io::read_exr(path)),
                       doctest::Contains("exr: a display window of 10000x10000 around "),
                       format_error);
  CHECK(io::read_exr(path, {.limits = {.max_ratio = 1e9}}).values.width() == 10000);
}

TEST_CASE("exr: a damaged or unsupported file is refused with the defect") {
  const handmade good{.pixels = floats({1, 2})};
  const auto refused = [](const handmade& file) { return error_of(file.file()); };
  auto bad = good;
  bad.version = 3;
  CHECK(refused(bad) == ": byte 8: exr: version 2 expected, found 3");
  bad.version = 0x10002;
  CHECK(refused(bad) == ": byte 8: exr: unknown flags in the version");
  bad.version = 0x802;
  CHECK(refused(bad) ==
        ": byte 8: exr: deep data are not supported; flatten the image and save it with ZIP");
  bad = good;
  bad.compression = 8;
  CHECK(refused(bad) == ": exr: compression DWAA is not supported; save the file with ZIP");
  bad.compression = 10;
  CHECK(refused(bad).ends_with("exr: unknown compression 10"));
  bad = good;
  bad.sampling = 2;
  CHECK(refused(bad).ends_with("exr: channel Z is sub-sampled (2x2), which is not supported"));
  bad = good;
  bad.type = static_cast<io::exr_pixel>(7);
  CHECK(refused(bad).ends_with("exr: channel Z: type 7"));
  bad = good;
  bad.channels.clear();
  CHECK(refused(bad).ends_with("exr: no channels in the header"));
  bad = good;
  bad.data = {0, 0, 2000000000, 2000000000};
  bad.display = bad.data;
  bad.pixels.clear();
  std::string text = good.bytes();
  const std::size_t window = text.find("dataWindow") + 10 + 1 + 5 + 1 + 4;
  std::string huge = text;
  const std::int32_t corner = 2000000000;
  std::memcpy(huge.data() + window + 8, &corner, 4);
  CHECK(error_of(scratch.file("x.exr", huge)).find("pixels, at most 134217728 are allowed") !=
        std::string::npos);
  bad = good;
  bad.channels = {"Z", "Z"};
  CHECK(refused(bad).ends_with("exr: channel Z comes twice"));
  const std::size_t compression = text.find("compression");
  CHECK(error_of(scratch.file("x.exr",
                              std::string(text).insert(compression, text.substr(compression, 29))))
            .ends_with("exr: the attribute compression comes twice"));
  bad = good;
  bad.compression = 3;
  bad.data = {0, 0, 999999, 0};
  CHECK(refused(bad).ends_with(
      message("exr: 1000000x1 pixels of 4 bytes in a file of ", bad.bytes().size(), " bytes")));
  CHECK(error_of(scratch.file("x.exr", bad.bytes() + std::string(10000, ' ')))
            .ends_with("exr: block 0 is damaged (ZIP)"));
  bad = good;
  bad.first_line_shift = 1;
  CHECK(refused(bad).ends_with("block 0 is not at its place; the file is not complete"));
  CHECK(error_of(scratch.file("x.exr", "")) == ": exr: not an OpenEXR file");
  CHECK(error_of(scratch.file("x.exr", "hello, world")) == ": exr: not an OpenEXR file");
}

TEST_CASE("exr: a file that is cut anywhere is refused") {
  for (const auto compression : {io::exr_compression::none, io::exr_compression::zip}) {
    const std::string whole = io::read_file(written(slope(20, 40), {.compression = compression}));
    for (std::size_t n = 0; n < whole.size(); n += 1 + n / 40)
      CHECK_THROWS_AS(io::read_exr(scratch.file("cut.exr", whole.substr(0, n))), format_error);
  }
}

TEST_CASE("exr: bytes that are changed anywhere are read or refused, nothing worse") {
  for (const auto compression :
       {io::exr_compression::none, io::exr_compression::zips, io::exr_compression::zip}) {
    const std::string whole = io::read_file(written(slope(20, 40), {.compression = compression}));
    for (std::size_t at = 0; at < whole.size(); at += 1 + at / 100) {
      std::string changed = whole;
      changed[at] = static_cast<char>(changed[at] ^ (1 << at % 8));
      const auto path = scratch.file("changed.exr", changed);
      try {
        static_cast<void>(io::read_exr(path));
      } catch (const format_error&) {
      }
    }
  }
}

TEST_CASE("exr: writing refuses what the format or aib does not have") {
  const auto path = scratch.folder() / "w.exr";
  CHECK_THROWS_AS(io::write_exr(path, raster::image<float>()), argument_error);
  const auto image = slope(2, 2);
  CHECK_THROWS_AS(io::write_exr(path, image, {.compression = io::exr_compression::piz}),
                  argument_error);
  CHECK_THROWS_AS(io::write_exr(path, image, {.channel = ""}), argument_error);
  CHECK_THROWS_AS(io::write_depth(scratch.folder() / "w.doc", image), argument_error);
  CHECK_FALSE(std::filesystem::exists(path));
}

TEST_CASE("exr: depth of the rendered scenes") {
  if (!support::has_shared("io: exr scenes")) return;
  const auto map = io::read_depth(support::shared() / "scenes/gt/office/depth/000000.exr");
  CHECK(map.values.width() == 480);
  CHECK(map.values.height() == 270);
  for (const float depth : map.values) CHECK_MESSAGE((depth >= 0 && depth < 1000), depth);
}

#if defined(AIB_TEST_TINYEXR)

namespace {

/// The channels of a scan-line file by tinyexr, in its order; empty where it does not read it.
struct tinyexr_image {
  EXRHeader header;
  EXRImage image;

  explicit tinyexr_image(const std::string& path) {
    InitEXRHeader(&header);
    InitEXRImage(&image);
    EXRVersion version;
    const char* error = nullptr;
    if (ParseEXRVersionFromFile(&version, path.c_str()) != TINYEXR_SUCCESS ||
        ParseEXRHeaderFromFile(&header, &version, path.c_str(), &error) != TINYEXR_SUCCESS)
      return;
    for (int i = 0; i < header.num_channels; ++i) {
      if (header.pixel_types[i] == TINYEXR_PIXELTYPE_HALF)
        header.requested_pixel_types[i] = TINYEXR_PIXELTYPE_FLOAT;
    }
    if (LoadEXRImageFromFile(&image, &header, path.c_str(), &error) != TINYEXR_SUCCESS)
      image.images = nullptr;
  }
  ~tinyexr_image() {
    FreeEXRImage(&image);
    FreeEXRHeader(&header);
  }
  tinyexr_image(const tinyexr_image&) = delete;
  tinyexr_image& operator=(const tinyexr_image&) = delete;
};

/// How many channels of the file both readers gave the same bits for.
std::size_t equal_channels(const std::filesystem::path& path) {
  const io::input_file file(path);
  const auto header = io::read_exr_header(file);
  const tinyexr_image other(path.string());
  if (!other.image.images) return 0;
  std::size_t n = 0;
  const auto& channels = header.parts[0].channels;
  REQUIRE(static_cast<int>(channels.size()) == other.image.num_channels);
  for (std::size_t c = 0; c < channels.size(); ++c) {
    if (channels[c].type == io::exr_pixel::uint32) continue;
    const auto mine = io::read_exr_channel(file, header, 0, c);
    CHECK_MESSAGE(std::memcmp(mine.data(), other.image.images[c], 4 * mine.size()) == 0,
                  path.string());
    ++n;
  }
  return n;
}

}  // namespace

TEST_CASE("exr: the same bits as tinyexr") {
  for (const auto compression :
       {io::exr_compression::none, io::exr_compression::zips, io::exr_compression::zip})
    CHECK(equal_channels(written(slope(133, 71), {.compression = compression})) == 1);
}

TEST_CASE("exr: the same bits as tinyexr on the shared files") {
  if (!support::has_shared("io: exr against tinyexr")) return;
  std::size_t n = 0;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(support::shared() / "scenes")) {
    if (entry.path().extension() == ".exr" && entry.path().stem().string().back() == '0')
      n += equal_channels(entry.path());
  }
  const auto zoo = support::shared() / "golden/zoo/exr";
  for (const char* name :
       {"z_float_scan_none", "z_float_scan_rle", "z_float_scan_zips", "z_float_scan_zip",
        "z_float_scan_piz", "z_half_scan_none", "z_half_scan_rle", "z_half_scan_zips",
        "z_half_scan_zip", "z_half_scan_piz", "datawindow_offset_piz", "multilayer_blenderlike_zip",
        "oiio__rgbahalf-zfloat", "openexr-images__DisplayWindow_t01"})
    n += equal_channels(zoo / (std::string(name) + ".exr"));
  CHECK(n > 40);
}

#endif

}  // namespace test_exr
