// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/cloud.hpp>
#include <aib/cloud/point_tree.hpp>
#include <aib/core/executor.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace aib::cloud {

/// Another point and how far it is.
struct neighbour {
  std::size_t index;  ///< in the cloud
  double distance;
};

/// The finite points of a cloud, to be asked for their k nearest and for those within a radius.
/// Borrows nothing. For the one nearest point of millions see cloud::distances.
class neighbours {
 public:
  /// control   asked while the tree is built
  explicit neighbours(const cloud& c, const control& control = {})
      : origin_(c.origin), points_(c, c.origin, control), tree_(3, points_, {10}) {}
  neighbours(const neighbours&) = delete;
  neighbours& operator=(const neighbours&) = delete;

  [[nodiscard]] std::size_t size() const { return points_.position.size(); }

  /// The k nearest points (fewer where the cloud has no more), nearest first; a point of the cloud
  /// finds itself first.
  [[nodiscard]] std::vector<neighbour> nearest(const Eigen::Vector3d& p, std::size_t k) const {
    k = std::min(k, points_.position.size());
    std::vector<std::size_t> index(k);
    std::vector<double> squared(k);
    const Eigen::Vector3d local = p - origin_;
    const std::size_t n =
        k == 0 ? 0 : tree_.knnSearch(local.data(), k, index.data(), squared.data());
    std::vector<neighbour> found;
    for (std::size_t i = 0; i < n; ++i) {
      found.push_back({points_.source[index[i]], std::sqrt(squared[i])});
    }
    return found;
  }

  /// Calls `visit(index)` for each point nearer than `radius`, in no order.
  template <class Visit>
  void for_each_within(const Eigen::Vector3d& p, double radius, Visit&& visit) const {
    const Eigen::Vector3d local = p - origin_;
    visitor<Visit> inside{radius * radius, points_.source, visit};
    (void)tree_.radiusSearchCustomCallback(local.data(), inside);
  }

  /// How many points lie nearer than `radius`.
  [[nodiscard]] std::size_t count_within(const Eigen::Vector3d& p, double radius) const {
    std::size_t n = 0;
    for_each_within(p, radius, [&](std::size_t) { ++n; });
    return n;
  }

 private:
  /// A result set, which is the same in every version of nanoflann.
  template <class Visit>
  struct visitor {
    double squared_radius;
    const std::vector<std::size_t>& source;
    Visit& visit;

    bool addPoint(double squared, std::size_t place) {
      if (squared < squared_radius) visit(source[place]);
      return true;
    }
    [[nodiscard]] double worstDist() const { return squared_radius; }
    [[nodiscard]] std::size_t size() const { return 0; }
    [[nodiscard]] bool full() const { return true; }
  };

  Eigen::Vector3d origin_;
  detail::finite_positions points_;
  detail::point_tree tree_;
};

}  // namespace aib::cloud
