// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/io/bytes.hpp>
#include <aib/io/cloud.hpp>
#include <aib/io/npy.hpp>
#if defined(AIB_WITH_NPZ)
#include <aib/io/npz_write.hpp>
#endif

#include <doctest/doctest.h>

#include <bit>
#include <cstdint>
#include <string>
#include <support/scratch.hpp>
#include <vector>

using namespace aib;

namespace test_cloud {

namespace {

const support::scratch scratch;

std::string error_of(const std::filesystem::path& path, const io::cloud_options& options = {}) {
  try {
    static_cast<void>(io::read_cloud(path, options));
  } catch (const format_error& e) {
    return std::string(e.what()).substr(path.string().size());
  }
  return "no error";
}

template <class T>
std::string bytes(std::initializer_list<T> values) {
  std::string result;
  for (const T v : values) io::store(result, v);
  return result;
}

}  // namespace

TEST_CASE("points are read from text, whatever parts the numbers") {
  for (const char* text :
       {"1 2 3\n4 5 6\n", "1,2,3\r\n4,5,6\r\n", "# a comment\n1;2;3;\n4; 5; 6",
        "//X,Y,Z\n1\t2 3\n\n+4 5e0 6\n", "2\n1 2 3\n4 5 6\n", "x y z\n1 2 3\n4 5 6\n"}) {
    CAPTURE(text);
    const auto cloud = io::read_cloud(scratch.file("a.xyz", text));
    REQUIRE(cloud.size() == 2);
    CHECK(cloud.points[1] == Eigen::Vector3f(4, 5, 6));
    CHECK(cloud.warnings.empty());
  }
}

TEST_CASE("columns behind the coordinates are told from their values or names") {
  const auto read = [](const std::string& text) {
    return io::read_cloud(scratch.file("b.csv", text));
  };
  CHECK(read("1 2 3 255 0 7\n").colors.at(0) == cloud::color{255, 0, 7});
  CHECK(read("1 2 3 0 0.6 0.8\n").normals.at(0) == Eigen::Vector3f(0, 0.6f, 0.8f));
  CHECK(read("1 2 3 0.5 255 0 7\n").colors.at(0) == cloud::color{255, 0, 7});
  const auto both = read("1 2 3 255 0 7 0 0 1\n4 5 6 1 2 3 0 1 0\n");
  CHECK(both.colors.at(1) == cloud::color{1, 2, 3});
  CHECK(both.normals.at(1) == Eigen::Vector3f(0, 1, 0));
  const auto named = read("id,X,Y,Z,Red,Green,Blue\n9,1,2,3,4,5,6\n");
  CHECK(named.points.at(0) == Eigen::Vector3f(1, 2, 3));
  CHECK(named.colors.at(0) == cloud::color{4, 5, 6});
  CHECK(read("1 2 3 0.5 0.5 7\n").warnings.size() == 1);
}

TEST_CASE("text that is no table of points is refused with its line") {
  const auto refused = [](const std::string& text) {
    return error_of(scratch.file("c.xyz", text));
  };
  CHECK(refused("1 2 3\n4 5\n") == ":2: xyz: 3 numbers expected, found 2");
  CHECK(refused("1 2\n") == ":1: xyz: 3 numbers expected, found 2");
  CHECK(refused("1 2 3\n4 five 6\n") == ":2: xyz: a number expected, found \"five 6\"");
  CHECK(refused("3\n1 2 3\n") == ":2: xyz: 3 points announced, found 1");
  CHECK(refused("a b c\n1 2 3\n") == ": xyz: no columns x, y, z in the first line");
  CHECK(io::read_cloud(scratch.file("d.xyz", "")).empty());
}

TEST_CASE("a pcd is read in ascii, binary and compressed form") {
  const auto header = [](const std::string& data) {
    return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n"
           "FIELDS x y z rgb normal_x normal_y normal_z label\nSIZE 4 4 4 4 4 4 4 2\n"
           "TYPE F F F F F F F U\nCOUNT 1 1 1 1 1 1 1 1\nWIDTH 2\nHEIGHT 1\n"
           "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA " +
           data + "\n";
  };
  const auto rgb = std::bit_cast<float>(0x00010203u);
  const std::string ascii = message("1 2 3 ", rgb, " 0 0 1 7\n4 5 6 ", rgb, " 0 1 0 8\n");
  const std::string rows = bytes({1.f, 2.f, 3.f, rgb, 0.f, 0.f, 1.f}) + bytes<std::uint16_t>({7}) +
                           bytes({4.f, 5.f, 6.f, rgb, 0.f, 1.f, 0.f}) + bytes<std::uint16_t>({8});
  const std::string columns = bytes({1.f, 4.f, 2.f, 5.f, 3.f, 6.f, rgb, rgb}) +
                              bytes({0.f, 0.f, 0.f, 1.f, 1.f, 0.f}) + bytes<std::uint16_t>({7, 8});
  std::string packed;  // runs of up to 32 bytes as they are
  for (std::size_t i = 0; i < columns.size(); i += 32) {
    const std::string run = columns.substr(i, 32);
    packed += static_cast<char>(run.size() - 1) + run;
  }
  const std::string compressed = bytes({static_cast<std::uint32_t>(packed.size()),
                                        static_cast<std::uint32_t>(columns.size())}) +
                                 packed;
  for (const auto& path : {scratch.file("a.pcd", header("ascii") + ascii),
                           scratch.file("b.pcd", header("binary") + rows),
                           scratch.file("c.pcd", header("binary_compressed") + compressed)}) {
    const auto cloud = io::read_cloud(path);
    REQUIRE(cloud.size() == 2);
    CHECK(cloud.points[1] == Eigen::Vector3f(4, 5, 6));
    CHECK(cloud.normals.at(1) == Eigen::Vector3f(0, 1, 0));
    CHECK(cloud.colors.at(1) == cloud::color{1, 2, 3});
    CHECK(cloud.labels == std::vector<std::uint32_t>{7, 8});
    CHECK(cloud.warnings.empty());
  }
  for (const std::string& whole : {header("binary") + rows, header("ascii") + ascii,
                                   header("binary_compressed") + compressed}) {
    CHECK(error_of(scratch.file("d.pcd", whole.substr(0, whole.size() - 20))) != "no error");
    for (std::size_t at = 0; at < whole.size(); at += 2) {
      std::string changed = whole;
      changed[at] = static_cast<char>(changed[at] ^ (1 << at % 8));
      static_cast<void>(error_of(scratch.file("e.pcd", changed)));
    }
  }
}

TEST_CASE("lzf is expanded, references that overlap repeat") {
  std::vector<char> plain(10);
  const std::string packed = std::string("\x01", 1) + "ab" + std::string("\xc0\x01", 2);
  CHECK(io::detail::expand_lzf(packed, plain));
  CHECK(std::string(plain.begin(), plain.end()) == "ababababab");
  CHECK_FALSE(io::detail::expand_lzf(packed.substr(0, 4), plain));
  CHECK_FALSE(io::detail::expand_lzf(std::string("\x20\x05", 2), plain));
}

namespace {

std::string las(int format,
                const std::string& records,
                std::uint32_t n,
                std::uint16_t record_bytes) {
  std::string bytes_of(227, '\0');
  const auto put = [&](std::size_t at, const std::string& value) {
    bytes_of.replace(at, value.size(), value);
  };
  put(0, "LASF");
  put(24, std::string("\x01\x02", 2));
  put(94, bytes<std::uint16_t>({227}));
  put(96, bytes<std::uint32_t>({227}));
  bytes_of[104] = static_cast<char>(format);
  put(105, bytes<std::uint16_t>({record_bytes}));
  put(107, bytes<std::uint32_t>({n}));
  put(131, bytes({0.001, 0.001, 0.001, 458000.0, 5429000.0, 100.0}));
  return bytes_of + records;
}

std::string las_record() {
  std::string record = bytes<std::int32_t>({1001, 2002, -3003});
  record.resize(26);
  record[15] = static_cast<char>(0x60 | 6);  // flags and class 6, a building
  return record.replace(20, 6, bytes<std::uint16_t>({65535, 257, 0}));
}

}  // namespace

TEST_CASE("a las file is read with colours and classes, exact in map coordinates") {
  const auto cloud =
      io::read_cloud(scratch.file("a.las", las(2, las_record() + las_record(), 2, 26)));
  REQUIRE(cloud.size() == 2);
  CHECK((cloud.position(0) - Eigen::Vector3d(458001.001, 5429002.002, 96.997)).norm() < 1e-6);
  CHECK(cloud.colors[0] == cloud::color{255, 1, 0});
  CHECK(cloud.labels[0] == 6);
}

TEST_CASE("a damaged or compressed las file, and e57, are refused") {
  const auto refused = [](const std::string& b) { return error_of(scratch.file("b.las", b)); };
  CHECK(refused(las(2, las_record(), 2, 26)) ==
        ": las: 2 records of 26 bytes from byte 227 expected, the file has 253 bytes");
  CHECK(refused(las(130, las_record(), 1, 26)).starts_with(": las: LAZ is compressed; convert it"));
  CHECK(refused(las(11, las_record(), 1, 26)) == ": las: point format 0 to 10 expected, found 11");
  CHECK(refused(las(2, las_record(), 1, 20)) == ": las: records of 26 bytes expected, found 20");
  CHECK(refused("LASF") == ": las: the file ends within the header");
  CHECK(error_of(scratch.file("a.e57", "ASTM-E57")).starts_with(": E57 is not supported; convert"));
  CHECK(error_of(scratch.file("a.stl", "solid\n")).starts_with(": a cloud expected, found an STL"));
}

TEST_CASE("arrays of points are read") {
  const auto path = scratch.folder() / "a.npy";
  io::write_npy(path, io::make_array<float>({1, 2, 3}, std::vector<float>{1, 2, 3, 4, 5, 6}));
  CHECK(io::read_cloud(path).points.at(1) == Eigen::Vector3f(4, 5, 6));
  io::write_npy(path, io::make_array<double>({1, 3}, std::vector<double>{458000.001, 2, 3}));
  CHECK(io::read_cloud(path).position(0)[0] == doctest::Approx(458000.001).epsilon(1e-12));
  io::write_npy(path, io::make_array<float>({3, 2}, std::vector<float>{1, 2, 3, 4, 5, 6}));
  CHECK(error_of(path) == ": an array of N x 3 expected, found (3, 2)");
}

#if defined(AIB_WITH_NPZ)

TEST_CASE("points of an npz are found by name, with their colours") {
  const auto path = scratch.folder() / "a.npz";
  const auto points = [](float x) {
    return io::make_array<float>({1, 3}, std::vector{x, 2.f, 3.f});
  };
  const auto colors = io::make_array<std::uint8_t>({1, 3}, std::vector<std::uint8_t>{7, 8, 9});
  io::write_npz(path, {{"a", points(1)}, {"points", points(5)}, {"colors", colors}});
  const auto cloud = io::read_cloud(path);
  CHECK(cloud.points.at(0)[0] == 5);
  CHECK(cloud.colors.at(0) == cloud::color{7, 8, 9});
  CHECK(io::read_cloud(path, {.key = "a"}).points.at(0)[0] == 1);
  CHECK(error_of(path, {.key = "b"}) == ": npz: no array \"b\"; There are a, points, colors");
}

#endif

}  // namespace test_cloud
