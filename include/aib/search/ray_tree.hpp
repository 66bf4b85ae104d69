// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/core/executor.hpp>
#include <aib/core/isa.hpp>
#include <aib/search/triangle_tree.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

namespace aib::search {

/// A box along the axes in floats. Empty until something is added.
struct box3 {
  float low[3] = {HUGE_VALF, HUGE_VALF, HUGE_VALF};
  float high[3] = {-HUGE_VALF, -HUGE_VALF, -HUGE_VALF};

  void add(const box3& other) {
    for (int a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], other.low[a]);
      high[a] = std::max(high[a], other.high[a]);
    }
  }
  void add(const corners& t) {
    for (const auto& corner : t.at) {
      for (int a = 0; a < 3; ++a) {
        low[a] = std::min(low[a], corner[a]);
        high[a] = std::max(high[a], corner[a]);
      }
    }
  }
  /// Half of its surface, 0 where it is empty.
  [[nodiscard]] float half_area() const {
    const float x = high[0] - low[0], y = high[1] - low[1], z = high[2] - low[2];
    return x >= 0 ? x * y + y * z + z * x : 0;
  }
  [[nodiscard]] float middle(int axis) const { return low[axis] / 2 + high[axis] / 2; }
};

inline namespace AIB_ISA {

/// Boxes of up to eight children, coordinates side by side. The first `n` children are there.
struct alignas(32) ray_node {
  static constexpr std::size_t width = 8;
  static constexpr std::uint32_t leaf = 1u << 31;

  float low[3][width];
  float high[3][width];
  std::uint32_t child[width];  ///< a node, or `leaf` and a block
  std::uint32_t n;
};

/// Up to eight triangles, coordinates side by side; lanes from `n` on repeat the first.
struct alignas(32) triangle_block {
  static constexpr std::size_t size = 8;

  float corner[3][3][size];   ///< [corner][axis][lane]
  std::uint32_t index[size];  ///< of the triangle, as given
  std::uint32_t n;
};

/// Triangles under a tree of boxes that costs rays little: wide nodes split by the surface area
/// heuristic. Triangles must be finite. The tree is the same for any number of threads.
///
/// Source: Wald, "On fast construction of SAH-based bounding volume hierarchies", 2007 (bins);
/// Wald, Benthin, Boulos, "Getting rid of packets", 2008 (wide nodes by the largest area).
class ray_tree {
 public:
  /// Levels that a tree has at most: a stack of 8 entries a level never overflows.
  static constexpr std::size_t max_levels = 64;

  /// Throws undefined_error if there is no triangle.
  explicit ray_tree(std::span<const corners> triangles,
                    unsigned threads = 0,
                    const control& control = {});

  /// The root is node 0.
  [[nodiscard]] std::span<const ray_node> nodes() const { return nodes_; }
  [[nodiscard]] std::span<const triangle_block> blocks() const { return blocks_; }

  /// Index, as given, of the triangle at a place (8 block + lane).
  [[nodiscard]] std::uint32_t index(std::uint32_t place) const {
    return blocks_[place / triangle_block::size].index[place % triangle_block::size];
  }

  /// Corners of the triangle at a place.
  [[nodiscard]] std::array<Eigen::Vector3d, 3> triangle(std::uint32_t place) const;

 private:
  std::vector<ray_node> nodes_;
  std::vector<triangle_block> blocks_;
};

namespace detail {

/// Some triangles: a part of the builder's order.
struct triangle_range {
  std::uint32_t begin, end;
  box3 box;

  [[nodiscard]] std::uint32_t size() const { return end - begin; }
};

/// A part of a tree; children count from its own first node and block.
struct ray_subtree {
  std::vector<ray_node> nodes;
  std::vector<triangle_block> blocks;
};

/// A child that is built later, as a tree of its own.
struct postponed_child {
  std::uint32_t node, slot;
  std::size_t level;
  triangle_range range;
};

/// Splits ranges of triangles and makes nodes of them.
class ray_tree_builder {
 public:
  ray_tree_builder(std::span<const corners> triangles, unsigned threads, const control& control);

  /// The upper part of the tree and, if it is large, the parts that were put off.
  ray_subtree build(unsigned threads, const control& control);

 private:
  static constexpr int n_bins = 16;
  /// Below this level ranges are halved, so that the depth is bounded.
  static constexpr std::size_t halve_from = 24;

  struct bin {
    box3 box;
    std::uint32_t n = 0;
  };
  struct cut {
    int axis = -1;
    int bin = 0;  ///< the first one on the right
    float cost = HUGE_VALF;
  };
  struct bin_scale {
    float low = 0, factor = 0;
    [[nodiscard]] int of(float middle) const {
      const float x = (middle - low) * factor;
      if (!(x > 0)) return 0;
      return x < n_bins - 1 ? static_cast<int>(x) : n_bins - 1;
    }
  };

  std::uint32_t add_node(ray_subtree& tree,
                         const triangle_range& range,
                         std::size_t level,
                         std::vector<postponed_child>* later);
  std::uint32_t add_block(ray_subtree& tree, const triangle_range& range) const;
  std::size_t split_eightfold(std::array<triangle_range, 8>& parts, std::size_t level);
  std::pair<triangle_range, triangle_range> split(const triangle_range& range, std::size_t level);
  std::pair<triangle_range, triangle_range> halve(const triangle_range& range) const;
  [[nodiscard]] std::array<bin_scale, 3> scales_of(const triangle_range& range) const;
  [[nodiscard]] cut best_cut(const triangle_range& range,
                             const std::array<bin_scale, 3>& scales) const;
  [[nodiscard]] box3 box_of(std::uint32_t begin, std::uint32_t end) const;

  std::span<const corners> triangles_;
  std::vector<box3> boxes_;
  std::vector<std::uint32_t> order_;
  std::uint32_t put_off_below_ = 0;
};

inline ray_tree_builder::ray_tree_builder(std::span<const corners> triangles,
                                          unsigned threads,
                                          const control& control)
    : triangles_(triangles), boxes_(triangles.size()), order_(triangles.size()) {
  for_each_chunk(triangles.size(), 1 << 16, threads, control, [&](const chunk& c) {
    for (std::size_t i = c.begin; i < c.end; ++i) {
      boxes_[i].add(triangles[i]);
      order_[i] = static_cast<std::uint32_t>(i);
    }
  });
}

inline box3 ray_tree_builder::box_of(std::uint32_t begin, std::uint32_t end) const {
  box3 box;
  for (std::uint32_t i = begin; i < end; ++i) box.add(boxes_[order_[i]]);
  return box;
}

inline std::array<ray_tree_builder::bin_scale, 3> ray_tree_builder::scales_of(
    const triangle_range& range) const {
  box3 middles;
  for (std::uint32_t i = range.begin; i < range.end; ++i) {
    const box3& box = boxes_[order_[i]];
    for (int a = 0; a < 3; ++a) {
      middles.low[a] = std::min(middles.low[a], box.middle(a));
      middles.high[a] = std::max(middles.high[a], box.middle(a));
    }
  }
  std::array<bin_scale, 3> scales;
  for (std::size_t a = 0; a < 3; ++a) {
    const float extent = middles.high[a] - middles.low[a];
    const float factor = static_cast<float>(n_bins) / extent;
    scales[a] = {middles.low[a], factor < HUGE_VALF ? factor : 0};
  }
  return scales;
}

inline ray_tree_builder::cut ray_tree_builder::best_cut(
    const triangle_range& range, const std::array<bin_scale, 3>& scales) const {
  std::array<std::array<bin, n_bins>, 3> bins;
  for (std::uint32_t i = range.begin; i < range.end; ++i) {
    const box3& box = boxes_[order_[i]];
    for (std::size_t a = 0; a < 3; ++a) {
      bin& b = bins[a][static_cast<std::size_t>(scales[a].of(box.middle(static_cast<int>(a))))];
      b.box.add(box);
      ++b.n;
    }
  }
  cut best;
  for (int axis = 0; axis < 3; ++axis) {
    const auto& row = bins[static_cast<std::size_t>(axis)];
    float cost_right[n_bins] = {};
    bin right;
    for (int k = n_bins - 1; k > 0; --k) {
      right.box.add(row[static_cast<std::size_t>(k)].box);
      right.n += row[static_cast<std::size_t>(k)].n;
      cost_right[k] =
          right.n == 0 ? HUGE_VALF : right.box.half_area() * static_cast<float>(right.n);
    }
    bin left;
    for (int k = 1; k < n_bins; ++k) {
      left.box.add(row[static_cast<std::size_t>(k - 1)].box);
      left.n += row[static_cast<std::size_t>(k - 1)].n;
      if (left.n == 0) continue;
      const float cost = left.box.half_area() * static_cast<float>(left.n) + cost_right[k];
      if (cost < best.cost) best = {axis, k, cost};
    }
  }
  return best;
}

inline std::pair<triangle_range, triangle_range> ray_tree_builder::halve(
    const triangle_range& range) const {
  const std::uint32_t middle = range.begin + range.size() / 2;
  return {{range.begin, middle, box_of(range.begin, middle)},
          {middle, range.end, box_of(middle, range.end)}};
}

inline std::pair<triangle_range, triangle_range> ray_tree_builder::split(
    const triangle_range& range, std::size_t level) {
  if (level >= halve_from) return halve(range);
  const auto scales = scales_of(range);
  const cut best = best_cut(range, scales);
  if (best.axis < 0) return halve(range);
  const bin_scale& scale = scales[static_cast<std::size_t>(best.axis)];
  triangle_range left{range.begin, range.begin, {}}, right{range.end, range.end, {}};
  while (left.end < right.begin) {
    const std::uint32_t t = order_[left.end];
    if (scale.of(boxes_[t].middle(best.axis)) < best.bin) {
      left.box.add(boxes_[t]);
      ++left.end;
    } else {
      right.box.add(boxes_[t]);
      std::swap(order_[left.end], order_[--right.begin]);
    }
  }
  return {left, right};
}

inline std::size_t ray_tree_builder::split_eightfold(std::array<triangle_range, 8>& parts,
                                                     std::size_t level) {
  std::size_t n = 1;
  for (; n < parts.size(); ++n) {
    triangle_range* widest = nullptr;
    for (std::size_t i = 0; i < n; ++i) {
      if (parts[i].size() <= triangle_block::size) continue;
      if (!widest || parts[i].box.half_area() > widest->box.half_area()) widest = &parts[i];
    }
    if (!widest) break;
    std::tie(*widest, parts[n]) = split(*widest, level);
  }
  return n;
}

inline std::uint32_t ray_tree_builder::add_block(ray_subtree& tree,
                                                 const triangle_range& range) const {
  triangle_block block;
  block.n = range.size();
  for (std::uint32_t lane = 0; lane < triangle_block::size; ++lane) {
    const std::uint32_t t = order_[range.begin + (lane < block.n ? lane : 0)];
    block.index[lane] = t;
    for (int k = 0; k < 3; ++k)
      for (int a = 0; a < 3; ++a) block.corner[k][a][lane] = triangles_[t].at[k][a];
  }
  tree.blocks.push_back(block);
  return static_cast<std::uint32_t>(tree.blocks.size() - 1);
}

inline std::uint32_t ray_tree_builder::add_node(ray_subtree& tree,
                                                const triangle_range& range,
                                                std::size_t level,
                                                std::vector<postponed_child>* later) {
  std::array<triangle_range, 8> parts;
  parts[0] = range;
  const auto n = static_cast<std::uint32_t>(split_eightfold(parts, level));
  const auto here = static_cast<std::uint32_t>(tree.nodes.size());
  ray_node node = {};
  node.n = n;
  for (std::uint32_t i = 0; i < n; ++i) {
    for (int a = 0; a < 3; ++a) {
      node.low[a][i] = parts[i].box.low[a];
      node.high[a][i] = parts[i].box.high[a];
    }
  }
  tree.nodes.push_back(node);
  for (std::uint32_t i = 0; i < n; ++i) {
    std::uint32_t child = 0;
    if (parts[i].size() <= triangle_block::size) {
      child = ray_node::leaf | add_block(tree, parts[i]);
    } else if (later && parts[i].size() < put_off_below_) {
      later->push_back({here, i, level + 1, parts[i]});
    } else {
      child = add_node(tree, parts[i], level + 1, later);
    }
    tree.nodes[here].child[i] = child;
  }
  return here;
}

/// Puts a subtree behind a tree. Returns where its root is.
inline std::uint32_t append(ray_subtree& tree, const ray_subtree& part) {
  const auto first_node = static_cast<std::uint32_t>(tree.nodes.size());
  const auto first_block = static_cast<std::uint32_t>(tree.blocks.size());
  for (ray_node node : part.nodes) {
    for (std::uint32_t i = 0; i < node.n; ++i)
      node.child[i] += (node.child[i] & ray_node::leaf) != 0 ? first_block : first_node;
    tree.nodes.push_back(node);
  }
  tree.blocks.insert(tree.blocks.end(), part.blocks.begin(), part.blocks.end());
  return first_node;
}

inline ray_subtree ray_tree_builder::build(unsigned threads, const control& control) {
  const auto n = static_cast<std::uint32_t>(triangles_.size());
  put_off_below_ = std::max(n / 64, 4096u);
  std::vector<postponed_child> later;
  ray_subtree tree;
  add_node(tree, {0, n, box_of(0, n)}, 0, &later);
  std::vector<ray_subtree> parts(later.size());
  for_each_chunk(later.size(), 1, threads, control, [&](const chunk& c) {
    add_node(parts[c.index], later[c.index].range, later[c.index].level, nullptr);
  });
  for (std::size_t i = 0; i < parts.size(); ++i)
    tree.nodes[later[i].node].child[later[i].slot] = append(tree, parts[i]);
  return tree;
}

}  // namespace detail

inline ray_tree::ray_tree(std::span<const corners> triangles,
                          unsigned threads,
                          const control& control) {
  if (triangles.empty()) throw undefined_error("search::ray_tree: no triangle");
  if (threads == 0) threads = available_threads();
  detail::ray_subtree tree =
      detail::ray_tree_builder(triangles, threads, control).build(threads, control);
  nodes_ = std::move(tree.nodes);
  blocks_ = std::move(tree.blocks);
}

inline std::array<Eigen::Vector3d, 3> ray_tree::triangle(std::uint32_t place) const {
  const triangle_block& block = blocks_[place / triangle_block::size];
  const std::size_t lane = place % triangle_block::size;
  std::array<Eigen::Vector3d, 3> t;
  for (std::size_t k = 0; k < 3; ++k)
    for (int a = 0; a < 3; ++a) t[k][a] = static_cast<double>(block.corner[k][a][lane]);
  return t;
}

}  // namespace AIB_ISA
}  // namespace aib::search
