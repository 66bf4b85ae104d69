// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/cloud/distances.hpp>
#include <aib/io/ply.hpp>
#include <aib/sample/mesh.hpp>

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <support/shared.hpp>

using namespace aib;

namespace test_mesh {

namespace {

/// Two triangles: one of area 3 in the plane z = 0, labelled 5, one of area 1 in the plane x = 0,
/// labelled 6.
mesh::mesh two_triangles() {
  mesh::mesh m;
  m.vertices = {{0, 0, 0}, {3, 0, 0}, {0, 2, 0}, {0, 0, 1}, {0, 0, 0}, {0, 2, 0}};
  m.triangles = {{0, 1, 2}, {3, 4, 5}};
  m.labels = {5, 6};
  return m;
}

}  // namespace

TEST_CASE("samples are shared out by area and carry label and normal of their triangle") {
  const auto s = sample::mesh(two_triangles(), {.n = 40000});
  CHECK(s.area == 4);
  CHECK(s.density == 10000);
  CHECK(s.floor == doctest::Approx(0.005));
  REQUIRE(s.points.size() == 40000);
  std::size_t first = 0;
  Eigen::Vector3d mean(0, 0, 0);
  for (std::size_t i = 0; i < s.points.size(); ++i) {
    const Eigen::Vector3f& p = s.points.points[i];
    if (s.points.labels[i] == 5) {
      ++first;
      mean += p.cast<double>();
      CHECK(p.z() == 0);
      CHECK(p.x() / 3 + p.y() / 2 <= 1 + 1e-6);
      CHECK(s.points.normals[i] == Eigen::Vector3f(0, 0, 1));
    } else {
      CHECK(p.x() == 0);
    }
  }
  CHECK(std::abs(static_cast<double>(first) - 30000) <= 1);
  mean /= static_cast<double>(first);
  CHECK(mean.x() == doctest::Approx(1).epsilon(0.02));
  CHECK(mean.y() == doctest::Approx(2 / 3.0).epsilon(0.02));
}

TEST_CASE("the number of samples follows from spacing or density") {
  CHECK(sample::mesh(two_triangles(), {.spacing = 0.1}).points.size() == 400);
  CHECK(sample::mesh(two_triangles(), {.per_area = 25.0}).points.size() == 100);
  CHECK(sample::mesh(two_triangles(), {.n = 1}).points.size() == 1);
}

TEST_CASE("samples depend on the seed, not on the threads") {
  const auto a = sample::mesh(two_triangles(), {.n = 1000, .seed = 4, .threads = 1});
  const auto b = sample::mesh(two_triangles(), {.n = 1000, .seed = 4, .threads = 3});
  const auto c = sample::mesh(two_triangles(), {.n = 1000, .seed = 5});
  CHECK(a.points.points == b.points.points);
  CHECK(a.points.points != c.points.points);
}

TEST_CASE("what cannot be sampled is refused") {
  CHECK_THROWS_AS(sample::mesh(two_triangles(), {}), argument_error);
  CHECK_THROWS_AS(sample::mesh(two_triangles(), {.n = 5, .spacing = 1.0}), argument_error);
  CHECK_THROWS_AS(sample::mesh(two_triangles(), {.spacing = -1.0}), argument_error);
  CHECK_THROWS_AS(sample::mesh(two_triangles(), {.n = 0}), argument_error);
  CHECK_THROWS_AS(sample::mesh(two_triangles(), {.spacing = 1e-9}), argument_error);
  CHECK_THROWS_AS(sample::mesh({}, {.n = 5}), undefined_error);
  mesh::mesh broken = two_triangles();
  broken.vertices[1].x() = std::numeric_limits<float>::quiet_NaN();
  const auto s = sample::mesh(broken, {.n = 10});
  CHECK(s.area == 1);
  for (const auto label : s.points.labels) CHECK(label == 6);
}

TEST_CASE("two samplings of one surface lie as far apart as Open3D's do") {
  if (!support::has_shared("mesh sampling golden")) return;
  const auto knot = io::read_ply_mesh(support::shared() / "golden" / "mesh" / "knot.ply");
  CHECK(mesh::area(knot) == doctest::Approx(112072.277931022).epsilon(1e-6));
  const auto a = sample::mesh(knot, {.n = 20000, .seed = 1});
  const auto b = sample::mesh(knot, {.n = 20000, .seed = 2});
  CHECK(a.floor == doctest::Approx(1.1835976825500196));
  CHECK(cloud::distances(a.points, b.points).mean() == doctest::Approx(1.1468).epsilon(0.03));
}

}  // namespace test_mesh
