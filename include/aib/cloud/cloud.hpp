// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/math/sim3.hpp>

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace aib::cloud {

using color = std::array<std::uint8_t, 3>;

/// Points with what may come with them. A point lies at `origin + points[i]`: float keeps a tenth
/// of a millimetre within a kilometre, the double origin keeps map coordinates (UTM) exact.
///
/// `normals`, `colors` and `labels` are empty or one a point.
struct cloud {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3f> points = {};
  std::vector<Eigen::Vector3f> normals = {};
  std::vector<color> colors = {};
  std::vector<std::uint32_t> labels = {};
  std::vector<std::string> warnings = {};  ///< what the reader removed or doubts, a sentence each

  [[nodiscard]] std::size_t size() const { return points.size(); }
  [[nodiscard]] bool empty() const { return points.empty(); }
  [[nodiscard]] Eigen::Vector3d position(std::size_t i) const {
    return origin + points[i].cast<double>();
  }
};

/// The origin that readers give a cloud whose box is [low, high]: 0 where floats hold it well
/// (|coordinate| < 1024), else the box centre in whole units.
[[nodiscard]] inline Eigen::Vector3d natural_origin(const Eigen::Vector3d& low,
                                                    const Eigen::Vector3d& high) {
  if (low.cwiseAbs().maxCoeff() < 1024 && high.cwiseAbs().maxCoeff() < 1024)
    return Eigen::Vector3d::Zero();
  return ((low + high) / 2).array().round();
}

}  // namespace aib::cloud
