// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/cloud.hpp>
#include <aib/cloud/positions.hpp>
#include <aib/cloud/select.hpp>
#include <aib/core/executor.hpp>
#include <aib/sample/voxel_lattice.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace aib::sample {

/// The one point that stands for a voxel.
enum class voxel_pick {
  mean,     ///< mean of its points
  centre,   ///< centre of the voxel
  nearest,  ///< that of its points which is nearest to their mean
};

struct voxel_options {
  double size = 0;  ///< edge of a voxel, in the unit of the cloud
  voxel_anchor anchor = voxel_anchor::world;
  voxel_pick pick = voxel_pick::mean;
  unsigned threads = 0;  ///< 0: all
  aib::control control = {};
};

/// One point for each voxel that has any, in the order of the lattice. Normal, colour and label are
/// those of the voxel's point nearest to the chosen one. Points that are not finite are left out.
///
/// The cell of a point is calculated in double. The same for any number of threads.
/// Throws argument_error if size is not positive or far too small for the cloud.
[[nodiscard]] cloud::cloud voxel(const cloud::cloud& points, const voxel_options& options);

namespace detail {

/// Index of the point nearest to a position, the first among equals.
inline std::size_t nearest_of(const cloud::cloud& points,
                              std::span<const std::uint64_t> index,
                              const Eigen::Vector3d& to) {
  return *std::min_element(index.begin(), index.end(), [&](std::uint64_t a, std::uint64_t b) {
    return (points.position(a) - to).squaredNorm() < (points.position(b) - to).squaredNorm();
  });
}

/// Mean position of some points.
inline Eigen::Vector3d mean_of(const cloud::cloud& points, std::span<const std::uint64_t> index) {
  Eigen::Vector3d sum(0, 0, 0);
  for (const std::uint64_t i : index) sum += points.points[i].cast<double>();
  return points.origin + sum / static_cast<double>(index.size());
}

}  // namespace detail

inline cloud::cloud voxel(const cloud::cloud& points, const voxel_options& options) {
  const unsigned threads = options.threads == 0 ? available_threads() : options.threads;
  const detail::voxel_lattice lattice(points, options.size, options.anchor);
  const detail::points_by_voxel voxels(points, lattice, threads, options.control);
  const bool centre = options.pick == voxel_pick::centre;
  const bool nearest = options.pick == voxel_pick::nearest;
  const bool bare = points.normals.empty() && points.colors.empty() && points.labels.empty();
  std::vector<std::size_t> source(nearest || !bare ? voxels.size() : 0);
  std::vector<Eigen::Vector3d> position(voxels.size());
  for_each_chunk(voxels.size(), 4096, threads, options.control, [&](const chunk& c) {
    for (std::size_t v = c.begin; v < c.end; ++v) {
      const auto members = voxels[v];
      position[v] = centre ? lattice.centre(members.front()) : detail::mean_of(points, members);
      if (!source.empty()) source[v] = detail::nearest_of(points, members, position[v]);
    }
  });
  cloud::cloud picked = cloud::select(points, source);
  if (nearest) return picked;
  cloud::placed_points placed = cloud::place(
      voxels.size(), [&](std::size_t v) -> const Eigen::Vector3d& { return position[v]; });
  picked.origin = placed.origin;
  picked.points = std::move(placed.points);
  return picked;
}

}  // namespace aib::sample
