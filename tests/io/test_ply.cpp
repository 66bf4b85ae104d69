// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/io/bytes.hpp>
#include <aib/io/cloud.hpp>
#include <aib/io/mesh.hpp>
#include <aib/io/ply_positions.hpp>

#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <string>
#include <support/scratch.hpp>
#include <support/shared.hpp>
#include <vector>

using namespace aib;

namespace test_ply {

namespace {

const support::scratch scratch;

std::filesystem::path ply(const std::string& header, const std::string& data) {
  const auto path = scratch.folder() / "a.ply";
  io::write_file(path, "ply\n" + header + "end_header\n" + data);
  return path;
}

std::string error_of(const std::string& header, const std::string& data) {
  const auto path = ply(header, data);
  try {
    header.find("element face") == std::string::npos ? void(io::read_cloud(path))
                                                     : void(io::read_mesh(path));
  } catch (const format_error& e) {
    return std::string(e.what()).substr(path.string().size());
  }
  return "no error";
}

template <class T>
std::string bytes(std::initializer_list<T> values, std::endian order = std::endian::little) {
  std::string result;
  for (const T v : values) io::store(result, v, order);
  return result;
}

const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
const std::string little = "format binary_little_endian 1.0\n";
const std::string big = "format binary_big_endian 1.0\n";
const std::string ascii = "format ascii 1.0\n";

}  // namespace

TEST_CASE("a ply cloud is read in ascii and in both byte orders") {
  const std::string two = "element vertex 2\n" + xyz;
  for (const auto& path :
       {ply(ascii + two, "1 2 3\r\n\r\n -4e0\t+5 6.5"),
        ply(little + two, bytes({1.f, 2.f, 3.f, -4.f, 5.f, 6.5f})),
        ply(big + two, bytes({1.f, 2.f, 3.f, -4.f, 5.f, 6.5f}, std::endian::big))}) {
    const auto cloud = io::read_cloud(path);
    REQUIRE(cloud.size() == 2);
    CHECK(cloud.points[0] == Eigen::Vector3f(1, 2, 3));
    CHECK(cloud.points[1] == Eigen::Vector3f(-4, 5, 6.5f));
    CHECK(cloud.origin.isZero(0));
    CHECK(cloud.warnings.empty());
  }
}

TEST_CASE("ply properties come in any order, between others, after other elements") {
  const std::string header =
      "comment made by hand\nobj_info nothing\n"
      "element camera 2\nproperty list uchar float k\nproperty short id\n"
      "element vertex 1\nproperty float confidence\nproperty float z\nproperty uchar blue\n"
      "property float x\nproperty uchar red\nproperty float nz\nproperty float ny\n"
      "property float nx\nproperty float y\nproperty uchar green\nproperty ushort label\n";
  const std::string camera = bytes<std::uint8_t>({2}) + bytes({8.f, 9.f}) +
                             bytes<std::int16_t>({7}) + bytes<std::uint8_t>({0}) +
                             bytes<std::int16_t>({-7});
  const std::string vertex = bytes({0.5f, 3.f}) + bytes<std::uint8_t>({30}) + bytes({1.f}) +
                             bytes<std::uint8_t>({10}) + bytes({0.f, 1.f, 0.f, 2.f}) +
                             bytes<std::uint8_t>({20}) + bytes<std::uint16_t>({513});
  const auto from_binary = io::read_cloud(ply(little + header, camera + vertex));
  const auto from_text =
      io::read_cloud(ply(ascii + header, "2 8 9 7\n0 -7\n0.5 3 30 1 10 0 1 0 2 20 513\n"));
  for (const auto& cloud : {from_binary, from_text}) {
    REQUIRE(cloud.size() == 1);
    CHECK(cloud.points[0] == Eigen::Vector3f(1, 2, 3));
    CHECK(cloud.normals.at(0) == Eigen::Vector3f(0, 1, 0));
    CHECK(cloud.colors.at(0) == cloud::color{10, 20, 30});
    CHECK(cloud.labels.at(0) == 513);
  }
}

TEST_CASE("double coordinates of a ply get an origin and keep their millimetres") {
  const std::string header =
      little + "element vertex 2\nproperty double x\nproperty double y\nproperty double z\n";
  const auto cloud = io::read_cloud(
      ply(header, bytes({458000.1234, 5429000.5678, 160.001, 458010.1234, 5429010.5678, 170.001})));
  CHECK(cloud.origin == Eigen::Vector3d(458005, 5429006, 165));
  CHECK((cloud.position(1) - Eigen::Vector3d(458010.1234, 5429010.5678, 170.001)).norm() < 1e-6);
}

TEST_CASE("a vertex element with a list of its own is read") {
  const std::string header = little + "element vertex 2\n" + xyz +
                             "property list uchar int views\nproperty uchar red\n"
                             "property uchar green\nproperty uchar blue\n";
  const auto cloud =
      io::read_cloud(ply(header, bytes({1.f, 2.f, 3.f}) + bytes<std::uint8_t>({1}) + bytes({7}) +
                                     bytes<std::uint8_t>({1, 2, 3}) + bytes({4.f, 5.f, 6.f}) +
                                     bytes<std::uint8_t>({0}) + bytes<std::uint8_t>({4, 5, 6})));
  CHECK(cloud.points.at(1) == Eigen::Vector3f(4, 5, 6));
  CHECK(cloud.colors.at(1) == cloud::color{4, 5, 6});
}

TEST_CASE("normals that are all zero are no normals, float colours are shares") {
  const std::string header = ascii + "element vertex 2\n" + xyz +
                             "property float nx\nproperty float ny\nproperty float nz\n"
                             "property float red\nproperty float green\nproperty float blue\n";
  const auto without = io::read_cloud(ply(header, "1 2 3 0 0 0 0 0.5 1\n4 5 6 0 0 0 -1 2 nan\n"));
  CHECK(without.normals.empty());
  CHECK(without.colors.at(0) == cloud::color{0, 128, 255});
  CHECK(without.colors.at(1) == cloud::color{0, 255, 0});
  const auto with = io::read_cloud(ply(header, "1 2 3 0 0 0 0 0 0\n4 5 6 0 0 1 0 0 0\n"));
  CHECK(with.normals.size() == 2);
}

TEST_CASE("points that are not finite stay and are counted") {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  constexpr float inf = std::numeric_limits<float>::infinity();
  const auto cloud = io::read_cloud(ply(little + "element vertex 3\n" + xyz,
                                        bytes({nan, 2.f, 3.f, 4.f, 5.f, 6.f, 1.f, inf, 0.f})));
  CHECK(cloud.size() == 3);
  REQUIRE(cloud.warnings.size() == 1);
  CHECK(cloud.warnings[0] == "2 of 3 points are not finite");
}

TEST_CASE("gaussian splats are refused unless their centres are asked for") {
  const std::string header =
      little + "element vertex 1\n" + xyz + "property float f_dc_0\nproperty float opacity\n";
  const auto path = ply(header, bytes({1.f, 2.f, 3.f, 0.f, 0.f}));
  CHECK_THROWS_AS(io::read_cloud(path), format_error);
  const auto centres = io::read_cloud(path, {.splats = io::splat_rule::centres});
  CHECK(centres.size() == 1);
  CHECK(centres.warnings.size() == 1);
}

TEST_CASE("positions come block by block as the whole cloud has them") {
  const auto positions = [](const std::filesystem::path& path) {
    io::ply_positions file(path);
    std::vector<Eigen::Vector3d> all, block;
    while (file.next(block)) all.insert(all.end(), block.begin(), block.end());
    CHECK(all.size() == file.size());
    return all;
  };
  const auto check_same = [&](const std::filesystem::path& path) {
    const auto found = positions(path);
    const auto cloud = io::read_ply_cloud(path);
    REQUIRE(found.size() == cloud.size());
    bool same = true;
    for (std::size_t i = 0; i < found.size(); ++i) same &= found[i] == cloud.position(i);
    CHECK(same);
  };
  const std::string before = "element camera 1\nproperty uchar id\n";
  const std::string scattered =
      "property uchar red\nproperty double z\nproperty int x\nproperty short y\n";
  const auto row = [](double z, std::int32_t x, std::int16_t y) {
    return bytes<std::uint8_t>({7}) + bytes({z}, std::endian::big) + bytes({x}, std::endian::big) +
           bytes({y}, std::endian::big);
  };
  check_same(ply(big + before + "element vertex 2\n" + scattered,
                 "!" + row(0.5, 3, -4) + row(-2.25, 5, 6)));
  check_same(ply(little + "element vertex 2\n" + xyz + "property list uchar uchar of\n",
                 bytes({1.f, 2.f, 3.f}) + "\1a" + bytes({4.f, 5.f, 6.f}) + std::string(1, '\0')));
  std::string many;
  for (int i = 0; i < 3 * 70'000; ++i) io::store(many, static_cast<float>(i));
  check_same(ply(little + "element vertex 70000\n" + xyz, many));
  CHECK(io::ply_positions(ply(little + "element vertex 0\n" + xyz, "")).size() == 0);
  CHECK_THROWS_AS(positions(ply(little + "element vertex 70001\n" + xyz, many)), format_error);
  CHECK_THROWS_AS(positions(ply(ascii + "element vertex 1\n" + xyz, "1 2 3")), format_error);
  CHECK_THROWS_AS(positions(ply(little + "element face 0\nproperty uchar a\n", "")), format_error);
}

TEST_CASE("polygons of a ply become fans and carry their labels") {
  const std::string header = ascii + "comment labels: 0=ground 2=tower\nelement vertex 5\n" + xyz +
                             "element face 3\nproperty uchar label\n"
                             "property list uchar int vertex_index\n";
  const auto mesh = io::read_mesh(
      ply(header, "0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n2 5 0 1 2 3 4\n0 3 4 0 1\n1 2 0 1\n"));
  CHECK(mesh.triangles == std::vector<mesh::triangle>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {4, 0, 1}});
  CHECK(mesh.labels == std::vector<std::uint32_t>{2, 2, 2, 0});
  CHECK(mesh.label_names == std::vector<std::string>{"ground", "", "tower"});
  CHECK(mesh.warnings == std::vector<std::string>{"1 faces of less than 3 vertices were dropped"});
}

TEST_CASE("up = y turns clouds and meshes so that z points up") {
  const std::string header = ascii + "element vertex 3\n" + xyz +
                             "property float nx\nproperty float ny\nproperty float nz\n"
                             "element face 1\nproperty list uchar int vertex_indices\n";
  const auto path = ply(header, "1 2 3 0 1 0\n0 0 0 0 1 0\n1 0 0 0 1 0\n3 0 1 2\n");
  const auto cloud = io::read_cloud(path, {.up = io::up_axis::y});
  CHECK(cloud.points[0] == Eigen::Vector3f(1, -3, 2));
  CHECK(cloud.normals[0] == Eigen::Vector3f(0, 0, 1));
  CHECK(io::read_mesh(path, {.up = io::up_axis::y}).vertices[0] == Eigen::Vector3f(1, -3, 2));
}

TEST_CASE("a damaged ply is refused with the place and the defect") {
  const std::string two = "element vertex 2\n" + xyz;
  const std::string faces =
      "element vertex 1\n" + xyz + "element face 1\nproperty list int int vertex_indices\n";
  CHECK(
      error_of("format text 1.0\n" + two, "") ==
      ":2: ply: format ascii, binary_little_endian or binary_big_endian expected, found \"text\"");
  CHECK(error_of(two, "") == ":6: ply: no format line in the header");
  CHECK(error_of(ascii + "property float x\n", "") == ":3: ply: property before the first element");
  CHECK(error_of(ascii + "element vertex -2\n", "") ==
        ":3: ply: count of element vertex expected, found \"-2\"");
  CHECK(error_of(ascii + "element vertex\n", "") == ":3: ply: expected \"element NAME COUNT\"");
  CHECK(error_of(ascii + "element vertex 1\nproperty half x\n", "") ==
        ":4: ply: unknown type \"half\"");
  CHECK(error_of(ascii + "element vertex 1\nproperty list float int x\n", "") ==
        ":4: ply: the count of a list must be an integer type");
  CHECK(error_of(ascii + "elemant vertex 1\n", "") ==
        ":3: ply: format, element, property, comment or end_header expected, found \"elemant\"");
  CHECK(error_of(ascii + "element point 0\n", "") == ": ply: no element vertex");
  CHECK(error_of(ascii + "element vertex 0\nproperty float x\n", "") ==
        ": ply: element vertex has no properties x, y and z");
  CHECK(
      error_of(little + two, "1234") ==
      ": ply: element vertex: 2 rows of at least 12 bytes expected, the file has 4 bytes for them");
  CHECK(
      error_of(little + "element vertex 4000000000\n" + xyz, "1234") ==
      ": ply: element vertex: 4000000000 rows of at least 12 bytes expected, the file has 4 bytes "
      "for them");
  CHECK(error_of(ascii + two, "1 2 3 \n4 5    \n") == ":9: ply: the line ends where z is expected");
  CHECK(error_of(ascii + two, "1 2 3 \n4 5 six\n") ==
        ":9: ply: a number expected for z, found \"six\"");
  CHECK(error_of(ascii + two, "1 2 3 4\n4 5 6\n") ==
        ":8: ply: vertex has 3 properties, the line goes on with \"4\"");
  CHECK(error_of(ascii + two, "1 2 3\n       \n") ==
        ":9: ply: the file ends within element vertex");
  CHECK(error_of(ascii + faces, "0 0 0\n3 0 0 1\n") ==
        ":11: ply: face 0: one of 1 vertices expected, found index 1");
  CHECK(error_of(ascii + faces, "0 0 0\n3 0 0 -1\n") ==
        ":11: ply: face 0: one of 1 vertices expected, found index -1");
  CHECK(error_of(little + faces, bytes({0.f, 0.f, 0.f}) + bytes({-1})) ==
        ": byte 183: ply: list vertex_indices of -1 items");
  CHECK(error_of(little + faces, bytes({0.f, 0.f, 0.f}) + bytes({1000000000})) ==
        ": byte 183: vertex_indices: 4000000000 bytes expected, 0 left in the file");
  CHECK_THROWS_WITH_AS(io::read_mesh(ply(ascii + two, "1 2 3\n4 5 6\n")),
                       ((scratch.folder() / "a.ply").string() +
                        ": ply: a mesh expected, found a cloud (no element face)")
                           .c_str(),
                       format_error);
}

TEST_CASE("a file that is no cloud, is missing, or is a folder is refused in one sentence") {
  const auto path = scratch.folder() / "a.doc";
  io::write_file(path, "hello");
  CHECK_THROWS_AS(io::read_cloud(path), format_error);
  CHECK_THROWS_AS(io::read_mesh(path), format_error);
  CHECK_THROWS_AS(io::read_cloud(scratch.folder() / "missing.ply"), io_error);
  CHECK_THROWS_AS(io::read_cloud(scratch.folder()), io_error);
  CHECK_THROWS_AS(io::write_cloud(scratch.folder() / "a.doc", {}), argument_error);
}

TEST_CASE("a cloud that is written is read again as it was") {
  cloud::cloud cloud;
  for (int i = 0; i < 100000; ++i) {
    const auto f = static_cast<float>(i);
    cloud.points.emplace_back(f, 0.1f * f, -f);
    cloud.normals.emplace_back(0.f, 1.f, 0.f);
    cloud.colors.push_back({static_cast<std::uint8_t>(i), 2, 3});
    cloud.labels.push_back(static_cast<std::uint32_t>(i));
  }
  const auto path = scratch.folder() / "b.ply";
  const std::vector<float> errors(cloud.size(), 0.25f);
  io::write_cloud(path, cloud, {.scalars = {{"error", errors}}, .comments = {"two\nlines"}});
  const auto again = io::read_cloud(path);
  CHECK(again.points == cloud.points);
  CHECK(again.normals == cloud.normals);
  CHECK(again.colors == cloud.colors);
  CHECK(again.labels == cloud.labels);

  cloud.origin = {458005, 5429006, 165};
  cloud.points.resize(2);
  cloud.normals.clear();
  cloud.colors.clear();
  cloud.labels.clear();
  io::write_cloud(path, cloud);
  const auto far = io::read_cloud(path);
  CHECK((far.position(1) - cloud.position(1)).norm() < 1e-6);
  CHECK_THROWS_AS(io::write_cloud(path, cloud, {.scalars = {{"error", errors}}}), argument_error);
  CHECK_THROWS_AS(io::write_cloud(path, cloud, {.scalars = {{"my error", {}}}}), argument_error);
}

TEST_CASE("a mesh that is written is read again as it was") {
  const mesh::mesh mesh{.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                        .triangles = {{0, 1, 2}, {0, 3, 1}},
                        .labels = {1, 300},
                        .label_names = {"ground", "big tower"}};
  const std::vector<cloud::color> colors(4, {1, 2, 3});
  const auto path = scratch.folder() / "m.ply";
  io::write_mesh(path, mesh, {.vertex_colors = colors});
  const auto again = io::read_mesh(path);
  CHECK(again.vertices == mesh.vertices);
  CHECK(again.triangles == mesh.triangles);
  CHECK(again.labels == mesh.labels);
  CHECK(again.label_names == std::vector<std::string>{"ground", "big_tower"});
  CHECK(io::read_cloud(path).colors == colors);
}

TEST_CASE("meshes and clouds of the rendered scenes are read") {
  if (!support::has_shared("io: ply scenes")) return;
  const auto office = support::shared() / "scenes" / "gt" / "office";
  const auto mesh = io::read_mesh(office / "mesh.ply");
  CHECK(mesh.vertices.size() == 1292);
  CHECK(mesh.triangles.size() == 1886);
  CHECK(mesh.labels.size() == 1886);
  CHECK(mesh.label_names.at(4) == "glass");
  CHECK(io::read_cloud(office / "gt_points.ply").size() == 60000);
  const auto fused =
      io::read_cloud(support::shared() / "scenes/methods/sgbm_gtposes/crane/fused.ply");
  CHECK(fused.size() == 12000);
  CHECK(fused.normals.size() == 12000);
  CHECK(fused.colors.size() == 12000);
}

}  // namespace test_ply
