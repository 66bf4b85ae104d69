// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/mesh/distances.hpp>

#include <Eigen/Core>

#include <optional>

namespace aib::survey::detail {

/// Keeps away from a mesh.
class clearance {
 public:
  clearance(const mesh::surface_index& surface, double least) : surface_(surface), least_(least) {}

  struct nearest {
    Eigen::Vector3d point;
    double distance;
  };
  [[nodiscard]] nearest nearest_to(const Eigen::Vector3d& p) const {
    const Eigen::Vector3d in_tree = p - surface_.origin();
    const Eigen::Vector3f coarse = in_tree.cast<float>();
    const auto found = surface_.tree().nearest(coarse, 0);
    const auto on = search::nearest_on_triangle(in_tree, surface_.tree().triangle(found.place));
    return {on.position + surface_.origin(), (on.position - in_tree).norm()};
  }

  /// The place nearby that is far enough from everything; nothing where there is none.
  [[nodiscard]] std::optional<Eigen::Vector3d> pushed(Eigen::Vector3d p) const {
    for (int round = 0; round < 30; ++round) {
      const nearest near = nearest_to(p);
      if (near.distance >= least_) return p;
      if (!(near.distance > 1e-9)) return std::nullopt;
      p += (1.02 * least_ - near.distance) / near.distance * (p - near.point);
    }
    return std::nullopt;
  }

 private:
  const mesh::surface_index& surface_;
  double least_;
};

}  // namespace aib::survey::detail
