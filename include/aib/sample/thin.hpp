// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/cloud.hpp>
#include <aib/cloud/positions.hpp>
#include <aib/cloud/select.hpp>
#include <aib/core/error.hpp>
#include <aib/core/executor.hpp>
#include <aib/core/random.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

namespace aib::sample {

struct thin_options {
  double spacing = 0;  ///< in the unit of the cloud
  std::uint64_t seed = 1;
  aib::control control = {};
};

namespace detail {

/// Chosen points in cells as wide as the spacing: a point nearer than it lies in one of 27 cells.
class spaced_points {
 public:
  explicit spaced_points(double spacing) : spacing_(spacing) {}

  /// Keeps p unless a kept point lies within the spacing.
  bool keep(const Eigen::Vector3d& p) {
    const cell at = cell_of(p);
    for (std::int64_t k = 0; k < 27; ++k) {
      const cell beside{at[0] + k % 3 - 1, at[1] + k / 3 % 3 - 1, at[2] + k / 9 - 1};
      const auto found = cells_.find(beside);
      if (found == cells_.end()) continue;
      for (const Eigen::Vector3d& q : found->second) {
        if ((p - q).squaredNorm() <= spacing_ * spacing_) return false;
      }
    }
    cells_[at].push_back(p);
    return true;
  }

 private:
  using cell = std::array<std::int64_t, 3>;
  struct hash {
    std::size_t operator()(const cell& c) const {
      std::uint64_t mixed = 0;
      for (const std::int64_t k : c) mixed = random_bits(mixed, static_cast<std::uint64_t>(k));
      return static_cast<std::size_t>(mixed);
    }
  };

  [[nodiscard]] cell cell_of(const Eigen::Vector3d& p) const {
    const Eigen::Vector3d place = (p / spacing_).array().floor().max(-9e18).min(9e18);
    return {static_cast<std::int64_t>(place.x()), static_cast<std::int64_t>(place.y()),
            static_cast<std::int64_t>(place.z())};
  }

  double spacing_;
  std::unordered_map<cell, std::vector<Eigen::Vector3d>, hash> cells_;
};

/// 0 .. n-1 in random order.
inline std::vector<std::size_t> shuffled(std::size_t n, std::uint64_t seed) {
  random_engine random(seed);
  std::vector<std::size_t> order(n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t j = random.below(i + 1);
    order[i] = order[j];
    order[j] = i;
  }
  return order;
}

}  // namespace detail

/// The points, taken in random order, that have no point taken before within the spacing: no two
/// lie within it, and no point is left without one. In the order of the cloud; points that are not
/// finite are left out.
///
/// Throws argument_error if the spacing is not positive.
/// Source: the density of the DTU benchmark, Aanæs et al., IJCV 2016, section 4.
[[nodiscard]] inline cloud::cloud thin(const cloud::cloud& points, const thin_options& options) {
  if (!(options.spacing > 0)) {
    throw argument_error(message("sample::thin: spacing > 0 expected, found ", options.spacing));
  }
  detail::spaced_points kept(options.spacing);
  std::vector<std::size_t> index;
  for (const std::size_t i : detail::shuffled(points.size(), options.seed)) {
    demand_go(options.control);
    if (!cloud::is_finite(points.points[i])) continue;
    if (kept.keep(points.points[i].cast<double>())) index.push_back(i);
  }
  std::sort(index.begin(), index.end());
  return cloud::select(points, index);
}

}  // namespace aib::sample
