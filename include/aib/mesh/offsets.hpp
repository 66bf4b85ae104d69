// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/cloud.hpp>
#include <aib/cloud/offsets.hpp>
#include <aib/cloud/positions.hpp>
#include <aib/core/error.hpp>
#include <aib/core/executor.hpp>
#include <aib/core/isa.hpp>
#include <aib/mesh/distances.hpp>
#include <aib/mesh/edges.hpp>
#include <aib/mesh/mesh.hpp>
#include <aib/mesh/surface.hpp>
#include <aib/search/triangle_tree.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace aib::mesh {

/// The outward direction at each part of a closed surface: a face's normal, at an edge the sum of
/// those of its faces, at a corner the sum weighted by angle. Its side of a nearest point is the
/// side of the surface.
/// Source: Bærentzen and Aanæs, IEEE TVCG 2005, theorem 1.
class pseudonormals {
 public:
  explicit pseudonormals(const mesh& m) : triangles_(welded(m)), corner_(m.vertices.size()) {
    std::fill(corner_.begin(), corner_.end(), Eigen::Vector3d(0, 0, 0));
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      const auto at = corners(m, t);
      const Eigen::Vector3d ab = at[1] - at[0], ac = at[2] - at[0];
      const Eigen::Vector3d normal = ab.cross(ac).normalized();
      face_.push_back(normal.allFinite() ? normal : Eigen::Vector3d(0, 0, 0));
      for (std::size_t k = 0; k < 3; ++k) {
        const Eigen::Vector3d next = at[(k + 1) % 3] - at[k], last = at[(k + 2) % 3] - at[k];
        const double angle = std::atan2(next.cross(last).norm(), next.dot(last));
        if (std::isfinite(angle)) corner_[triangles_[t][k]] += angle * face_[t];
        edge_.try_emplace(edge_of(t, k), 0, 0, 0).first->second += face_[t];
      }
    }
  }

  [[nodiscard]] const Eigen::Vector3d& at(std::size_t t, const search::surface_point& p) const {
    const auto k = static_cast<std::size_t>(p.k);
    if (p.part == search::triangle_part::face) return face_[t];
    if (p.part == search::triangle_part::edge) return edge_.at(edge_of(t, k));
    return corner_[triangles_[t][k]];
  }

 private:
  using edge = std::pair<std::uint32_t, std::uint32_t>;

  [[nodiscard]] edge edge_of(std::size_t t, std::size_t k) const {
    return std::minmax(triangles_[t][k], triangles_[t][(k + 1) % 3]);
  }

  std::vector<triangle> triangles_;
  std::vector<Eigen::Vector3d> face_, corner_;
  std::map<edge, Eigen::Vector3d> edge_;
};

inline namespace AIB_ISA {

/// Signed distance from each point to a closed surface: positive outside, negative inside, exact.
///
/// Faces count as seen from outside counter-clockwise. A mesh that is not watertight has no inside:
/// throws argument_error with the number of its open edges. Throws undefined_error if the cloud has
/// no finite point or the mesh no finite triangle.
[[nodiscard]] inline cloud::offsets offsets(const cloud::cloud& points,
                                            const mesh& surface,
                                            unsigned threads = 0,
                                            const control& control = {}) {
  if (const std::size_t open = n_open_edges(surface); open > 0 || surface.empty()) {
    throw argument_error(
        message("mesh::offsets: a watertight mesh expected, found ", open, " open edges"));
  }
  const surface_index index(surface, threads, control);
  const pseudonormals outward(surface);
  auto found = closest(points, index, threads, control);
  for_each_chunk(points.size(), 4096, threads, control, [&](const chunk& c) {
    for (std::size_t i = c.begin; i < c.end; ++i) {
      const std::uint32_t t = found.triangle[i];
      if (t == ~std::uint32_t{0}) continue;
      const Eigen::Vector3d p = points.position(i) - surface.origin;
      const auto nearest = search::nearest_on_triangle(p, corners(surface, t));
      if ((p - nearest.position).dot(outward.at(t, nearest)) < 0) {
        found.distance[i] = -found.distance[i];
      }
    }
  });
  return cloud::offsets(std::move(found.distance));
}

}  // namespace AIB_ISA
}  // namespace aib::mesh
