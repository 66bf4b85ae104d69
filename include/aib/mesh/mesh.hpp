// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace aib::mesh {

using triangle = std::array<std::uint32_t, 3>;

/// Triangles over shared vertices. A vertex lies at `origin + vertices[i]`, as a point of a cloud
/// does.
///
/// `labels` is empty or one a triangle; `label_names[k]` names label k where the source does.
struct mesh {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3f> vertices = {};
  std::vector<triangle> triangles = {};
  std::vector<std::uint32_t> labels = {};
  std::vector<std::string> label_names = {};
  std::vector<std::string> warnings = {};  ///< what the reader removed or doubts, a sentence each

  [[nodiscard]] bool empty() const { return triangles.empty(); }
  [[nodiscard]] Eigen::Vector3d position(std::size_t vertex) const {
    return origin + vertices[vertex].cast<double>();
  }
};

}  // namespace aib::mesh
