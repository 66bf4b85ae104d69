// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/executor.hpp>
#include <aib/core/prefetch.hpp>
#include <aib/core/simd.hpp>
#include <aib/search/buffer.hpp>
#include <aib/search/curve.hpp>
#include <aib/search/radix_sort.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace aib::search {
inline namespace AIB_ISA {

/// Sixteen points that follow each other on the curve, coordinates side by side.
struct alignas(64) point_block {
  static constexpr std::size_t size = 16;
  float axis[3][size];
};

/// Boxes of eight children, coordinates side by side. A child that does not exist has an empty box,
/// infinitely far from everything.
struct alignas(32) box_node {
  static constexpr std::size_t width = 8;
  float low[3][width];
  float high[3][width];
};

/// Points in the order of a curve, in blocks of 16, under a tree of boxes without pointers: node i
/// of a level has the nodes (or, on level 0, the blocks) 8 i .. 8 i + 7 of the level below.
///
/// 18.2 bytes a point. Points must be finite and not empty.
class box_tree {
 public:
  box_tree(std::span<const Eigen::Vector3f> points,
           const curve& order,
           unsigned threads = 0,
           const control& control = {});

  [[nodiscard]] std::size_t size() const { return index_.size(); }

  /// The last block is filled up with its last point.
  [[nodiscard]] std::span<const point_block> blocks() const { return blocks_.span(); }

  /// Index of the point at a place on the curve.
  [[nodiscard]] std::span<const std::uint32_t> index() const { return index_.span(); }

  /// Curve key of the first point of each block.
  [[nodiscard]] std::span<const std::uint64_t> keys() const { return keys_.span(); }

  [[nodiscard]] std::size_t levels() const { return levels_.size(); }
  [[nodiscard]] std::span<const box_node> level(std::size_t l) const { return levels_[l].span(); }

  [[nodiscard]] std::size_t bytes() const;

 private:
  void fill_blocks(std::span<const Eigen::Vector3f> points,
                   const buffer<std::uint64_t>& sorted,
                   const curve& order,
                   unsigned threads,
                   const control& control);
  void build_levels(unsigned threads, const control& control);

  buffer<point_block> blocks_;
  buffer<std::uint32_t> index_;
  buffer<std::uint64_t> keys_;
  std::vector<buffer<box_node>> levels_;
};

/// Key and index of each point in one word, sorted by key, then index.
inline buffer<std::uint64_t> sort_along(std::span<const Eigen::Vector3f> points,
                                        const curve& order,
                                        unsigned threads,
                                        const control& control) {
  buffer<std::uint64_t> words(points.size());
  for_each_chunk(points.size(), 1 << 16, threads, control, [&](const chunk& c) {
    for (std::size_t first = c.begin; first < c.end; first += 8) {
      const std::size_t count = std::min<std::size_t>(8, c.end - first);
      const auto keys = order.keys(points.subspan(first, count));
      for (std::size_t i = 0; i < count; ++i) {
        words[first + i] = keys[i] << order.index_bits | (first + i);
      }
    }
  });
  radix_sort(words, {order.index_bits, order.index_bits + 3 * order.bits}, threads, control);
  return words;
}

inline box_tree::box_tree(std::span<const Eigen::Vector3f> points,
                          const curve& order,
                          unsigned threads,
                          const control& control) {
  if (threads == 0) threads = available_threads();
  const auto sorted = sort_along(points, order, threads, control);
  fill_blocks(points, sorted, order, threads, control);
  build_levels(threads, control);
}

inline void box_tree::fill_blocks(std::span<const Eigen::Vector3f> points,
                                  const buffer<std::uint64_t>& sorted,
                                  const curve& order,
                                  unsigned threads,
                                  const control& control) {
  constexpr std::size_t size = point_block::size;
  const std::size_t n = points.size();
  const std::uint64_t index_mask = (std::uint64_t{1} << order.index_bits) - 1;
  blocks_ = buffer<point_block>((n + size - 1) / size);
  index_ = buffer<std::uint32_t>(n);
  keys_ = buffer<std::uint64_t>(blocks_.size());
  for_each_chunk(blocks_.size(), 4096, threads, control, [&](const chunk& c) {
    for (std::size_t b = c.begin; b < c.end; ++b) {
      keys_[b] = sorted[b * size] >> order.index_bits;
      for (std::size_t ahead = 4 * size; ahead < 5 * size && b * size + ahead < n; ++ahead) {
        prefetch_read(&points[sorted[b * size + ahead] & index_mask]);
      }
      for (std::size_t j = 0; j < size; ++j) {
        const std::size_t place = std::min(b * size + j, n - 1);
        const auto i = static_cast<std::uint32_t>(sorted[place] & index_mask);
        index_[place] = i;
        for (int axis = 0; axis < 3; ++axis) blocks_[b].axis[axis][j] = points[i][axis];
      }
    }
  });
}

/// The range of a whole block on one axis, or of the eight children of a node.
inline std::pair<float, float> range_of(const point_block& block, int axis) {
  const f32x8 a = f32x8::load(block.axis[axis]);
  const f32x8 b = f32x8::load(block.axis[axis] + 8);
  return {lowest(min(a, b)), highest(max(a, b))};
}
inline std::pair<float, float> range_of(const box_node& node, int axis) {
  return {lowest(f32x8::load(node.low[axis])), highest(f32x8::load(node.high[axis]))};
}

/// The nodes above some blocks or nodes.
template <class Child>
buffer<box_node> boxes_above(std::span<const Child> children,
                             unsigned threads,
                             const control& control) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  constexpr std::size_t width = box_node::width;
  buffer<box_node> nodes((children.size() + width - 1) / width);
  for_each_chunk(nodes.size(), 4096, threads, control, [&](const chunk& c) {
    for (std::size_t i = c.begin * width; i < c.end * width; ++i) {
      box_node& node = nodes[i / width];
      for (int axis = 0; axis < 3; ++axis) {
        const auto [low, high] =
            i < children.size() ? range_of(children[i], axis) : std::pair{infinity, -infinity};
        node.low[axis][i % width] = low;
        node.high[axis][i % width] = high;
      }
    }
  });
  return nodes;
}

inline void box_tree::build_levels(unsigned threads, const control& control) {
  levels_.push_back(boxes_above(blocks(), threads, control));
  while (levels_.back().size() > 1) {
    levels_.push_back(boxes_above(levels_.back().span(), threads, control));
  }
}

inline std::size_t box_tree::bytes() const {
  std::size_t total = blocks_.size() * sizeof(point_block) + index_.size() * sizeof(std::uint32_t) +
                      keys_.size() * sizeof(std::uint64_t);
  for (const auto& level : levels_) total += level.size() * sizeof(box_node);
  return total;
}

}  // namespace AIB_ISA
}  // namespace aib::search
