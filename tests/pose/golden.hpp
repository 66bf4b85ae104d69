// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/io/npy.hpp>
#include <aib/pose/trajectory.hpp>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "support/shared.hpp"
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace aib::support {

/// A file of expected numbers. NaN and infinities in it are strings.
inline nlohmann::json read_json(const std::filesystem::path& path) {
  std::ifstream file(path);
  return nlohmann::json::parse(file);
}

/// The cases of one kind in the list of expected numbers.
inline std::vector<nlohmann::json> golden_cases(const std::string& kind) {
  const nlohmann::json manifest = read_json(shared() / "golden" / "manifest.json");
  std::vector<nlohmann::json> out;
  for (const auto& c : manifest.at("cases")) {
    if (c.at("kind") == kind) out.push_back(c);
  }
  return out;
}

/// A stack of 4 x 4 world-to-camera matrices, projected to rotations.
inline pose::trajectory read_w2c(const std::filesystem::path& path) {
  const io::array a = io::read_npy(path);
  pose::trajectory out;
  for (std::size_t i = 0; i < a.shape.at(0); ++i) {
    math::rigid3 camera_from_world;
    for (Eigen::Index r = 0; r < 3; ++r) {
      const std::size_t row = 16 * i + 4 * static_cast<std::size_t>(r);
      camera_from_world.rotation.row(r) << a[row], a[row + 1], a[row + 2];
      camera_from_world.translation[r] = a[row + 3];
    }
    out.world_from_camera.push_back(camera_from_world.inverse());
  }
  return out;
}

inline Eigen::Matrix3d matrix3(const nlohmann::json& rows) {
  Eigen::Matrix3d m;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c)
      m(r, c) = rows.at(static_cast<std::size_t>(r)).at(static_cast<std::size_t>(c)).get<double>();
  }
  return m;
}

inline Eigen::Vector3d vector3(const nlohmann::json& v) {
  return {v.at(0).get<double>(), v.at(1).get<double>(), v.at(2).get<double>()};
}

}  // namespace aib::support
