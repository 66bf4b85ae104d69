// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/search/box_tree.hpp>

#include <bit>
#include <cstddef>
#include <cstdint>

namespace aib::search {
inline namespace AIB_ISA {

/// Squared length in the one order of operations that all searches use: rounding is monotone, so a
/// box never seems farther than a point in it, and pruning loses no nearest neighbour.
template <class Lanes>
Lanes squared_length(Lanes x, Lanes y, Lanes z) {
  return (x * x + y * y) + z * z;
}

/// Eight-fold a point.
struct query {
  f32x8 axis[3];

  query(float x, float y, float z)
      : axis{f32x8::broadcast(x), f32x8::broadcast(y), f32x8::broadcast(z)} {}
};

/// Squared distances from points in [low, high] (equal for a single point) to the eight boxes.
inline f32x8 squared_distances(const f32x8* low, const f32x8* high, const box_node& node) {
  f32x8 gap[3];
  for (int k = 0; k < 3; ++k) {
    const f32x8 before = f32x8::load(node.low[k]) - high[k];
    const f32x8 behind = low[k] - f32x8::load(node.high[k]);
    gap[k] = max(max(before, behind), f32x8::broadcast(0));
  }
  return squared_length(gap[0], gap[1], gap[2]);
}

/// Squared distances from a point to eight points of a block, from `first` on.
inline f32x8 squared_distances(const query& q, const point_block& block, std::size_t first) {
  return squared_length(q.axis[0] - f32x8::load(block.axis[0] + first),
                        q.axis[1] - f32x8::load(block.axis[1] + first),
                        q.axis[2] - f32x8::load(block.axis[2] + first));
}

/// A node or block that waits to be visited, and how far it is.
struct pending_box {
  float squared;
  std::uint32_t level;  ///< of the box's children; `leaf` for a block or triangle
  std::uint32_t index;

  static constexpr std::uint32_t leaf = ~0u;
};

/// Boxes that wait, the nearest child of the last visited node on top. Eight children a level and
/// eleven levels (2^32 points) never fill it.
class pending_boxes {
 public:
  [[nodiscard]] bool empty() const { return size_ == 0; }
  pending_box pop() { return boxes_[--size_]; }
  void push_root(std::size_t levels) {
    boxes_[size_++] = {0, static_cast<std::uint32_t>(levels - 1), 0};
  }

  /// The children of a node whose bits are set in `mask`, farthest first.
  void push_children(const pending_box& node, f32x8 squared, unsigned mask) {
    float distance[8];
    squared.store(distance);
    const std::size_t bottom = size_;
    const std::uint32_t level = node.level == 0 ? pending_box::leaf : node.level - 1;
    for (; mask != 0; mask &= mask - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(mask));
      std::size_t place = size_++;
      for (; place > bottom && boxes_[place - 1].squared < distance[lane]; --place) {
        boxes_[place] = boxes_[place - 1];
      }
      boxes_[place] = {distance[lane], level, node.index * 8 + lane};
    }
  }

 private:
  pending_box boxes_[96];
  std::size_t size_ = 0;
};

/// The smaller of `bound` and the squared distance from a point to its nearest neighbour.
///
/// near_block   a block to begin with; becomes the block of the neighbour where one was found
inline float nearest_one(const box_tree& tree,
                         const query& q,
                         float bound,
                         std::uint32_t& near_block) {
  const auto visit = [&](std::uint32_t b) {
    const point_block& block = tree.blocks()[b];
    const f32x8 least = min(squared_distances(q, block, 0), squared_distances(q, block, 8));
    if (less(least, f32x8::broadcast(bound)) == 0) return;
    bound = lowest(least);
    near_block = b;
  };
  visit(near_block);
  pending_boxes pending;
  pending.push_root(tree.levels());
  while (!pending.empty()) {
    const pending_box box = pending.pop();
    if (!(box.squared < bound)) continue;
    if (box.level == pending_box::leaf) {
      visit(box.index);
    } else {
      const f32x8 d = squared_distances(q.axis, q.axis, tree.level(box.level)[box.index]);
      pending.push_children(box, d, less(d, f32x8::broadcast(bound)));
    }
  }
  return bound;
}

}  // namespace AIB_ISA
}  // namespace aib::search
