// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/executor.hpp>
#include <aib/core/simd.hpp>
#include <aib/search/box_tree.hpp>
#include <aib/search/buffer.hpp>
#include <aib/search/curve.hpp>
#include <aib/search/nearest_one.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace aib::search {

/// Corners of a triangle.
struct corners {
  float at[3][3];  ///< [corner][axis]

  corners() = default;
  corners(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c)
      : at{{a.x(), a.y(), a.z()}, {b.x(), b.y(), b.z()}, {c.x(), c.y(), c.z()}} {}

  template <class Scalar>
  [[nodiscard]] Eigen::Matrix<Scalar, 3, 1> corner(int k) const {
    return Eigen::Vector3f(at[k]).cast<Scalar>();
  }
};

/// The part of a triangle that a point of it belongs to: its face, edge k (from corner k to the
/// next), or corner k.
enum class triangle_part { face, edge, corner };

/// The point of a triangle that is nearest to a query.
struct surface_point {
  Eigen::Vector3d position;
  triangle_part part = triangle_part::face;
  int k = 0;  ///< which edge or corner
};

/// The point of a triangle's edges that is nearest to p.
[[nodiscard]] inline surface_point nearest_on_edges(const Eigen::Vector3d& p,
                                                    const std::array<Eigen::Vector3d, 3>& t) {
  surface_point best;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    const Eigen::Vector3d along = t[next] - t[k];
    const double length = along.squaredNorm();
    const double share = length > 0 ? std::clamp(along.dot(p - t[k]) / length, 0.0, 1.0) : 0;
    const Eigen::Vector3d q = t[k] + share * along;
    if (!((q - p).squaredNorm() < least)) continue;
    least = (q - p).squaredNorm();
    const bool at_end = share == 1;
    best = {share == 0 ? t[k]
            : at_end   ? t[next]
                       : q,
            share > 0 && share < 1 ? triangle_part::edge : triangle_part::corner,
            static_cast<int>(at_end ? next : k)};
  }
  return best;
}

/// The point of a triangle that is nearest to p. A triangle without area is treated as its edges.
/// Source: Ericson, "Real-Time Collision Detection", 2005, section 5.1.5.
[[nodiscard]] inline surface_point nearest_on_triangle(const Eigen::Vector3d& p,
                                                       const std::array<Eigen::Vector3d, 3>& t) {
  const Eigen::Vector3d ab = t[1] - t[0], ac = t[2] - t[0];
  const Eigen::Vector3d ap = p - t[0], bp = p - t[1], cp = p - t[2];
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return {t[0], triangle_part::corner, 0};
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return {t[1], triangle_part::corner, 1};
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return {t[2], triangle_part::corner, 2};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0 && d1 > d3) {
    return {t[0] + d1 / (d1 - d3) * ab, triangle_part::edge, 0};
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0 && (d4 - d3) + (d5 - d6) > 0) {
    return {t[1] + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (t[2] - t[1]), triangle_part::edge, 1};
  }
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0 && d2 > d6) {
    return {t[0] + d2 / (d2 - d6) * ac, triangle_part::edge, 2};
  }
  const double sum = va + vb + vc;
  // Of a triangle without area, or of a sliver far away, the three are what rounding left.
  const double rounded = std::abs(d1 * d4) + std::abs(d3 * d6) + std::abs(d5 * d2);
  if (!(sum > 1e-12 * rounded)) return nearest_on_edges(p, t);
  return {t[0] + vb / sum * ab + vc / sum * ac, triangle_part::face, 0};
}

inline namespace AIB_ISA {

/// The range of a triangle on one axis.
inline std::pair<float, float> range_of(const corners& t, int axis) {
  return {std::min({t.at[0][axis], t.at[1][axis], t.at[2][axis]}),
          std::max({t.at[0][axis], t.at[1][axis], t.at[2][axis]})};
}

/// The triangle that is nearest to a query, and how near.
struct nearest_triangle {
  std::uint32_t place = 0;  ///< in the order of the tree
  double squared = std::numeric_limits<double>::infinity();
};

/// Triangles in the order of a curve under a tree of boxes, eight to a node. Triangles must be
/// finite and not empty.
class triangle_tree {
 public:
  triangle_tree(std::span<const corners> triangles,
                const curve& order,
                unsigned threads = 0,
                const control& control = {});

  [[nodiscard]] std::size_t size() const { return triangles_.size(); }

  /// Index, as given, of the triangle at a place.
  [[nodiscard]] std::uint32_t index(std::uint32_t place) const { return index_[place]; }

  /// Corners of the triangle at a place.
  [[nodiscard]] std::array<Eigen::Vector3d, 3> triangle(std::uint32_t place) const {
    const corners& t = triangles_[place];
    return {t.corner<double>(0), t.corner<double>(1), t.corner<double>(2)};
  }

  /// The nearest triangle, exact in double. `first_guess` is a place that is probably near; it
  /// changes the time, and among equally near triangles the answer, but not the distance.
  [[nodiscard]] nearest_triangle nearest(const Eigen::Vector3f& p, std::uint32_t first_guess) const;

 private:
  void try_triangle(const Eigen::Vector3d& p, std::uint32_t place, nearest_triangle& best) const;

  buffer<corners> triangles_;
  buffer<std::uint32_t> index_;
  std::vector<buffer<box_node>> levels_;
};

inline triangle_tree::triangle_tree(std::span<const corners> triangles,
                                    const curve& order,
                                    unsigned threads,
                                    const control& control)
    : triangles_(triangles.size()), index_(triangles.size()) {
  if (threads == 0) threads = available_threads();
  std::vector<Eigen::Vector3f> centres;
  centres.reserve(triangles.size());
  for (const corners& t : triangles)
    centres.push_back(t.corner<float>(0) / 3 + t.corner<float>(1) / 3 + t.corner<float>(2) / 3);
  const auto sorted = sort_along(centres, order, threads, control);
  const std::uint64_t mask = (std::uint64_t{1} << order.index_bits) - 1;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    index_[i] = static_cast<std::uint32_t>(sorted[i] & mask);
    triangles_[i] = triangles[index_[i]];
  }
  const std::span<const corners> leaves = triangles_.span();
  levels_.push_back(boxes_above(leaves, threads, control));
  while (levels_.back().size() > 1) {
    const std::span<const box_node> below = levels_.back().span();
    levels_.push_back(boxes_above(below, threads, control));
  }
}

inline void triangle_tree::try_triangle(const Eigen::Vector3d& p,
                                        std::uint32_t place,
                                        nearest_triangle& best) const {
  const Eigen::Vector3d offset = nearest_on_triangle(p, triangle(place)).position - p;
  const double squared = offset.squaredNorm();
  if (squared < best.squared) best = {place, squared};
}

/// Boxes are measured in float, each operation rounded once; a bound that is larger by more than
/// their sum of rounding errors never cuts off a nearer triangle.
inline float bound_above(double squared) {
  return static_cast<float>(std::min(squared * (1 + 1e-5), 3e38)) +
         std::numeric_limits<float>::min();
}

inline nearest_triangle triangle_tree::nearest(const Eigen::Vector3f& p,
                                               std::uint32_t first_guess) const {
  const query q(p.x(), p.y(), p.z());
  const Eigen::Vector3d exact = p.cast<double>();
  nearest_triangle best;
  try_triangle(exact, first_guess, best);
  pending_boxes pending;
  pending.push_root(levels_.size());
  while (!pending.empty()) {
    const pending_box box = pending.pop();
    const float bound = bound_above(best.squared);
    if (!(box.squared < bound)) continue;
    if (box.level == pending_box::leaf) {
      try_triangle(exact, box.index, best);
    } else {
      const f32x8 d = squared_distances(q.axis, q.axis, levels_[box.level][box.index]);
      pending.push_children(box, d, less(d, f32x8::broadcast(bound)));
    }
  }
  return best;
}

}  // namespace AIB_ISA
}  // namespace aib::search
