// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/core/random.hpp>
#include <aib/mesh/edges.hpp>
#include <aib/mesh/face_scores.hpp>
#include <aib/mesh/offsets.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

using namespace aib;

namespace test_offsets {

namespace {

/// The cube [0, 1]^3, faces outward; vertices shared or, as in STL, repeated.
mesh::mesh cube(bool shared) {
  mesh::mesh m;
  for (int v = 0; v < 8; ++v) {
    m.vertices.emplace_back(static_cast<float>(v & 1), static_cast<float>(v >> 1 & 1),
                            static_cast<float>(v >> 2));
  }
  m.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                 {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  if (shared) return m;
  mesh::mesh soup;
  for (const auto& t : m.triangles) {
    const auto n = static_cast<std::uint32_t>(soup.vertices.size());
    for (const std::uint32_t v : t) soup.vertices.push_back(m.vertices[v]);
    soup.triangles.push_back({n, n + 1, n + 2});
  }
  return soup;
}

float signed_distance(const Eigen::Vector3f& p) {
  const Eigen::Vector3f d = (p.array() - 0.5f).abs() - 0.5f;
  const float outside = d.cwiseMax(0.0f).norm();
  return outside > 0 ? outside : d.maxCoeff();
}

}  // namespace

TEST_CASE("a closed surface has no open edge, whether corners are shared or repeated") {
  CHECK(mesh::is_watertight(cube(true)));
  CHECK(mesh::is_watertight(cube(false)));
  mesh::mesh open = cube(true);
  open.triangles.pop_back();
  CHECK(mesh::n_open_edges(open) == 3);
  mesh::mesh turned = cube(true);
  std::swap(turned.triangles[0][0], turned.triangles[0][1]);
  CHECK_FALSE(mesh::is_watertight(turned));
  CHECK_FALSE(mesh::is_watertight(mesh::mesh{}));
}

TEST_CASE("offsets from a cube are negative inside, also nearest to edges and corners") {
  random_engine random(3);
  cloud::cloud c;
  for (int i = 0; i < 3000; ++i) {
    const auto coordinate = [&] { return static_cast<float>(random.uniform(-1, 2)); };
    const float x = coordinate(), y = coordinate(), z = coordinate();
    c.points.emplace_back(x, y, z);
  }
  c.points.emplace_back(-1.0f, -1.0f, -1.0f);
  c.points.emplace_back(0.5f, 2.0f, 2.0f);
  for (const mesh::mesh& m : {cube(true), cube(false)}) {
    const auto o = mesh::offsets(c, m);
    for (std::size_t i = 0; i < c.size(); ++i) {
      CHECK(o[i] == doctest::Approx(signed_distance(c.points[i])).epsilon(1e-5));
    }
  }
}

TEST_CASE("a mesh with holes has no inside, and says how many edges are open") {
  mesh::mesh open = cube(true);
  open.triangles.pop_back();
  const cloud::cloud c{.points = {{0, 0, 0}}};
  CHECK_THROWS_WITH_AS((void)mesh::offsets(c, open),
                       "mesh::offsets: a watertight mesh expected, found 3 open edges",
                       argument_error);
}

TEST_CASE("faces have the scores of their own points") {
  const mesh::mesh m = cube(true);
  cloud::cloud estimate{.points = {{0.75f, 0.7f, -0.25f}, {0.7f, 0.7f, -0.75f}}};
  const cloud::cloud samples{.points = {{0.75f, 0.7f, 0}, {0.2f, 0.2f, 1}}};
  const auto s = mesh::scores_by_face(estimate, m, samples, 0.5);
  CHECK(s.accuracy[1] == 0.5f);
  CHECK(s.n_estimate[1] == 2);
  CHECK(std::isnan(s.accuracy[0]));
  CHECK(s.completeness[1] == 0.25f);
  CHECK(s.recall[1] == 1);
  CHECK(s.recall[2] == 0);
  CHECK(s.n_samples[2] == 1);
  const auto near = mesh::scores_by_face(estimate, m, samples, 0.5, {.max_distance = 0.5});
  CHECK(near.accuracy[1] == 0.25f);
}

TEST_CASE("points take the labels of the faces nearest to them") {
  mesh::mesh m = cube(true);
  CHECK_THROWS_AS((void)mesh::nearest_labels(cloud::cloud{.points = {{0, 0, 0}}}, m),
                  argument_error);
  for (std::uint32_t t = 0; t < 12; ++t) m.labels.push_back(t / 2);
  const cloud::cloud c{.points = {{0.6f, 0.5f, -1}, {0.5f, 0.4f, 2}, {3, 0.5f, 0.4f}}};
  CHECK(mesh::nearest_labels(c, m) == std::vector<std::uint32_t>{0, 1, 5});
}

}  // namespace test_offsets
