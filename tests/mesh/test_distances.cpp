// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/core/random.hpp>
#include <aib/io/mesh.hpp>
#include <aib/io/npy.hpp>
#include <aib/mesh/distances.hpp>
#include <aib/mesh/transform.hpp>
#include <aib/sample/mesh.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <support/shared.hpp>
#include <vector>

using namespace aib;

namespace test_distances {

namespace {

/// Soup of triangles of many sizes, slivers and some without area.
mesh::mesh soup(std::size_t n, std::uint64_t seed) {
  random_engine random(seed);
  const auto coordinate = [&](double size) {
    return static_cast<float>(random.uniform(-size, size));
  };
  mesh::mesh m;
  for (std::uint32_t t = 0; t < n; ++t) {
    const Eigen::Vector3f at(coordinate(5), coordinate(5), coordinate(5));
    const double size = random.uniform() < 0.05 ? 3 : 0.3;
    for (int k = 0; k < 3; ++k) {
      const float x = coordinate(size), y = coordinate(size), z = coordinate(size);
      m.vertices.push_back(at + Eigen::Vector3f(x, y, z));
    }
    if (t % 17 == 0) m.vertices[3 * t + 1] = m.vertices[3 * t];
    m.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  return m;
}

cloud::cloud uniform(std::size_t n, double size, std::uint64_t seed) {
  random_engine random(seed);
  cloud::cloud c;
  for (std::size_t i = 0; i < n; ++i) {
    const auto coordinate = [&] { return static_cast<float>(random.uniform(-size, size)); };
    const float x = coordinate(), y = coordinate(), z = coordinate();
    c.points.push_back({x, y, z});
  }
  return c;
}

double to_segment(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const double length = (b - a).squaredNorm();
  const double share = length > 0 ? std::clamp((b - a).dot(p - a) / length, 0.0, 1.0) : 0;
  return (a + share * (b - a) - p).norm();
}

/// By the plane where the foot of p lies within the triangle, else by its sides.
double to_triangle(const Eigen::Vector3d& p, const std::array<Eigen::Vector3d, 3>& t) {
  const Eigen::Vector3d normal = (t[1] - t[0]).cross(t[2] - t[0]);
  double least = std::numeric_limits<double>::infinity();
  bool inside = normal.norm() > 1e-9 * (t[1] - t[0]).norm() * (t[2] - t[0]).norm();
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector3d &a = t[k], &b = t[(k + 1) % 3];
    least = std::min(least, to_segment(p, a, b));
    inside = inside && (b - a).cross(p - a).dot(normal) >= 0;
  }
  return inside ? std::abs((p - t[0]).dot(normal)) / normal.norm() : least;
}

double brute_force(const Eigen::Vector3f& p, const mesh::mesh& m) {
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < m.triangles.size(); ++t)
    best = std::min(best, to_triangle(p.cast<double>(), mesh::corners(m, t)));
  return best;
}

/// Distances to a mesh of one triangle, of many points about it, are those of brute force.
void check_triangle(const std::vector<Eigen::Vector3f>& corners) {
  const mesh::mesh m{.vertices = corners, .triangles = {{0, 1, 2}}};
  for (const cloud::cloud& c : {uniform(50, 2, 8), uniform(20, 300, 9)}) {
    const auto d = mesh::distances(c, m);
    for (std::size_t i = 0; i < c.size(); ++i)
      CHECK(d[i] == doctest::Approx(brute_force(c.points[i], m)).epsilon(1e-6));
  }
}

/// One triangle in the plane z = 0 with legs of 4.
mesh::mesh triangle() {
  mesh::mesh m;
  m.vertices = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
  m.triangles = {{0, 1, 2}};
  return m;
}

}  // namespace

TEST_CASE("the nearest point of a triangle lies on its face, an edge or a corner") {
  const auto at = [](float x, float y, float z) {
    cloud::cloud c{.points = {{x, y, z}}};
    return mesh::distances(c, triangle())[0];
  };
  CHECK(at(1, 1, 2) == 2);
  CHECK(at(1, 1, -2) == 2);
  CHECK(at(2, -3, 0) == 3);
  CHECK(at(-3, 2, 0) == 3);
  CHECK(at(-3, -4, 0) == 5);
  CHECK(at(7, -4, 0) == 5);
  CHECK(at(-4, 7, 0) == 5);
  CHECK(at(4, 4, 0) == doctest::Approx(std::sqrt(8)));
}

TEST_CASE("distances to a mesh equal brute force") {
  const mesh::mesh m = soup(700, 1);
  for (const cloud::cloud& c : {uniform(500, 6, 2), uniform(50, 1000, 3)}) {
    const auto d = mesh::distances(c, m);
    for (std::size_t i = 0; i < c.size(); ++i)
      CHECK(d[i] == doctest::Approx(brute_force(c.points[i], m)).epsilon(1e-6));
  }
}

TEST_CASE("a triangle without area is its edges, whichever corners coincide or lie between") {
  check_triangle({{-1, 0, 0}, {-1, 0, 0}, {0, -1, -1}});
  check_triangle({{-1, 0, 0}, {0, -1, -1}, {-1, 0, 0}});
  check_triangle({{0, -1, -1}, {-1, 0, 0}, {-1, 0, 0}});
  check_triangle({{1, 2, 1}, {1, 2, 1}, {1, 2, 1}});
  random_engine random(6);
  for (int i = 0; i < 300; ++i) {
    std::vector<Eigen::Vector3f> on_a_line;
    const Eigen::Vector3f along(1, i % 2 ? 0.7F : 0, i % 3 ? 0.3F : 0);
    for (int k = 0; k < 3; ++k)
      on_a_line.push_back(static_cast<float>(random.uniform(-1, 1)) * along);
    check_triangle(on_a_line);
  }
}

TEST_CASE("distances to a mesh are the same for any number of threads") {
  const mesh::mesh m = soup(300, 4);
  const cloud::cloud c = uniform(20000, 6, 5);
  const auto one = mesh::distances(c, m, {.threads = 1});
  const auto three = mesh::distances(c, m, {.threads = 3});
  CHECK(std::equal(one.values().begin(), one.values().end(), three.values().begin()));
}

TEST_CASE("a mesh far from its points, in another origin, with parts that are not finite") {
  mesh::mesh m = triangle();
  m.origin = {458000, 5429000, 100};
  m.vertices.push_back({std::numeric_limits<float>::quiet_NaN(), 0, 0});
  m.vertices.push_back({1e19F, 0, 0});
  m.triangles.insert(m.triangles.begin(), {0, 1, 3});
  m.triangles.push_back({0, 1, 4});
  cloud::cloud c{.points = {{1, 1, 0.5f}, {std::numeric_limits<float>::infinity(), 0, 0}}};
  c.origin = {458000, 5429000, 101};
  const auto d = mesh::distances(c, m);
  CHECK(d[0] == 1.5);
  CHECK(d.n_dropped() == 1);
  const mesh::surface_index index(m);
  CHECK(mesh::closest(c, index).triangle[0] == 1);
  CHECK_THROWS_AS(mesh::distances(c, mesh::mesh{}), undefined_error);
  CHECK_THROWS_AS(mesh::distances(cloud::cloud{}, m), undefined_error);
}

TEST_CASE("a cloud on a mesh has no error, whatever the sampling") {
  const mesh::mesh m = soup(100, 6);
  const auto a = sample::mesh(m, {.n = 3000, .seed = 1});
  const auto b = sample::mesh(m, {.n = 3000, .seed = 2});
  const auto c = mesh::compare(a.points, m, b.points, {.tau = {1e-5}});
  CHECK(c.accuracy < 1e-6);
  CHECK(c.scores[0].precision == 1);
  CHECK(c.completeness > 0.001);
}

TEST_CASE("point-to-mesh distances equal Open3D's") {
  if (!support::has_shared("mesh golden")) return;
  const auto golden = support::shared() / "golden" / "mesh";
  for (const std::string file : {"knot.ply", "spot.obj"}) {
    CAPTURE(file);
    const std::string name = file.substr(0, 4);
    const mesh::mesh m = io::read_mesh(golden / file);
    const auto queries = io::read_npy(golden / (name + "_queries.npy"));
    const auto expected = io::read_npy(golden / (name + "_distances_f32.npy"));
    std::vector<std::array<double, 3>> points(expected.size());
    for (std::size_t i = 0; i < 3 * points.size(); ++i) points[i / 3][i % 3] = queries[i];
    const auto d = mesh::distances(cloud::from_points(points), m);
    const double tolerance = 1e-5 * cloud::bounds(m.vertices, m.origin).size().norm();
    double worst = 0;
    for (std::size_t i = 0; i < d.size(); ++i) {
      worst = std::max(worst, std::abs(static_cast<double>(d[i]) - expected[i]));
    }
    CHECK(worst <= tolerance);
  }
}

}  // namespace test_distances
