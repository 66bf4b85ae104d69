// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/box.hpp>
#include <aib/cloud/cloud.hpp>
#include <aib/core/error.hpp>
#include <aib/mesh/mesh.hpp>
#include <aib/report/packed.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace aib::report {

/// Some points of a cloud, one a voxel, that stand for all of it in a picture.
struct thinned {
  std::vector<std::size_t> index;  ///< of the points that are kept, ascending
  double voxel = 0;                ///< edge of the voxels; 0: every finite point is kept
};

/// At most `limit` points: the first in each voxel, of the smallest voxels that are few enough (to
/// a quarter of their edge).
[[nodiscard]] thinned thin(const cloud::cloud& points, std::size_t limit);

/// Positions in 65535 steps of the box on each axis: x, y, z a point, deflated, in base64.
struct packed_positions {
  cloud::box box;
  std::string data;
};

[[nodiscard]] packed_positions packed(const cloud::cloud& points,
                                      std::span<const std::size_t> index);
[[nodiscard]] packed_positions packed(const mesh::mesh& m);

/// Indices of a mesh's vertices, three a triangle, 32 bits little-endian, deflated, in base64.
[[nodiscard]] inline std::string packed_triangles(const mesh::mesh& m) {
  std::string bytes;
  for (const auto& triangle : m.triangles)
    for (const std::uint32_t vertex : triangle) append_little_endian(bytes, vertex);
  return base64(deflated(bytes));
}

namespace detail {

inline std::vector<std::size_t> finite_points(const cloud::cloud& points) {
  std::vector<std::size_t> index;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (points.points[i].allFinite()) index.push_back(i);
  return index;
}

/// The first point in each voxel; nothing where there are more than `limit` of them.
inline std::optional<std::vector<std::size_t>> first_of_voxels(const cloud::cloud& points,
                                                               std::span<const std::size_t> finite,
                                                               const cloud::box& box,
                                                               double voxel,
                                                               std::size_t limit) {
  std::vector<std::pair<std::uint64_t, std::size_t>> cells;
  cells.reserve(finite.size());
  for (const std::size_t i : finite) {
    const Eigen::Vector3d c = (points.position(i) - box.low) / voxel;
    const auto bits = [](double x) { return static_cast<std::uint64_t>(x) & 0x1fffff; };
    cells.emplace_back(bits(c.x()) | bits(c.y()) << 21 | bits(c.z()) << 42, i);
  }
  std::sort(cells.begin(), cells.end());
  const auto same_cell = [](const auto& a, const auto& b) { return a.first == b.first; };
  cells.erase(std::unique(cells.begin(), cells.end(), same_cell), cells.end());
  if (cells.size() > limit) return std::nullopt;
  std::vector<std::size_t> index;
  index.reserve(cells.size());
  for (const auto& cell : cells) index.push_back(cell.second);
  std::sort(index.begin(), index.end());
  return index;
}

inline void append_position(std::string& bytes, const Eigen::Vector3d& p, const cloud::box& box) {
  for (int axis = 0; axis < 3; ++axis)
    append_little_endian(bytes, step_of<std::uint16_t>(p[axis], {box.low[axis], box.high[axis]}));
}

}  // namespace detail

inline thinned thin(const cloud::cloud& points, std::size_t limit) {
  if (limit == 0) throw argument_error("report::thin: limit > 0 expected");
  std::vector<std::size_t> finite = detail::finite_points(points);
  if (finite.size() <= limit) return {std::move(finite), 0};
  const cloud::box box = cloud::bounds(points);
  // 21 bits an axis hold 2 million voxels.
  double voxel = box.size().maxCoeff() / std::min(2e6, std::sqrt(static_cast<double>(limit)));
  auto kept = detail::first_of_voxels(points, finite, box, voxel, limit);
  for (; !kept; kept = detail::first_of_voxels(points, finite, box, voxel, limit)) voxel *= 1.25;
  return {std::move(*kept), voxel};
}

inline packed_positions packed(const cloud::cloud& points, std::span<const std::size_t> index) {
  packed_positions p;
  for (const std::size_t i : index) p.box.add(points.position(i));
  std::string bytes;
  for (const std::size_t i : index) detail::append_position(bytes, points.position(i), p.box);
  p.data = base64(deflated(bytes));
  return p;
}

inline packed_positions packed(const mesh::mesh& m) {
  packed_positions p{cloud::bounds(m.vertices, m.origin), {}};
  std::string bytes;
  for (std::size_t i = 0; i < m.vertices.size(); ++i)
    detail::append_position(bytes, m.position(i), p.box);
  p.data = base64(deflated(bytes));
  return p;
}

}  // namespace aib::report
