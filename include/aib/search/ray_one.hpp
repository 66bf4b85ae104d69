// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/isa.hpp>
#include <aib/core/simd.hpp>
#include <aib/search/ray_fan.hpp>
#include <aib/search/ray_trace.hpp>
#include <aib/search/ray_tree.hpp>
#include <aib/search/ray_triangles.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace aib::search {

/// A triangle that a ray hits, and where.
struct ray_hit {
  std::uint32_t place;  ///< in the tree
  double distance;      ///< from the origin
};

inline namespace AIB_ISA {

/// The nearest hit of one ray; nothing where it hits nothing within the distance. As watertight as
/// `trace`.
///
/// direction   not zero, of any length
[[nodiscard]] std::optional<ray_hit> first_hit(const ray_tree& tree,
                                               const Eigen::Vector3d& origin,
                                               const Eigen::Vector3d& direction,
                                               double max_distance = HUGE_VAL);

/// Whether anything lies on the way from `origin` to the point at `distance`.
[[nodiscard]] bool is_blocked(const ray_tree& tree,
                              const Eigen::Vector3d& origin,
                              const Eigen::Vector3d& direction,
                              double distance);

namespace detail {

/// One walk of one ray through a tree.
class ray_walk {
 public:
  ray_walk(const ray_tree& tree, const ray_frame& frame, double max_distance)
      : tree_(tree), exact_(frame), frame_(frame), limit_(max_distance) {
    for (int a = 0; a < 3; ++a) {
      const double slope = frame.axes(2, a);
      // A ray along a wall of a box stays within it by rounding at most: 0 would make 0 * infinity.
      const double inverse = 1 / (std::abs(slope) < 1e-12 ? std::copysign(1e-12, slope) : slope);
      inverse_[a] = f32x8::broadcast(static_cast<float>(inverse));
      up_[a] = inverse > 0;
    }
  }

  std::optional<ray_hit> nearest() {
    walk([&](const triangle_block& block, std::uint32_t b) { return visit(block, b), false; });
    return best_;
  }
  bool any() {
    return walk([&](const triangle_block& block, std::uint32_t b) {
      visit(block, b);
      return best_.has_value();
    });
  }

 private:
  template <class Visit>
  bool walk(Visit&& visit_block) {
    pending_.push_root();
    while (!pending_.empty()) {
      const pending_part next = pending_.pop();
      if (static_cast<double>(next.near) > limit_ * (1 + 1e-5)) continue;
      const std::uint32_t b = next.part & ~ray_node::leaf;
      if (b == next.part) {
        visit(tree_.nodes()[b]);
      } else if (visit_block(tree_.blocks()[b], b)) {
        return true;
      }
    }
    return false;
  }
  void visit(const ray_node& node);
  void visit(const triangle_block& block, std::uint32_t index);
  [[nodiscard]] unsigned around_the_ray(const vector_f32x8 (&corner)[3]) const;

  const ray_tree& tree_;
  const ray_frame& exact_;
  ray_frame_f32x8 frame_;
  f32x8 inverse_[3];
  bool up_[3];
  double limit_;
  pending_parts pending_;
  std::optional<ray_hit> best_;
};

/// Slabs are widened by their rounding error on each side.
inline void ray_walk::visit(const ray_node& node) {
  const f32x8 share = f32x8::broadcast(4e-7f);
  f32x8 enter = f32x8::broadcast(0);
  f32x8 leave = f32x8::broadcast(static_cast<float>(std::min(limit_ * (1 + 1e-5), 3e38)));
  for (int a = 0; a < 3; ++a) {
    const f32x8 low = frame_.from_origin(node.low[a], a);
    const f32x8 high = frame_.from_origin(node.high[a], a);
    const f32x8 slack = share * max(absolute(low), absolute(high));
    const f32x8 first = (up_[a] ? low - slack : high + slack) * inverse_[a];
    const f32x8 last = (up_[a] ? high + slack : low - slack) * inverse_[a];
    enter = max(enter, first);
    leave = min(leave, last);
  }
  const f32x8 wider = leave + leave * share;
  pending_.push_children(node, enter, first_lanes(node.n) & ~less(wider, enter));
}

/// Bits of the triangles that the ray passes through, seen along it. The extent ends those that it
/// sees from the side.
inline unsigned ray_walk::around_the_ray(const vector_f32x8 (&corner)[3]) const {
  const f32x8 zero = f32x8::broadcast(0);
  f32x8 left = f32x8::broadcast(HUGE_VALF), right = left;
  for (int k = 0; k < 3; ++k) {
    const vector_f32x8& from = corner[(k + 1) % 3];
    const vector_f32x8& to = corner[(k + 2) % 3];
    const f32x8 slack = cross_bound(from, to).z * f32x8::broadcast(rounding);
    const f32x8 e = from.x * to.y - from.y * to.x;
    left = min(left, slack + e);
    right = min(right, slack - e);
  }
  const f32x8 far_z = max(max(corner[0].z, corner[1].z), corner[2].z);
  const f32x8 low_x = min(min(corner[0].x, corner[1].x), corner[2].x);
  const f32x8 low_y = min(min(corner[0].y, corner[1].y), corner[2].y);
  const f32x8 high_x = max(max(corner[0].x, corner[1].x), corner[2].x);
  const f32x8 high_y = max(max(corner[0].y, corner[1].y), corner[2].y);
  const f32x8 margin = f32x8::broadcast(slope_margin) * far_z;
  const f32x8 within = min(min(high_x, high_y), zero - max(low_x, low_y)) + margin;
  return ~((less(left, zero) & less(right, zero)) | less(far_z, zero) | less(within, zero));
}

inline void ray_walk::visit(const triangle_block& block, std::uint32_t index) {
  const vector_f32x8 corner[3] = {frame_.corner(block, 0), frame_.corner(block, 1),
                                  frame_.corner(block, 2)};
  unsigned mask = first_lanes(block.n) & around_the_ray(corner);
  for (; mask != 0; mask &= mask - 1) {
    const auto lane = static_cast<std::uint32_t>(std::countr_zero(mask));
    const std::uint32_t place = 8 * index + lane;
    const double distance = forward_distance(exact_, exact_.axes.row(2), tree_.triangle(place));
    if (distance > 0 && distance < limit_) {
      limit_ = distance;
      best_ = ray_hit{place, distance};
    }
  }
}

}  // namespace detail

inline std::optional<ray_hit> first_hit(const ray_tree& tree,
                                        const Eigen::Vector3d& origin,
                                        const Eigen::Vector3d& direction,
                                        double max_distance) {
  const ray_frame frame = ray_frame::towards(origin, direction);
  return detail::ray_walk(tree, frame, max_distance).nearest();
}

inline bool is_blocked(const ray_tree& tree,
                       const Eigen::Vector3d& origin,
                       const Eigen::Vector3d& direction,
                       double distance) {
  const ray_frame frame = ray_frame::towards(origin, direction);
  return detail::ray_walk(tree, frame, distance).any();
}

}  // namespace AIB_ISA
}  // namespace aib::search
