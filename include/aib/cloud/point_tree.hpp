// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/cloud.hpp>
#include <aib/cloud/positions.hpp>
#include <aib/core/executor.hpp>

#include <Eigen/Core>
#include <nanoflann.hpp>

#include <cstddef>
#include <vector>

namespace aib::cloud::detail {

/// Finite positions of a cloud, counted from an origin, and where each stood, as nanoflann asks for
/// them.
struct finite_positions {
  std::vector<Eigen::Vector3d> position;
  std::vector<std::size_t> source;
  control how;  ///< asked while a tree is built

  finite_positions(const cloud& c, const Eigen::Vector3d& origin, const control& h) : how(h) {
    const Eigen::Vector3d shift = c.origin - origin;
    for (std::size_t i = 0; i < c.size(); ++i) {
      if (!is_finite(c.points[i])) continue;
      position.push_back(c.points[i].cast<double>() + shift);
      source.push_back(i);
    }
  }

  [[nodiscard]] std::size_t kdtree_get_point_count() const { return position.size(); }
  [[nodiscard]] double kdtree_get_pt(std::size_t i, std::size_t axis) const {
    if (axis == 0 && i % 65536 == 0) demand_go(how);
    return position[i][static_cast<Eigen::Index>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

/// A k-d tree over them, in double.
using point_tree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, finite_positions>,
                                        finite_positions,
                                        3,
                                        std::size_t>;

}  // namespace aib::cloud::detail
