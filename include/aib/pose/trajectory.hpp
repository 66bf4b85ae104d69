// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/math/rigid3.hpp>
#include <aib/math/sim3.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace aib::pose {

/// Camera poses in the order of their source.
///
/// `names` and `stamps_s` are empty or as long as the poses. Axes of a camera: x right, y down, z
/// forward (OpenCV). A pose that is not finite is not registered.
struct trajectory {
  std::vector<math::rigid3> world_from_camera = {};
  std::vector<std::string> names = {};
  std::vector<double> stamps_s = {};
  std::vector<std::string> warnings = {};  ///< what the reader repaired or doubts, a sentence each

  [[nodiscard]] std::size_t size() const { return world_from_camera.size(); }
  [[nodiscard]] bool empty() const { return world_from_camera.empty(); }
};

/// Throws argument_error unless names and stamps are absent or one a pose.
inline void check(const trajectory& t) {
  const auto fits = [&](std::size_t n) { return n == 0 || n == t.size(); };
  if (fits(t.names.size()) && fits(t.stamps_s.size())) return;
  throw argument_error(message("trajectory: ", t.size(), " poses, ", t.names.size(), " names, ",
                               t.stamps_s.size(), " stamps: one of each a pose expected"));
}

/// The trajectory seen from another frame.
inline trajectory operator*(const math::sim3& b_from_a, trajectory t) {
  for (math::rigid3& pose : t.world_from_camera) pose = b_from_a * pose;
  return t;
}

/// Camera centres.
inline std::vector<Eigen::Vector3d> positions(const trajectory& t) {
  std::vector<Eigen::Vector3d> p;
  p.reserve(t.size());
  for (const math::rigid3& pose : t.world_from_camera) p.push_back(pose.translation);
  return p;
}

/// The poses at `indices`, with their names and stamps.
inline trajectory select(const trajectory& t, const std::vector<std::size_t>& indices) {
  trajectory out;
  for (const std::size_t i : indices) {
    out.world_from_camera.push_back(t.world_from_camera.at(i));
    if (!t.names.empty()) out.names.push_back(t.names.at(i));
    if (!t.stamps_s.empty()) out.stamps_s.push_back(t.stamps_s.at(i));
  }
  return out;
}

}  // namespace aib::pose
