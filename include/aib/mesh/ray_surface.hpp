// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/executor.hpp>
#include <aib/core/isa.hpp>
#include <aib/mesh/finite_triangles.hpp>
#include <aib/mesh/mesh.hpp>
#include <aib/search/ray_one.hpp>
#include <aib/search/ray_tree.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace aib::mesh {
inline namespace AIB_ISA {

/// The finite triangles of a mesh under a tree for rays, with their labels: what is looked at.
/// Both sides of a triangle are seen. A place is that of a triangle in the tree.
class ray_surface {
 public:
  /// Throws undefined_error if no triangle is finite.
  explicit ray_surface(const mesh& surface, unsigned threads = 0, const control& control = {})
      : ray_surface(surface, finite_triangles(surface, "mesh::ray_surface"), threads, control) {}

  [[nodiscard]] const Eigen::Vector3d& origin() const { return origin_; }
  [[nodiscard]] const search::ray_tree& tree() const { return tree_; }
  [[nodiscard]] std::size_t n_triangles() const { return index_.size(); }
  [[nodiscard]] const std::vector<std::string>& label_names() const { return label_names_; }
  [[nodiscard]] bool has_labels() const { return !labels_.empty(); }

  /// Index of the triangle in the mesh.
  [[nodiscard]] std::uint32_t triangle_at(std::uint32_t place) const {
    return index_[tree_.index(place)];
  }
  /// Label of the triangle; 0 where the mesh has none.
  [[nodiscard]] std::uint32_t label_at(std::uint32_t place) const {
    return labels_.empty() ? 0 : labels_[triangle_at(place)];
  }
  /// Unit normal of the triangle by the order of its corners; 0 where it has no area.
  [[nodiscard]] Eigen::Vector3d normal_at(std::uint32_t place) const {
    const auto t = tree_.triangle(place);
    const Eigen::Vector3d ab = t[1] - t[0], ac = t[2] - t[0];
    const Eigen::Vector3d normal = ab.cross(ac);
    const double length = normal.norm();
    return length > 0 ? Eigen::Vector3d(normal / length) : Eigen::Vector3d::Zero();
  }

  /// Where a ray first hits the surface; distances are those along the direction, of any length >
  /// 0.
  [[nodiscard]] std::optional<search::ray_hit> first_hit(const Eigen::Vector3d& from,
                                                         const Eigen::Vector3d& direction,
                                                         double max_distance = HUGE_VAL) const {
    const Eigen::Vector3d in_tree = from - origin_;
    return search::first_hit(tree_, in_tree, direction, max_distance);
  }

  /// Whether nothing lies between two points but within the tolerance of the second.
  [[nodiscard]] bool sees(const Eigen::Vector3d& from,
                          const Eigen::Vector3d& to,
                          double tolerance) const {
    const Eigen::Vector3d way = to - from, in_tree = from - origin_;
    const double distance = way.norm() - tolerance;
    return !(distance > 0) || !search::is_blocked(tree_, in_tree, way, distance);
  }

 private:
  ray_surface(const mesh& surface,
              finite_triangles triangles,
              unsigned threads,
              const control& control)
      : origin_(surface.origin),
        label_names_(surface.label_names),
        index_(std::move(triangles.index)),
        tree_(triangles.corners, threads, control) {
    if (surface.labels.size() == surface.triangles.size()) labels_ = surface.labels;
  }

  Eigen::Vector3d origin_;
  std::vector<std::string> label_names_;
  std::vector<std::uint32_t> index_;   ///< in the mesh
  std::vector<std::uint32_t> labels_;  ///< of the mesh
  search::ray_tree tree_;
};

}  // namespace AIB_ISA
}  // namespace aib::mesh
