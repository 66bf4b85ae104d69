// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/cloud/transform.hpp>

#include <doctest/doctest.h>

using namespace aib;

namespace test_transform {

TEST_CASE("a similarity moves points in double and turns normals") {
  Eigen::Matrix3d quarter;  // about z
  quarter << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  const math::sim3 utm_from_local{2, quarter, {458000, 5429000, 100}};
  cloud::cloud local{.points = {{1.0625f, 0, 0}, {0, 2, 0}}, .normals = {{1, 0, 0}, {0, 0, 1}}};
  local.labels = {7, 8};
  const cloud::cloud utm = utm_from_local * local;
  CHECK(utm.position(0) == Eigen::Vector3d(458000, 5429002.125, 100));
  CHECK(utm.position(1) == Eigen::Vector3d(457996, 5429000, 100));
  CHECK(utm.normals[0] == Eigen::Vector3f(0, 1, 0));
  CHECK(utm.normals[1] == Eigen::Vector3f(0, 0, 1));
  CHECK(utm.labels == local.labels);
  const cloud::cloud back = utm_from_local.inverse() * utm;
  CHECK(back.origin == Eigen::Vector3d(0, 0, 0));
  CHECK((back.points[0] - local.points[0]).norm() < 1e-6);
}

}  // namespace test_transform
