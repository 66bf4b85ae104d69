// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/cloud.hpp>
#include <aib/core/error.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace aib::cloud {

/// What is known of a point at thresholds that grow: it is good from one of them on; below that it
/// is bad where it was observed, and left out where it was not.
struct verdict {
  std::uint32_t first_good;  ///< index of the threshold; as many as there are: at none
  bool observed;
};

/// How the voxel of a point is calculated.
enum class cell_rule {
  exact,   ///< in double
  single,  ///< in float, as ETH3D's tool: points on a border fall elsewhere
};

namespace detail {

/// Cell of a position on a lattice that begins `shift` cells from the world's origin.
inline Eigen::Vector3d cell_of(const Eigen::Vector3d& p,
                               double size,
                               double shift,
                               cell_rule rule) {
  if (rule == cell_rule::exact)
    return (p / size + Eigen::Vector3d::Constant(shift)).array().floor();
  const auto per_unit = static_cast<float>(1.0 / static_cast<float>(size));
  const Eigen::Vector3f single = p.cast<float>();
  return (single.array() * per_unit + static_cast<float>(shift)).floor().cast<double>();
}

/// Points in the order of their cells, which are numbered.
inline std::vector<std::pair<std::uint64_t, std::size_t>> points_by_cell(const cloud& points,
                                                                         double size,
                                                                         double shift,
                                                                         cell_rule rule) {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d high = -low;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d cell = cell_of(points.position(i), size, shift, rule);
    low = low.cwiseMin(cell);
    high = high.cwiseMax(cell);
  }
  constexpr int bits = 21;
  if (!((high - low).maxCoeff() < (1 << bits))) {
    throw argument_error(message("cloud::voxel_shares: size ", size,
                                 " is too small: more than 2 097 152 voxels on an axis"));
  }
  std::vector<std::pair<std::uint64_t, std::size_t>> sorted;
  sorted.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d cell = cell_of(points.position(i), size, shift, rule) - low;
    std::uint64_t key = 0;
    for (int k = 0; k < 3; ++k) key = key << bits | static_cast<std::uint64_t>(cell[k]);
    sorted.emplace_back(key, i);
  }
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

/// Sum over voxels of the share of good points, and the number of voxels with any known point.
struct share_sum {
  double shares = 0;
  std::size_t voxels = 0;
};

inline void add_voxel(std::span<const std::pair<std::uint64_t, std::size_t>> members,
                      std::span<const verdict> verdicts,
                      std::vector<share_sum>& sums) {
  for (std::size_t t = 0; t < sums.size(); ++t) {
    std::size_t good = 0, known = 0;
    for (const auto& [cell, i] : members) {
      const bool is_good = verdicts[i].first_good <= t;
      good += is_good;
      known += is_good || verdicts[i].observed;
    }
    if (known == 0) continue;
    sums[t].shares += static_cast<double>(good) / static_cast<double>(known);
    ++sums[t].voxels;
  }
}

}  // namespace detail

/// Share of good points at each threshold, averaged over voxels and not over points, so that
/// density does not weigh: the mean over the voxels of two lattices, half a voxel apart, that have
/// a point of which something is known. Nothing where there is none.
///
/// points     all finite
/// verdicts   one a point
/// size       edge of a voxel, unit of the cloud
///
/// Throws argument_error for a size that is not positive or far too small for the cloud.
/// Source: Schöps et al., "A multi-view stereo benchmark with high-resolution images and
/// multi-camera videos" (ETH3D), CVPR 2017, section 5.
[[nodiscard]] inline std::vector<std::optional<double>> voxel_shares(
    const cloud& points,
    std::span<const verdict> verdicts,
    std::size_t n_thresholds,
    double size,
    cell_rule rule = cell_rule::exact) {
  if (!(size > 0)) {
    throw argument_error(message("cloud::voxel_shares: size > 0 expected, found ", size));
  }
  std::vector<detail::share_sum> sums(n_thresholds);
  for (const double shift : {0.0, 0.5}) {
    const auto sorted = detail::points_by_cell(points, size, shift, rule);
    for (std::size_t first = 0, last = 0; first < sorted.size(); first = last) {
      while (last < sorted.size() && sorted[last].first == sorted[first].first) ++last;
      detail::add_voxel(std::span(sorted).subspan(first, last - first), verdicts, sums);
    }
  }
  std::vector<std::optional<double>> shares;
  for (const detail::share_sum& s : sums) {
    shares.push_back(s.voxels == 0 ? std::nullopt
                                   : std::optional(s.shares / static_cast<double>(s.voxels)));
  }
  return shares;
}

}  // namespace aib::cloud
