// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
//
// Every reader against what strangers give: a table of small sound files, which are cut, renamed,
// replaced; and a table of files that lie.
#include <aib/core/error.hpp>
#include <aib/io/cloud.hpp>
#include <aib/io/depth.hpp>
#include <aib/io/image.hpp>
#include <aib/io/mesh.hpp>
#include <aib/io/trajectory.hpp>
#include <aib/io/trajectory_write.hpp>

#if defined(AIB_WITH_NPZ)
#include <aib/io/npz_write.hpp>
#endif

#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <support/scratch.hpp>
#include <sys/stat.h>
#include <utility>
#include <vector>

using namespace aib;

namespace test_hostile {

namespace {

namespace fs = std::filesystem;

const support::scratch scratch;

/// A sound file and its reader, which prints what it read.
struct sample {
  std::string name;  ///< of the file, in a folder of its own
  std::string bytes;
  std::function<std::string(const fs::path&)> read;
  std::vector<std::pair<std::string, std::string>> beside = {};  ///< what must lie in the folder
};

std::string printed(const Eigen::Vector3d& v) { return message(v[0], ' ', v[1], ' ', v[2], '\n'); }

std::string cloud(const fs::path& path) {
  const auto c = io::read_cloud(path);
  std::string text;
  for (std::size_t i = 0; i < c.size(); ++i) text += printed(c.position(i));
  return text;
}

std::string mesh(const fs::path& path) {
  const auto m = io::read_mesh(path);
  std::string text;
  for (const auto& t : m.triangles)
    for (const auto v : t) text += printed(m.position(v));
  return text;
}

std::string depth(const fs::path& path) {
  std::string text;
  for (const float d : io::read_depth(path).values) text += message(d, ' ');
  return text;
}

std::string poses(const fs::path& path) {
  const auto t = io::read_trajectory(
      path, path.extension() == ".npy" ? io::trajectory_options{.convention = io::pose_convention{}}
                                       : io::trajectory_options{});
  std::string text;
  for (const auto& pose : t.world_from_camera) text += printed(pose.translation);
  return text;
}

std::string model(const fs::path& path) {
  const auto m = io::read_colmap(path.parent_path());
  return message(m.trajectory.names.at(0), ' ', m.points.size(), ' ', m.cameras.size());
}

template <class Write>
std::string written(const char* name, Write write) {
  const fs::path path = scratch.folder() / "written" / name;
  fs::create_directories(path.parent_path());
  write(path);
  return io::read_file(path);
}

template <class T>
std::string numbers(std::initializer_list<T> values) {
  std::string bytes;
  for (const T value : values) io::store(bytes, value);
  return bytes;
}

const std::string vertices =
    "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
const std::string faces = "element face 1\nproperty list uchar int vertex_indices\n";

std::string ply(const std::string& header, const std::string& data, const char* kind = "ascii") {
  return message("ply\nformat ", kind, " 1.0\n", header, "end_header\n", data);
}

std::string pcd(const std::string& header, const std::string& data) {
  return "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\n" + header + data;
}

std::string las(double scale, std::uint8_t minor = 2, std::uint64_t n = 1) {
  std::string header(375, '\0');
  const auto put = [&](std::size_t at, const std::string& v) { header.replace(at, v.size(), v); };
  put(0, "LASF");
  put(24, {'\x01', static_cast<char>(minor)});
  put(96, numbers<std::uint32_t>({375}));
  put(105, numbers<std::uint16_t>({20}));
  put(107, numbers<std::uint32_t>({1}));
  put(131, numbers({scale, 1.0, 1.0}));
  put(247, numbers<std::uint64_t>({n}));
  return header + numbers<std::int32_t>({2000000000, 2, 3}) + std::string(8, '\0');
}

std::string dmap(std::uint32_t width) {
  return "DR" + std::string("\x01\0", 2) + numbers<std::uint32_t>({2, 1, width, 1}) +
         std::string(8, '\0') + numbers<std::uint16_t>({1}) + "a" + numbers<std::uint32_t>({0}) +
         std::string(168, '\0') + numbers({1.0f, 2.0f});
}

io::posed_images one_image() {
  io::posed_images images;
  images.trajectory.world_from_camera = {{Eigen::Matrix3d::Identity(), {1, 2, 3}}};
  images.trajectory.names = {"a b.png"};
  images.cameras = {math::pinhole(4, 3, 5, 5, 2, 1.5)};
  return images;
}

std::string model_file(const char* name, io::colmap_encoding encoding) {
  const fs::path folder = scratch.folder() / "written" / "model";
  io::write_trajectory(folder, one_image(), {.encoding = encoding});
  return io::read_file(folder / name);
}

std::vector<sample> samples() {
  using enum io::colmap_encoding;
  const std::string corners = "0 0 0\n1 0 0\n0 1 0\n", row = "1 0 0 7 0 1 0 8 0 0 1 9";
  const std::string rows = numbers({0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f});
  const std::string face = "\x03" + numbers<std::int32_t>({0, 1, 2});
  const raster::image<float> map(3, 2, 1.5f);
  const auto depth_file = [&](const char* name) {
    return written(name, [&](const fs::path& p) { io::write_depth(p, map); });
  };
  std::vector<sample> all = {
      {"a.ply", ply(vertices + faces, corners + "3 0 1 2\n"), mesh},
      {"b.ply", ply(vertices + faces, rows + face, "binary_little_endian"), mesh},
      {"a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", mesh},
      {"a.stl",
       "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
       "endloop\nendfacet\nendsolid a\n",
       mesh},
      {"b.stl",
       std::string(80, ' ') + numbers<std::uint32_t>({1}) + std::string(12, '\0') + rows + "  ",
       mesh},
      {"a.xyz", corners, cloud},
      {"a.pcd", pcd("WIDTH 3\nHEIGHT 1\nDATA ascii\n", corners), cloud},
      {"b.pcd", pcd("WIDTH 3\nHEIGHT 1\nDATA binary\n", rows), cloud},
      {"a.las", las(0.001), cloud},
      {"a.npy", io::npy_bytes(io::make_array<float>({1, 3}, std::vector<float>{1, 2, 3})), cloud},
      {"a.pfm", depth_file("a.pfm"), depth},
      {"a.bin", "2&1&1&" + numbers({1.f, 2.f}), depth},
      {"a.dmap", dmap(2), depth},
      {"tum.txt", "1 1 2 3 0 0 0 1\n", poses},
      {"kitti.txt", row + "\n", poses},
      {"euroc.csv", "1403636579763555584,1,2,3,1,0,0,0\n", poses},
      {"a.log", "0 0 0\n1 0 0 7\n0 1 0 8\n0 0 1 9\n0 0 0 1\n", poses},
      {"camera_poses.txt", row + " 0 0 0 1\n", poses},
      {"rc.csv", "#name,x,y,alt,heading,pitch,roll\na b.png,1,2,3,0,0,0\n", poses},
      {"poses.npy",
       written("p.npy", [](const fs::path& p) { io::write_trajectory(p, one_image()); }), poses},
      {"images.bin",
       model_file("images.bin", binary),
       model,
       {{"cameras.bin", model_file("cameras.bin", binary)}}},
      {"images.txt",
       model_file("images.txt", text),
       model,
       {{"cameras.txt", model_file("cameras.txt", text)}}},
  };
#if defined(AIB_WITH_EXR)
  all.push_back({"a.exr", depth_file("a.exr"), depth});
#endif
#if defined(AIB_WITH_PNG)
  all.push_back({"a.png", depth_file("a.png"), depth});
#endif
#if defined(AIB_WITH_NPZ)
  const auto npz = [](const fs::path& p) {
    io::write_npz(p, {{"depth", io::make_array<float>({1, 2}, std::vector<float>{3, 4})}});
  };
  all.push_back({"a.npz", written("a.npz", npz), depth});
#endif
#if defined(AIB_WITH_JSON)
  all.push_back({"transforms.json",
                 written("t.json", [](const fs::path& p) { io::write_trajectory(p, one_image()); }),
                 poses});
  all.push_back({"reconstruction.json",
                 R"([{"cameras":{"c":{"projection_type":"perspective","width":4,"height":3}},)"
                 "\n"
                 R"("shots":{"a b":{"camera":"c","rotation":[0,0,0],"translation":[1,2,3]}}}])",
                 poses});
#endif
#if defined(AIB_WITH_XML)
  all.push_back({"cameras.xml",
                 "<document><chunk><cameras>\n<camera label=\"a b\"><transform>" + row +
                     " 0 0 0 1</transform></camera>\n</cameras></chunk></document>",
                 poses});
#endif
  return all;
}

/// The sample's file with other bytes, in a folder of this name.
fs::path laid(const sample& s, const fs::path& folder, const std::string& bytes) {
  for (const auto& [name, content] : s.beside) scratch.file(folder / name, content);
  return scratch.file(folder / s.name, bytes);
}

/// What the reader says where it refuses the file, else what it read. Whatever else it throws fails
/// the test.
std::string outcome(const sample& s, const fs::path& path) {
  try {
    return s.read(path);
  } catch (const error& e) {
    return e.what();
  }
}

bool is_text(const sample& s) { return s.bytes.find('\0') == std::string::npos; }

std::string with_windows_line_ends(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '\n' ? std::string("\r\n") : std::string(1, c);
  return out;
}

}  // namespace

TEST_CASE("every reader takes a path with blanks and letters beyond ASCII") {
  for (const sample& s : samples()) {
    CAPTURE(s.name);
    const std::string expected = s.read(laid(s, "plain", s.bytes));
    CHECK_FALSE(expected.empty());
    CHECK(s.read(laid(s, "a b/ü 深\n'\"", s.bytes)) == expected);
  }
}

TEST_CASE("line ends of Windows change nothing") {
  for (const sample& s : samples()) {
    CAPTURE(s.name);
    if (!is_text(s)) continue;
    CHECK(s.read(laid(s, "windows", with_windows_line_ends(s.bytes))) ==
          s.read(laid(s, "plain", s.bytes)));
  }
}

TEST_CASE("what is no file is refused by its name, and nobody waits for a pipe") {
  for (const sample& s : samples()) {
    const fs::path path = laid(s, "none", s.bytes);
    const auto refused = [&](const char* kind) {
      CAPTURE(s.name);
      CAPTURE(kind);
      CHECK_THROWS_AS(s.read(path), error);
      CHECK(outcome(s, path).starts_with(path.parent_path().string()));
      fs::remove_all(path);
    };
    fs::remove(path);
    refused("missing");
    REQUIRE(::mkfifo(path.c_str(), 0600) == 0);
    refused("pipe");
    fs::create_directory(path);
    refused("folder");
    fs::create_symlink("/dev/zero", path);
    refused("device");
    fs::remove_all(path.parent_path());
  }
}

TEST_CASE("a file that is cut anywhere is read or refused by its name, nothing worse") {
  for (const sample& s : samples()) {
    CAPTURE(s.name);
    const std::size_t step = 1 + s.bytes.size() / 100;
    const fs::path path = laid(s, "cut", s.bytes);
    std::size_t n_refused = 0;
    for (std::size_t n = s.bytes.size(); n > 0;) {
      n -= std::min(n, step);
      CAPTURE(n);
      fs::resize_file(path, n);
      try {
        s.read(path);
      } catch (const error& e) {
        ++n_refused;
        CHECK(std::string(e.what()).starts_with(path.parent_path().string()));
      }
    }
    CHECK(n_refused > 0);
    fs::remove_all(scratch.folder() / "cut");
  }
}

TEST_CASE("a file that shrinks while it is read is refused with the place") {
  const auto path = scratch.file("shrinks", std::string(100, 'x'));
  const io::input_file file(path);
  fs::resize_file(path, 10);
  std::string to(20, '\0');
  CHECK_THROWS_WITH_AS(file.read_at(5, to.data(), to.size()),
                       (path.string() + ": byte 10: the file ends, 15 more bytes expected").c_str(),
                       format_error);
}

namespace {

/// A file, what reads it, and the sentence behind its path.
struct lie {
  std::string name;
  std::string bytes;
  std::string (*read)(const fs::path&);
  std::string sentence;
};

#if defined(AIB_WITH_JSON)

std::string glb(const std::string& json, const std::string& buffer) {
  const auto chunk = [](const std::string& type, const std::string& content) {
    return numbers({static_cast<std::uint32_t>(content.size())}) + type + content;
  };
  return "glTF" + numbers<std::uint32_t>({2, 0}) + chunk("JSON", json) +
         chunk(std::string("BIN\0", 4), buffer);
}

/// A square as a strip, which each of n nodes shows; its indices are floats where `type` is 5126.
std::string repeated_glb(std::size_t n, int type) {
  std::string nodes = R"({"mesh":0})";
  for (std::size_t i = 1; i < n; ++i) nodes += R"(,{"mesh":0})";
  return glb(R"({"bufferViews":[{"byteLength":36},{"byteOffset":36}],"accessors":[
{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},
{"bufferView":1,"componentType":)" +
                 std::to_string(type) + R"(,"count":4,"type":"SCALAR"}],"meshes":[
{"primitives":[{"attributes":{"POSITION":0},"indices":1,"mode":5}]}],"nodes":[)" +
                 nodes + "]}",
             std::string(36, '\0') +
                 (type == 5126 ? numbers({-1.f, 0.f, 1.f, 2.f}) : std::string(4, '\0')));
}

#endif

std::vector<lie> lies() {
  const std::string most = "1099511627776";
  std::vector<lie> all = {
      {"a.pcd", pcd("WIDTH " + most + "\nHEIGHT 16777216\nDATA binary\n", ""), cloud,
       ":7: pcd: " + most + " x 16777216 points, at most " + most + " expected"},
      {"a.pcd", pcd("WIDTH 2\nHEIGHT 1\nPOINTS 1\nDATA ascii\n", "1 2 3\n4 5 6\n"), cloud,
       ":8: pcd: POINTS of WIDTH x HEIGHT = 2 expected, found 1"},
      {"a.pcd", pcd("DATA ascii\n", "1 2 3\n"), cloud, ":5: pcd: WIDTH or POINTS expected"},
      {"a.pcd", pcd("POINTS 1\nDATA ascii\n", "1 2 3 4\n"), cloud,
       ":7: pcd: the end of the line expected, found '4'"},
      {"a.ply", ply(vertices + faces, "0 0 0\n1 0 0\n0 1 0\n2.5 0 1 2\n"), mesh,
       ":13: ply: list vertex_indices of 2.5 items"},
      {"a.obj", "# nothing\nf 1 1 1\n", mesh, ":2: obj: vertex 1 of 0"},
      {"a.las", las(0), cloud, ": las: scale or offset is not finite, or a scale is 0"},
      {"a.las", las(1).replace(104, 1, "\x0b"), cloud,
       ": las: point format 0 to 10 expected, found 11"},
      {"a.pcd", "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F Q\n", cloud,
       ":4: pcd: TYPE F, I or U expected"},
      {"a.dmap", "DX" + dmap(1).substr(2), depth,
       ": byte 2: dmap: the tag DR or D2 expected at the begin"},
      {"a.las", las(1, 4, 2), cloud, ": las: one number of points expected, found 1 and 2"},
      {"a.dmap", dmap(0xffffffff), depth,
       ": byte 203: dmap: 4294967295x1 depths expected, 2 in the file"},
      {"a.csv", "#name,x,y,alt,heading,pitch,roll,x\n", poses,
       ":1: reality_capture: column 'x' comes twice"},
      {"a.txt", "0 1 2 3 0 0 0 1e200\n", poses,
       ":1: tum: math::rotation_from: quaternion (1e+200, 0, 0, 0) has no direction"},
  };
#if defined(AIB_WITH_JSON)
  all.push_back({"a.glb", repeated_glb(1, 5126), mesh,
                 ": glb: indices: whole numbers expected, found floats"});
  all.push_back({"a.glb", glb(R"({"nodes":[{"rotation":[0,0,0,0]}]})", ""), mesh,
                 ": glb: rotation: a quaternion of length 1 expected"});
#endif
  return all;
}

}  // namespace

TEST_CASE("what a file says of itself is held against what it has") {
  for (const lie& l : lies()) {
    const fs::path path = scratch.file(l.name, l.bytes);
    CHECK_THROWS_WITH_AS(l.read(path), (path.string() + l.sentence).c_str(), format_error);
  }
  const fs::path huge = scratch.file("huge.stl", "");
  fs::resize_file(huge, std::uintmax_t{72} << 30);
  CHECK_THROWS_WITH_AS(
      mesh(huge),
      (huge.string() +
       ": stl: at most 1431655765 triangles of 50 bytes expected, found 77309411328 bytes")
          .c_str(),
      format_error);
}

TEST_CASE("numbers that are not finite are counted, those that are too small are 0") {
  const auto warnings = [](const char* name, const std::string& bytes) {
    const auto found = io::read_cloud(scratch.file(name, bytes)).warnings;
    return found.size() == 1 ? found[0] : "";
  };
  const std::string one = "1 of 1 points are not finite";
  CHECK(warnings("a.las", las(1e308)) == one);
  CHECK(warnings("a.xyz", "1 nan 2\n") == one);
  CHECK(warnings("a.pcd", pcd("POINTS 1\nDATA ascii\n", "-inf 1 2\n")) == one);
  CHECK(io::read_cloud(scratch.file("b.xyz", "x y z r g b\n1 2 3 nan -7 300\n")).colors ==
        std::vector<cloud::color>{{0, 0, 255}});
  CHECK(cloud(scratch.file("c.xyz", "1e-400 2 3\n")) == "0 2 3\n");
  CHECK(poses(scratch.file("a.txt", "0 1e-400 2 3 0 0 0 1\n")) == "0 2 3\n");
}

TEST_CASE("of two of the same name one is chosen, as the reference readers do") {
  CHECK(cloud(scratch.file("a.ply",
                           ply(vertices + "property float x\n", "1 2 3 9\n1 2 3 9\n1 2 3 9\n"))) ==
        "1 2 3\n1 2 3\n1 2 3\n");
  CHECK(cloud(scratch.file("a.pcd",
                           "VERSION .7\nFIELDS x y z x\nSIZE 4 4 4 4\nTYPE F F F F\nPOINTS 1\n"
                           "DATA ascii\n1 2 3 9\n")) == "1 2 3\n");
#if defined(AIB_WITH_NPZ)
  const auto point = [](float x) {
    return io::make_array<float>({1, 3}, std::vector<float>{x, 2, 3});
  };
  io::write_npz(scratch.folder() / "a.npz", {{"points", point(1)}, {"points", point(9)}});
  CHECK(cloud(scratch.folder() / "a.npz") == "9 2 3\n");
#endif
}

TEST_CASE("colours of a pcd whose bits are no number stay as they are") {
  for (const char* type : {"F", "U", "I"}) {
    const std::string header = message("VERSION .7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F ",
                                       type, "\nPOINTS 1\nDATA binary\n");
    const std::string point = numbers({1.f, 2.f, 3.f}) + numbers<std::uint32_t>({0xff901020});
    CHECK(io::read_cloud(scratch.file("a.pcd", header + point)).colors ==
          std::vector<cloud::color>{{0x90, 0x10, 0x20}});
  }
}

#if defined(AIB_WITH_JSON)
TEST_CASE("nodes of a glb may repeat a mesh, up to a limit") {
  const auto path = scratch.file("nodes.glb", repeated_glb(1000, 5121));
  CHECK(io::read_mesh(path).triangles.size() == 2000);
  CHECK_THROWS_WITH_AS(
      io::read_mesh(path, {.limits = {.max_ratio = 1, .max_bytes = 10000}}),
      message(path.string(), ": glb: the meshes of a file of ", fs::file_size(path),
              " bytes need more than 10000 (max_bytes, max_ratio)")
          .c_str(),
      format_error);
}
#endif

}  // namespace test_hostile
