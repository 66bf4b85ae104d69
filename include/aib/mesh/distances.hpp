// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/cloud.hpp>
#include <aib/cloud/compare.hpp>
#include <aib/cloud/distances.hpp>
#include <aib/cloud/positions.hpp>
#include <aib/core/error.hpp>
#include <aib/core/executor.hpp>
#include <aib/core/isa.hpp>
#include <aib/mesh/finite_triangles.hpp>
#include <aib/mesh/mesh.hpp>
#include <aib/search/curve.hpp>
#include <aib/search/triangle_tree.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace aib::mesh {
inline namespace AIB_ISA {

/// The finite triangles of a mesh under a search tree, for many questions.
class surface_index {
 public:
  /// Throws undefined_error if no triangle is finite.
  explicit surface_index(const mesh& surface, unsigned threads = 0, const control& control = {});

  [[nodiscard]] const Eigen::Vector3d& origin() const { return origin_; }
  [[nodiscard]] const search::triangle_tree& tree() const { return tree_; }

  /// Index in the mesh of the triangle at a place of the tree.
  [[nodiscard]] std::size_t triangle_at(std::uint32_t place) const {
    return triangles_.index[tree_.index(place)];
  }

 private:
  static std::vector<Eigen::Vector3f> first_corners(std::span<const search::corners> triangles);

  Eigen::Vector3d origin_;
  finite_triangles triangles_;
  search::triangle_tree tree_;
};

/// Where on a mesh each point of a cloud is nearest.
struct closest_points {
  std::vector<float> distance;          ///< NaN for a point that is not finite
  std::vector<std::uint32_t> triangle;  ///< index in the mesh; ~0 for a point that is not finite
};

/// The nearest triangle of each point, exact.
/// Throws undefined_error if the cloud has no finite point.
closest_points closest(const cloud::cloud& points,
                       const surface_index& surface,
                       unsigned threads = 0,
                       const control& control = {});

/// Distances from the points of a cloud to the surface of a mesh: exact point-to-triangle
/// distances, without the floor that sampling the mesh would put under them.
///
/// Throws undefined_error if the cloud has no finite point or the mesh no finite triangle.
[[nodiscard]] cloud::distances distances(const cloud::cloud& points,
                                         const mesh& surface,
                                         const cloud::distance_options& options = {});

/// Compares an estimated cloud with a reference mesh: accuracy to the surface itself, completeness
/// and recall by samples of it (sample::mesh).
[[nodiscard]] cloud::comparison compare(const cloud::cloud& estimate,
                                        const mesh& reference,
                                        const cloud::cloud& samples,
                                        const cloud::compare_options& options = {});

inline std::vector<Eigen::Vector3f> surface_index::first_corners(
    std::span<const search::corners> triangles) {
  std::vector<Eigen::Vector3f> first;
  first.reserve(triangles.size());
  for (const search::corners& t : triangles) first.push_back(t.corner<float>(0));
  return first;
}

inline surface_index::surface_index(const mesh& surface, unsigned threads, const control& control)
    : origin_(surface.origin),
      triangles_(surface, "mesh::distances"),
      tree_(triangles_.corners,
            search::common_curve(first_corners(triangles_.corners), {}),
            threads,
            control) {}

inline closest_points closest(const cloud::cloud& points,
                              const surface_index& surface,
                              unsigned threads,
                              const control& control) {
  const cloud::finite_points from(points, surface.origin());
  cloud::detail::demand_points("mesh::distances", "estimated", from);
  if (threads == 0) threads = available_threads();
  const search::curve order = search::common_curve(from.points(), {});
  const auto sorted = search::sort_along(from.points(), order, threads, control);
  const std::uint64_t mask = (std::uint64_t{1} << order.index_bits) - 1;
  closest_points found{std::vector<float>(points.size(), std::numeric_limits<float>::quiet_NaN()),
                       std::vector<std::uint32_t>(points.size(), ~std::uint32_t{0})};
  for_each_chunk(sorted.size(), 4096, threads, control, [&](const chunk& c) {
    std::uint32_t near = 0;
    for (std::size_t i = c.begin; i < c.end; ++i) {
      const std::size_t p = sorted[i] & mask;
      const auto best = surface.tree().nearest(from.points()[p], near);
      near = best.place;
      found.distance[from.source_index(p)] = static_cast<float>(std::sqrt(best.squared));
      found.triangle[from.source_index(p)] =
          static_cast<std::uint32_t>(surface.triangle_at(best.place));
    }
  });
  return found;
}

inline cloud::distances distances(const cloud::cloud& points,
                                  const mesh& surface,
                                  const cloud::distance_options& options) {
  const surface_index index(surface, options.threads, options.control);
  auto found = closest(points, index, options.threads, options.control);
  return cloud::distances(std::move(found.distance), options);
}

inline cloud::comparison compare(const cloud::cloud& estimate,
                                 const mesh& reference,
                                 const cloud::cloud& samples,
                                 const cloud::compare_options& options) {
  const cloud::distance_options how{.max_distance = options.max_distance,
                                    .rule = options.rule,
                                    .threads = options.threads,
                                    .control = options.control};
  return cloud::score(distances(estimate, reference, how), cloud::distances(samples, estimate, how),
                      options.tau);
}

}  // namespace AIB_ISA
}  // namespace aib::mesh
