// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/isa.hpp>
#include <aib/core/simd.hpp>
#include <aib/search/ray_fan.hpp>
#include <aib/search/ray_tree.hpp>
#include <aib/search/ray_triangles.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace aib::search {

/// The nearest triangle that each ray of a fan hits.
struct fan_hits {
  static constexpr std::uint32_t none = ~0u;

  std::uint32_t place[ray_fan::lanes];  ///< in the tree; `none`
};

inline namespace AIB_ISA {

/// The nearest hits of all rays of a fan: they walk the tree together, as one narrow pyramid, and
/// each triangle is tried on eight rays at a time.
///
/// Of two triangles at the same float distance the one that is met first is hit.
/// Source: Reshetov, Soupikov, Hurley, "Multi-level ray tracing algorithm", SIGGRAPH 2005 (pyramids
/// of rays).
[[nodiscard]] fan_hits trace(const ray_tree& tree, const ray_frame& frame, const ray_fan& fan);

/// A node or block that waits to be visited, and how far forward it begins.
struct pending_part {
  float near;
  std::uint32_t part;
};

/// Parts that wait, the nearest child of the last visited node on top.
class pending_parts {
 public:
  [[nodiscard]] bool empty() const { return size_ == 0; }
  pending_part pop() { return parts_[--size_]; }
  void push_root() { parts_[size_++] = {0, 0}; }

  /// The children of a node whose bits are set in `mask`, farthest first.
  void push_children(const ray_node& node, f32x8 near, unsigned mask) {
    float distance[8];
    near.store(distance);
    const std::size_t bottom = size_;
    for (; mask != 0; mask &= mask - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(mask));
      std::size_t place = size_++;
      for (; place > bottom && parts_[place - 1].near < distance[lane]; --place)
        parts_[place] = parts_[place - 1];
      parts_[place] = {distance[lane], node.child[lane]};
    }
  }

 private:
  pending_part parts_[8 * ray_tree::max_levels];
  std::size_t size_ = 0;
};

namespace detail {

/// One walk of a fan through a tree.
class fan_walk {
 public:
  fan_walk(const ray_tree& tree, const ray_frame& frame, const ray_fan& fan);

  fan_hits hits();

 private:
  /// The pyramid's four sides, pointing inwards, and its axis, in the world.
  static constexpr int n_planes = 5;
  static constexpr int forward = 4;

  void visit(const ray_node& node);
  void visit(const triangle_block& block, std::uint32_t index);
  [[nodiscard]] unsigned in_pyramid(const vector_f32x8 (&corner)[3]) const;
  void find_groups(const vector_f32x8 (&corner)[3]);
  void store(const triangle_outlines& outlines);
  template <class Try>
  void for_each_group(std::size_t lane, Try&& attempt);
  template <class Narrow>
  void try_lane(std::size_t lane, std::uint32_t place, Narrow&& narrow);
  void try_edge_on(std::size_t lane, std::uint32_t place);
  void update_limit();

  const ray_tree& tree_;
  const ray_fan& fan_;
  ray_frame_f32x8 frame_;
  f32x8 plane_[n_planes][3];
  bool plane_up_[n_planes][3];
  f32x8 slope_low_[2], slope_high_[2];
  float largest_slope_;

  pending_parts pending_;
  fan_hits hits_;
  alignas(32) float best_[ray_fan::lanes];  ///< inverse forward distance
  float limit_ = HUGE_VALF;                 ///< nothing is sought beyond this forward distance
  bool improved_ = false;                   ///< since the limit was set

  /// Coefficients of the eight triangles of a block, see triangle_outlines.
  alignas(32) float edge_[3][3][8];
  alignas(32) float inverse_[3][8];
  alignas(32) float range_[2][8];
  alignas(32) float extent_low_[2][8], extent_high_[2][8];  ///< of the slopes of each
};

inline fan_walk::fan_walk(const ray_tree& tree, const ray_frame& frame, const ray_fan& fan)
    : tree_(tree), fan_(fan), frame_(frame) {
  const Eigen::Matrix3d& axes = frame.axes;
  Eigen::Matrix<double, n_planes, 3> planes;
  for (int a = 0; a < 2; ++a) {
    planes.row(2 * a) = axes.row(a) - static_cast<double>(fan.low[a]) * axes.row(2);
    planes.row(2 * a + 1) = static_cast<double>(fan.high[a]) * axes.row(2) - axes.row(a);
    slope_low_[a] = f32x8::broadcast(fan.low[a]);
    slope_high_[a] = f32x8::broadcast(fan.high[a]);
  }
  planes.row(forward) = axes.row(2);
  for (int p = 0; p < n_planes; ++p) {
    for (int a = 0; a < 3; ++a) {
      plane_[p][a] = f32x8::broadcast(static_cast<float>(planes(p, a)));
      plane_up_[p][a] = planes(p, a) >= 0;
    }
  }
  largest_slope_ = std::max({-fan.low[0], -fan.low[1], fan.high[0], fan.high[1]});
  for (std::size_t i = 0; i < ray_fan::lanes; ++i) {
    best_[i] = fan.used[i] ? 0 : HUGE_VALF;
    hits_.place[i] = fan_hits::none;
  }
}

inline fan_hits fan_walk::hits() {
  if (!fan_.empty()) pending_.push_root();
  while (!pending_.empty()) {
    const pending_part next = pending_.pop();
    if (next.near > limit_) continue;
    if ((next.part & ray_node::leaf) == 0) {
      visit(tree_.nodes()[next.part]);
    } else {
      const std::uint32_t b = next.part & ~ray_node::leaf;
      visit(tree_.blocks()[b], b);
    }
  }
  return hits_;
}

inline void fan_walk::visit(const ray_node& node) {
  f32x8 low[3], high[3];
  for (int a = 0; a < 3; ++a) {
    low[a] = frame_.from_origin(node.low[a], a);
    high[a] = frame_.from_origin(node.high[a], a);
  }
  const auto farthest_along = [&](int p) {
    const auto at = [&](int a) { return plane_[p][a] * (plane_up_[p][a] ? high[a] : low[a]); };
    return (at(0) + at(1)) + at(2);
  };
  f32x8 inside = farthest_along(forward);
  for (int p = 0; p < forward; ++p) inside = min(inside, farthest_along(p));
  const auto at = [&](int a) {
    return plane_[forward][a] * (plane_up_[forward][a] ? low[a] : high[a]);
  };
  const f32x8 near = (at(0) + at(1)) + at(2);
  const unsigned out = less(inside, f32x8::broadcast(0)) | less(f32x8::broadcast(limit_), near);
  pending_.push_children(node, near, first_lanes(node.n) & ~out);
}

inline unsigned fan_walk::in_pyramid(const vector_f32x8 (&corner)[3]) const {
  const f32x8 far_z = max(max(corner[0].z, corner[1].z), corner[2].z);
  f32x8 inside = far_z;
  const auto best_of = [&](auto&& signed_gap) {
    inside =
        min(inside, max(max(signed_gap(corner[0]), signed_gap(corner[1])), signed_gap(corner[2])));
  };
  best_of([&](const vector_f32x8& c) { return c.x - slope_low_[0] * c.z; });
  best_of([&](const vector_f32x8& c) { return slope_high_[0] * c.z - c.x; });
  best_of([&](const vector_f32x8& c) { return c.y - slope_low_[1] * c.z; });
  best_of([&](const vector_f32x8& c) { return slope_high_[1] * c.z - c.y; });
  const f32x8 near_z = min(min(corner[0].z, corner[1].z), corner[2].z);
  return ~(less(inside, f32x8::broadcast(0)) | less(f32x8::broadcast(limit_), near_z));
}

/// The slopes that each triangle extends over; everything where a corner is behind the camera.
inline void fan_walk::find_groups(const vector_f32x8 (&corner)[3]) {
  const f32x8 zero = f32x8::broadcast(0), one = f32x8::broadcast(1);
  const f32x8 near_z = min(min(corner[0].z, corner[1].z), corner[2].z);
  f32x8 slope[2][3];
  for (int k = 0; k < 3; ++k) {
    const f32x8 scale = one / corner[k].z;
    slope[0][k] = corner[k].x * scale;
    slope[1][k] = corner[k].y * scale;
  }
  const f32x8 margin = f32x8::broadcast(slope_margin), all = f32x8::broadcast(HUGE_VALF);
  for (int a = 0; a < 2; ++a) {
    const f32x8 low = min(min(slope[a][0], slope[a][1]), slope[a][2]) - margin;
    const f32x8 high = max(max(slope[a][0], slope[a][1]), slope[a][2]) + margin;
    choose(zero, near_z, low, zero - all).store(extent_low_[a]);
    choose(zero, near_z, high, all).store(extent_high_[a]);
  }
}

inline void fan_walk::store(const triangle_outlines& outlines) {
  for (int k = 0; k < 3; ++k) {
    outlines.edge[k].x.store(edge_[k][0]);
    outlines.edge[k].y.store(edge_[k][1]);
    outlines.edge[k].z.store(edge_[k][2]);
  }
  outlines.inverse.x.store(inverse_[0]);
  outlines.inverse.y.store(inverse_[1]);
  outlines.inverse.z.store(inverse_[2]);
  outlines.farthest.store(range_[0]);
  outlines.nearest.store(range_[1]);
}

inline void fan_walk::visit(const triangle_block& block, std::uint32_t index) {
  const vector_f32x8 corner[3] = {frame_.corner(block, 0), frame_.corner(block, 1),
                                  frame_.corner(block, 2)};
  unsigned mask = first_lanes(block.n) & in_pyramid(corner);
  if (mask == 0) return;
  triangle_outlines outlines(corner, largest_slope_);
  find_groups(corner);
  store(outlines);
  mask &= ~outlines.nowhere;
  const unsigned edge_on = mask & outlines.edge_on;
  for (mask &= ~edge_on; mask != 0; mask &= mask - 1) {
    const auto lane = static_cast<std::uint32_t>(std::countr_zero(mask));
    try_lane(lane, 8 * index + lane, [](f32x8, f32x8, f32x8 inside) { return inside; });
  }
  for (int side = 0; edge_on != 0 && side < 2; ++side) {
    for (unsigned left = edge_on; left != 0; left &= left - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(left));
      try_edge_on(lane, 8 * index + lane);
    }
    outlines.turn();
    store(outlines);
  }
  update_limit();
}

/// Calls `attempt(slope, slope, first ray)` for the groups that the triangle may reach.
template <class Try>
void fan_walk::for_each_group(std::size_t lane, Try&& attempt) {
  unsigned out = 0;
  for (int a = 0; a < 2; ++a) {
    out |= less(f32x8::load(fan_.group_high[a]), f32x8::broadcast(extent_low_[a][lane]));
    out |= less(f32x8::broadcast(extent_high_[a][lane]), f32x8::load(fan_.group_low[a]));
  }
  for (unsigned groups = ~out & 0xffu; groups != 0; groups &= groups - 1) {
    const std::size_t first = 8 * static_cast<std::size_t>(std::countr_zero(groups));
    attempt(f32x8::load(fan_.slope[0] + first), f32x8::load(fan_.slope[1] + first), first);
  }
}

/// narrow   takes the slopes of eight rays and whether they are inside of the outline (>= 0), and
///          says the same of a narrower one
template <class Narrow>
void fan_walk::try_lane(std::size_t lane, std::uint32_t place, Narrow&& narrow) {
  const auto all = [lane](const float* values) { return f32x8::broadcast(values[lane]); };
  const vector_f32x8 edge[3] = {{all(edge_[0][0]), all(edge_[0][1]), all(edge_[0][2])},
                                {all(edge_[1][0]), all(edge_[1][1]), all(edge_[1][2])},
                                {all(edge_[2][0]), all(edge_[2][1]), all(edge_[2][2])}};
  const vector_f32x8 inverse{all(inverse_[0]), all(inverse_[1]), all(inverse_[2])};
  const f32x8 farthest = all(range_[0]), nearest = all(range_[1]);
  for_each_group(lane, [&](f32x8 s, f32x8 t, std::size_t first) {
    const auto at = [&](const vector_f32x8& f) { return (f.x * s + f.y * t) + f.z; };
    const f32x8 inside = narrow(s, t, min(min(at(edge[0]), at(edge[1])), at(edge[2])));
    // NaN, where a triangle is seen from the side, becomes the nearest.
    const f32x8 found = max(min(at(inverse), nearest), farthest);
    const f32x8 best = f32x8::load(best_ + first);
    const f32x8 hit = choose(inside, f32x8::broadcast(0), f32x8::broadcast(-1), found);
    unsigned better = less(best, hit);
    if (better == 0) return;
    max(hit, best).store(best_ + first);
    for (; better != 0; better &= better - 1)
      hits_.place[first + static_cast<std::size_t>(std::countr_zero(better))] = place;
    improved_ = true;
  });
}

/// A triangle that is a line to the rays has no outline that would end it: its extent does.
inline void fan_walk::try_edge_on(std::size_t lane, std::uint32_t place) {
  try_lane(lane, place, [&](f32x8 s, f32x8 t, f32x8 inside) {
    const auto all = [lane](const float* values) { return f32x8::broadcast(values[lane]); };
    const f32x8 right = min(s - all(extent_low_[0]), all(extent_high_[0]) - s);
    const f32x8 down = min(t - all(extent_low_[1]), all(extent_high_[1]) - t);
    return min(inside, min(right, down));
  });
}

inline void fan_walk::update_limit() {
  if (!improved_) return;
  improved_ = false;
  f32x8 least = f32x8::load(best_);
  for (std::size_t i = 8; i < ray_fan::lanes; i += 8) least = min(least, f32x8::load(best_ + i));
  // Boxes are placed in floats: a little farther than the hits is still looked at.
  limit_ = 1.00001f / lowest(least);
}

}  // namespace detail

inline fan_hits trace(const ray_tree& tree, const ray_frame& frame, const ray_fan& fan) {
  return detail::fan_walk(tree, frame, fan).hits();
}

}  // namespace AIB_ISA
}  // namespace aib::search
