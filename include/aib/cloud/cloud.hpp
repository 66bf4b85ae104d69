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

}  // namespace aib::cloud
