// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/mesh/surface.hpp>
#include <aib/mesh/transform.hpp>

#include <doctest/doctest.h>

using namespace aib;

namespace test_transform {

TEST_CASE("a similarity moves the vertices of a mesh in double") {
  mesh::mesh m;
  m.vertices = {{0, 0, 0}, {3, 0, 0}, {0, 2, 0}};
  m.triangles = {{0, 1, 2}};
  m.labels = {4};
  const math::sim3 utm_from_local{2, Eigen::Matrix3d::Identity(), {458000.25, 5429000, 100}};
  const mesh::mesh moved = utm_from_local * m;
  CHECK(moved.position(1) == Eigen::Vector3d(458006.25, 5429000, 100));
  CHECK(mesh::area(m) == 3);
  CHECK(mesh::area(moved) == 12);
  CHECK(moved.labels == m.labels);
}

}  // namespace test_transform
