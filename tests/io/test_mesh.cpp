// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/io/bytes.hpp>
#include <aib/io/cloud.hpp>
#include <aib/io/mesh.hpp>

#include <doctest/doctest.h>

#include <cstdint>
#include <string>
#include <support/scratch.hpp>
#include <vector>

using namespace aib;

namespace test_mesh {

namespace {

const support::scratch scratch;

std::string error_of(const std::filesystem::path& path) {
  try {
    static_cast<void>(io::read_mesh(path));
  } catch (const format_error& e) {
    return std::string(e.what()).substr(path.string().size());
  }
  return "no error";
}

std::string numbers(std::initializer_list<float> values) {
  std::string bytes;
  for (const float v : values) io::store(bytes, v);
  return bytes;
}

}  // namespace

TEST_CASE("an obj is read: polygons, textures, negative indices, joined lines") {
  const auto path = scratch.file("a.obj",
                                 "# made by hand\r\nmtllib a.mtl\r\no thing\nv 0 0 0\nv 1 0 0\n"
                                 "v 1 1 0 0.5 0.5 0.5\nv 0 1 0\nvn 0 0 1\nvt 0 0\n"
                                 "f 1/1/1 2/1/1 3//1 \\\n  4\nf -1 -2 -3\nl 1 2\nf 1 2\n");
  const auto mesh = io::read_mesh(path);
  CHECK(mesh.vertices.size() == 4);
  CHECK(mesh.triangles == std::vector<mesh::triangle>{{0, 1, 2}, {0, 2, 3}, {3, 2, 1}});
  CHECK(mesh.warnings == std::vector<std::string>{"1 faces of less than 3 vertices were dropped"});
  CHECK(io::read_mesh(path, {.up = io::up_axis::y}).vertices[3] == Eigen::Vector3f(0, 0, 1));
  CHECK(io::read_cloud(path).size() == 4);
}

TEST_CASE("an obj far from zero keeps its millimetres, one without faces is read") {
  const auto path = scratch.file("b.obj", "v 458000.001 5429000 160\nv 458001 5429000 160\n");
  const auto mesh = io::read_mesh(path);
  CHECK((mesh.position(0) - Eigen::Vector3d(458000.001, 5429000, 160)).norm() < 1e-6);
  CHECK(mesh.warnings == std::vector<std::string>{"no triangles"});
}

TEST_CASE("a damaged obj is refused with its line") {
  const auto refused = [](const std::string& text) {
    return error_of(scratch.file("c.obj", text));
  };
  const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  CHECK(refused("v 0 0\n") == ":1: obj: 3 coordinates of a vertex expected, found 2");
  CHECK(refused("v 0 zero 0\n") == ":1: obj: 3 coordinates of a vertex expected, found 1");
  for (const char* index : {"0", "-4", "x", "99999999999999999999", "4294967296"}) {
    CHECK(refused(three + "f 1 2 " + index + "\n") ==
          message(":4: obj: the index of a vertex (1 to 3, or -1 to -3) expected, found \"", index,
                  "\""));
  }
  CHECK(refused(three + "f 1 2 4\n") == ":4: obj: vertex 4 of 3");
  CHECK(refused("f 1 2 3\n" + three) == "no error");
}

TEST_CASE("an stl is read, ascii and binary, and its corners become shared") {
  const std::string facets =
      "facet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 1 0 0\n  vertex 0 1e0 0\n"
      " endloop\nendfacet\n"
      "facet normal 0 0 1\n outer loop\n  vertex 1 0 0\n  vertex 1 1 0\n  vertex -0 1 0\n"
      " endloop\nendfacet\n";
  std::string binary = "solid in name only";
  binary.resize(80);
  io::store(binary, std::uint32_t{2});
  binary += numbers({0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0}) + "ab";
  binary += numbers({0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 0}) + "ab";
  for (const auto& path : {scratch.file("a.stl", "solid a\n" + facets + "endsolid a\n"),
                           scratch.file("b.stl", binary)}) {
    const auto mesh = io::read_mesh(path);
    CHECK(mesh.vertices ==
          std::vector<Eigen::Vector3f>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}});
    CHECK(mesh.triangles == std::vector<mesh::triangle>{{0, 1, 2}, {1, 3, 2}});
  }
}

TEST_CASE("a damaged stl is refused") {
  const auto refused = [](const std::string& text) {
    return error_of(scratch.file("c.stl", text));
  };
  CHECK(refused("solid a\nfacet normal 0 0 1\nvertex 0 0\n") ==
        ":3: stl: a vertex of 3 numbers within a facet expected");
  CHECK(refused("solid a\nfacet normal 0 0 1\nvertex 0 0 0\nendfacet\n") ==
        ":4: stl: facets of 3 vertices expected");
  CHECK(refused("solid a\nfacet normal 0 0 1\nvertex 0 0 0\n") ==
        ":3: stl: the file ends within a facet");
  CHECK(refused("solid a\nhello\n").starts_with(":2: stl: facet, outer loop"));
  CHECK(refused(std::string(80, 'x') + numbers({1e9f})).find("bytes expected") !=
        std::string::npos);
  CHECK(refused("").find("bytes expected") != std::string::npos);
}

#if defined(AIB_WITH_JSON)

namespace {

/// A GLB file of one buffer: 4 corners of a square as floats, a colour each as 4 bytes, then the
/// indices 0 1 2 0 2 3 as 16-bit numbers.
std::string glb(const std::string& nodes, const std::string& primitive) {
  std::string json = R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":76}],"bufferViews":[
{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":16},
{"buffer":0,"byteOffset":64,"byteLength":12}],"accessors":[
{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},
{"bufferView":1,"componentType":5121,"count":4,"type":"VEC4","normalized":true},
{"bufferView":2,"componentType":5123,"count":6,"type":"SCALAR"}],
"meshes":[{"name":"square","primitives":[)" +
                     primitive + R"(]}],"nodes":[)" + nodes + R"(],"scenes":[{"nodes":[0]}]})";
  while (json.size() % 4 != 0) json += ' ';
  std::string buffer = numbers({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
  for (const int c : {1, 2, 3, 255, 4, 5, 6, 255, 7, 8, 9, 255, 10, 11, 12, 255})
    buffer += static_cast<char>(c);
  for (const int i : {0, 1, 2, 0, 2, 3}) io::store(buffer, static_cast<std::uint16_t>(i));
  std::string bytes = "glTF";
  io::store(bytes, std::uint32_t{2});
  io::store(bytes, static_cast<std::uint32_t>(12 + 16 + json.size() + buffer.size()));
  io::store(bytes, static_cast<std::uint32_t>(json.size()));
  bytes += "JSON" + json;
  io::store(bytes, static_cast<std::uint32_t>(buffer.size()));
  return bytes + std::string("BIN\0", 4) + buffer;
}

const std::string square = R"({"attributes":{"POSITION":0},"indices":2})";

}  // namespace

TEST_CASE("a glb is read with the transformations of its nodes") {
  const auto path =
      scratch.file("a.glb", glb(R"({"name":"root","translation":[0,0,5],"children":[1]},
                      {"name":"turned","mesh":0,"rotation":[0,0,0.7071067811865476,0.7071067811865476],
                       "scale":[2,2,2]})",
                                square));
  const auto mesh = io::read_mesh(path);
  REQUIRE(mesh.vertices.size() == 4);
  CHECK(mesh.vertices[1].isApprox(Eigen::Vector3f(0, 2, 5), 1e-6f));
  CHECK(mesh.triangles == std::vector<mesh::triangle>{{0, 1, 2}, {0, 2, 3}});
  CHECK(mesh.labels == std::vector<std::uint32_t>{0, 0});
  CHECK(mesh.label_names == std::vector<std::string>{"turned"});
  CHECK(io::read_cloud(path).size() == 4);
  const auto matrix = io::read_mesh(scratch.file(
      "b.glb", glb(R"({"mesh":0,"matrix":[1,0,0,0, 0,1,0,0, 0,0,1,0, 10,20,30,1]})", square)));
  CHECK(matrix.vertices[2] == Eigen::Vector3f(11, 21, 30));
  CHECK(matrix.label_names == std::vector<std::string>{"square"});
}

TEST_CASE("strips, fans and points of a glb") {
  const auto with = [](const std::string& primitive) {
    return scratch.file("c.glb", glb(R"({"mesh":0})", primitive));
  };
  CHECK(io::read_mesh(with(R"({"attributes":{"POSITION":0},"mode":5})")).triangles ==
        std::vector<mesh::triangle>{{0, 1, 2}, {1, 3, 2}});
  CHECK(io::read_mesh(with(R"({"attributes":{"POSITION":0},"mode":6})")).triangles ==
        std::vector<mesh::triangle>{{0, 1, 2}, {0, 2, 3}});
  const auto cloud = io::read_cloud(with(R"({"attributes":{"POSITION":0,"COLOR_0":1},"mode":0})"));
  CHECK(cloud.points.at(2) == Eigen::Vector3f(1, 1, 0));
  CHECK(cloud.colors.at(3) == cloud::color{10, 11, 12});
}

TEST_CASE("a damaged glb is refused, or read, nothing worse") {
  const auto refused = [](const std::string& bytes) {
    return error_of(scratch.file("d.glb", bytes));
  };
  const std::string good = glb(R"({"mesh":0})", square);
  CHECK(refused(glb(R"({"children":[0]})", square)) == ": glb: the nodes are not a tree");
  CHECK(refused(glb(R"({"mesh":7})", square)) == ": glb: no element 7 in meshes");
  CHECK(refused(glb(R"({"mesh":-1})", square)) == ": glb: mesh: a whole number expected");
  CHECK(refused(glb(R"({"mesh":0})", R"({"attributes":{"POSITION":2}})")) ==
        ": glb: numbers of type 5123 are not supported");
  CHECK(refused("glTF\x03") != "no error");
  for (std::size_t n = 0; n < good.size(); n += 3) CHECK(refused(good.substr(0, n)) != "no error");
  for (std::size_t at = 0; at < good.size(); ++at) {
    std::string changed = good;
    changed[at] = static_cast<char>(changed[at] ^ (1 << at % 8));
    static_cast<void>(refused(changed));
  }
}

#endif

TEST_CASE("what is read as a mesh but is none is refused with advice") {
  CHECK(error_of(scratch.file("a.gltf", "{}")) ==
        ": glTF of several files is not supported; export it as .glb");
  CHECK(error_of(scratch.file("a.xyz", "1 2 3\n")) == ": a mesh expected: PLY, OBJ, STL or GLB");
}

}  // namespace test_mesh
