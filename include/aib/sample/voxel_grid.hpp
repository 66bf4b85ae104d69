// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/cloud.hpp>
#include <aib/cloud/positions.hpp>
#include <aib/core/error.hpp>
#include <aib/core/executor.hpp>
#include <aib/sample/voxel.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

namespace aib::sample {

/// Voxels that clouds are added to, one after another: a scene of thousands of depth maps becomes
/// one cloud in memory that grows with its voxels, not with its points.
///
/// A voxel stands for its points by their mean position and mean colour; normals and labels are
/// left out. Lattice at the origin of the world.
class voxel_grid {
 public:
  /// Only size, threads and control of the options are used. Throws argument_error if size is not
  /// positive.
  explicit voxel_grid(const voxel_options& options);

  /// Points that are not finite are left out. The same for any number of threads. Throws
  /// argument_error if the size is far too small for the cloud.
  void add(const cloud::cloud& points);

  [[nodiscard]] std::size_t size() const { return voxels_.size(); }
  [[nodiscard]] std::uint64_t n_points() const { return n_points_; }  ///< added, finite

  /// One point for each voxel, in the order of the lattice; with colours if all clouds had them.
  [[nodiscard]] cloud::cloud result() const;

 private:
  /// Cell of the world: z, y, x.
  using cell = std::array<std::int64_t, 3>;
  struct cell_hash {
    std::size_t operator()(const cell& c) const {
      std::uint64_t h = 0;
      for (const std::int64_t k : c) {
        h = (h ^ static_cast<std::uint64_t>(k)) * 0x9e3779b97f4a7c15u;
        h ^= h >> 32;
      }
      return static_cast<std::size_t>(h);
    }
  };
  /// Sums of the points of a voxel; offsets are from its corner, so that no digits are lost.
  struct sums {
    Eigen::Vector3d offset = Eigen::Vector3d::Zero();
    std::array<std::uint64_t, 3> color = {};
    std::uint64_t n = 0;

    sums& operator+=(const sums& other);
  };

  [[nodiscard]] cell cell_of(const Eigen::Vector3d& p) const;
  [[nodiscard]] Eigen::Vector3d corner_of(const cell& c) const;
  [[nodiscard]] sums sum_of(const cloud::cloud& points, std::span<const std::uint64_t> index) const;

  voxel_options options_;
  std::unordered_map<cell, sums, cell_hash> voxels_;
  std::uint64_t n_points_ = 0;
  bool has_colors_ = true;
};

inline voxel_grid::voxel_grid(const voxel_options& options)
    : options_{.size = options.size, .threads = options.threads, .control = options.control} {
  if (!(options.size > 0 && std::isfinite(options.size)))
    throw argument_error(message("sample::voxel_grid: size > 0 expected, found ", options.size));
  if (options_.threads == 0) options_.threads = available_threads();
}

inline voxel_grid::sums& voxel_grid::sums::operator+=(const sums& other) {
  offset += other.offset;
  for (std::size_t k = 0; k < 3; ++k) color[k] += other.color[k];
  n += other.n;
  return *this;
}

inline voxel_grid::cell voxel_grid::cell_of(const Eigen::Vector3d& p) const {
  const auto at = [&](double x) {
    return static_cast<std::int64_t>(std::floor(x / options_.size));
  };
  return {at(p.z()), at(p.y()), at(p.x())};
}

inline Eigen::Vector3d voxel_grid::corner_of(const cell& c) const {
  return Eigen::Vector3d(static_cast<double>(c[2]), static_cast<double>(c[1]),
                         static_cast<double>(c[0])) *
         options_.size;
}

inline voxel_grid::sums voxel_grid::sum_of(const cloud::cloud& points,
                                           std::span<const std::uint64_t> index) const {
  sums total;
  const Eigen::Vector3d corner = corner_of(cell_of(points.position(index.front())));
  for (const std::uint64_t i : index) {
    total.offset += points.position(i) - corner;
    if (points.colors.empty()) continue;
    for (std::size_t k = 0; k < 3; ++k) total.color[k] += points.colors[i][k];
  }
  total.n = index.size();
  return total;
}

inline void voxel_grid::add(const cloud::cloud& points) {
  if (points.size() == 0) return;
  const detail::voxel_lattice lattice(points, options_.size, options_.anchor);
  const detail::points_by_voxel voxels(points, lattice, options_.threads, options_.control);
  std::vector<sums> parts(voxels.size());
  for_each_chunk(voxels.size(), 4096, options_.threads, options_.control, [&](const chunk& c) {
    for (std::size_t v = c.begin; v < c.end; ++v) parts[v] = sum_of(points, voxels[v]);
  });
  for (std::size_t v = 0; v < voxels.size(); ++v)
    voxels_[cell_of(points.position(voxels[v].front()))] += parts[v];
  n_points_ += voxels.n_points();
  has_colors_ = has_colors_ && !points.colors.empty();
}

inline cloud::cloud voxel_grid::result() const {
  std::vector<std::pair<cell, sums>> sorted(voxels_.begin(), voxels_.end());
  std::sort(sorted.begin(), sorted.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  cloud::placed_points placed = cloud::place(sorted.size(), [&](std::size_t v) -> Eigen::Vector3d {
    const auto& [at, sum] = sorted[v];
    return corner_of(at) + sum.offset / static_cast<double>(sum.n);
  });
  cloud::cloud result;
  result.origin = placed.origin;
  result.points = std::move(placed.points);
  if (!has_colors_) return result;
  for (const auto& voxel : sorted) {
    const sums& sum = voxel.second;
    const auto mean = [&](std::size_t k) {
      return static_cast<std::uint8_t>((2 * sum.color[k] + sum.n) / (2 * sum.n));
    };
    result.colors.push_back({mean(0), mean(1), mean(2)});
  }
  return result;
}

}  // namespace aib::sample
