// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/random.hpp>
#include <aib/math/rotation.hpp>
#include <aib/math/sim3.hpp>
#include <aib/pose/trajectory.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>

namespace aib::synthetic {

struct orbit_options {
  std::size_t frames = 30;
  double radius = 2;
  double turns = 1;
  double climb = 0.5;  ///< height gained
};

/// Cameras on a helix about the z axis, looking at its middle; named 000.png, 001.png, ..., a
/// second apart.
inline pose::trajectory orbit(const orbit_options& options = {}) {
  pose::trajectory out;
  for (std::size_t i = 0; i < options.frames; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(options.frames);
    const double angle = 2 * std::numbers::pi * options.turns * share;
    const Eigen::Vector3d centre(options.radius * std::cos(angle), options.radius * std::sin(angle),
                                 options.climb * share);
    const Eigen::Vector3d z = (Eigen::Vector3d(0, 0, 0.2) - centre).normalized();
    const Eigen::Vector3d x = z.cross(Eigen::Vector3d::UnitZ()).normalized();
    math::rigid3 pose;
    pose.rotation << x, z.cross(x), z;
    pose.translation = centre;
    out.world_from_camera.push_back(pose);
    std::string number = std::to_string(i);
    out.names.push_back(std::string(3 - std::min<std::size_t>(3, number.size()), '0') + number +
                        ".png");
    out.stamps_s.push_back(static_cast<double>(i));
  }
  return out;
}

struct noise_options {
  double rotation_deg = 0;  ///< standard deviation a component
  double position = 0;      ///< standard deviation a component
  std::uint64_t seed = 1;
};

inline Eigen::Vector3d normal3(random_engine& random) {
  const double x = random.normal(), y = random.normal(), z = random.normal();
  return {x, y, z};
}

inline pose::trajectory noisy(pose::trajectory t, const noise_options& options) {
  random_engine random(options.seed);
  for (math::rigid3& pose : t.world_from_camera) {
    const Eigen::Vector3d turn = math::radians(options.rotation_deg) * normal3(random);
    pose.rotation *= math::rotation_from(turn);
    pose.translation += options.position * normal3(random);
  }
  return t;
}

/// A similarity far from the identity.
inline math::sim3 some_sim3() {
  return {1.7, math::rotation_from(Eigen::Vector3d(0.3, -1.2, 0.9)), {4, 5, -6}};
}

}  // namespace aib::synthetic
