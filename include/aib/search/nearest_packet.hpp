// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/simd_wide.hpp>
#include <aib/search/box_tree.hpp>
#include <aib/search/nearest_one.hpp>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace aib::search {
inline namespace AIB_ISA {

/// Sixteen queries, a lane each, and the squared distances known so far.
struct packet {
  static constexpr std::size_t size = f32x16::width;
  f32x16 axis[3];
  f32x16 best;

  /// Takes the sixteen points of a block into account.
  void visit(const point_block& block) {
    for (std::size_t j = 0; j < point_block::size; ++j) {
      const f32x16 x = f32x16::broadcast(block.axis[0][j]);
      const f32x16 y = f32x16::broadcast(block.axis[1][j]);
      const f32x16 z = f32x16::broadcast(block.axis[2][j]);
      best = min(best, squared_length(axis[0] - x, axis[1] - y, axis[2] - z));
    }
  }
};

/// Nearest neighbours of up to 256 queries that follow each other on the curve. They share one walk
/// through the tree, which lists the blocks that any of them may need; each packet then goes
/// through the list. Queries that lie far from the cloud would make the list long for all: they are
/// searched alone.
class super_packet {
 public:
  static constexpr std::size_t packets = 16;
  static constexpr std::size_t lanes = packets * packet::size;

  super_packet(const box_tree& tree, float bound) : tree_(tree), bound_(bound) {}

  /// The smaller of the bound and the squared distance of each query, in the order of the blocks.
  ///
  /// queries   1 .. 16 blocks
  /// start     for each of them a block of the tree that is probably near
  std::span<const float> search(std::span<const point_block> queries, const std::uint32_t* start);

 private:
  /// A lane is searched alone when its squared distance to the starting blocks is beyond this many
  /// times the median; a walk that lists more blocks than the limit is given up for searches alone.
  static constexpr float stray_factor = 25;
  static constexpr std::size_t most_candidates = 512;

  void load(std::span<const point_block> queries);
  void visit_start(const std::uint32_t* start);
  void search_strays(std::uint32_t near_block);
  bool list_candidates();
  void add_candidate(const box_node& node, std::size_t lane, std::uint32_t block);
  void pad_candidates();
  void visit_candidates(std::size_t packet_index, std::uint32_t start);
  void near_candidates(std::size_t packet_index);
  void search_all_alone(std::uint32_t near_block);

  [[nodiscard]] float stray_threshold() const;
  [[nodiscard]] query lane(std::size_t i) const { return {axis_[0][i], axis_[1][i], axis_[2][i]}; }
  [[nodiscard]] packet load_packet(std::size_t p) const;
  void store_best(std::size_t p, const packet& q);
  [[nodiscard]] static bool may_improve(const packet& q,
                                        const float (&low)[3],
                                        const float (&high)[3]);

  const box_tree& tree_;
  float bound_;
  std::size_t count_ = 0;  ///< lanes in use, a multiple of 16
  alignas(64) float axis_[3][lanes];
  alignas(64) float best_[lanes];
  float found_alone_[lanes];
  bool stray_[lanes];

  std::size_t candidates_ = 0;
  alignas(64) float low_[3][most_candidates + 16];
  alignas(64) float high_[3][most_candidates + 16];
  std::uint32_t block_[most_candidates + 16];
  std::uint64_t near_[most_candidates / 64 + 1];  ///< a bit a candidate
};

/// The box of some lanes, each bound in all eight lanes.
struct lane_box {
  f32x8 low[3];
  f32x8 high[3];
};

inline std::span<const float> super_packet::search(std::span<const point_block> queries,
                                                   const std::uint32_t* start) {
  load(queries);
  visit_start(start);
  search_strays(start[0]);
  if (list_candidates()) {
    for (std::size_t p = 0; p < queries.size(); ++p) visit_candidates(p, start[p]);
  } else {
    search_all_alone(start[0]);
  }
  for (std::size_t i = 0; i < count_; ++i) {
    if (stray_[i]) best_[i] = found_alone_[i];
  }
  return {best_, count_};
}

inline void super_packet::load(std::span<const point_block> queries) {
  count_ = queries.size() * packet::size;
  for (std::size_t p = 0; p < queries.size(); ++p) {
    for (int k = 0; k < 3; ++k) {
      std::copy_n(queries[p].axis[k], packet::size, axis_[k] + p * packet::size);
    }
  }
}

inline packet super_packet::load_packet(std::size_t p) const {
  const std::size_t first = p * packet::size;
  packet q;
  for (int k = 0; k < 3; ++k) q.axis[k] = f32x16::load(axis_[k] + first);
  q.best = f32x16::load(best_ + first);
  return q;
}

inline void super_packet::store_best(std::size_t p, const packet& q) {
  q.best.store(best_ + p * packet::size);
}

/// Each packet looks at the block that the curve leads it to and at its two neighbours.
inline void super_packet::visit_start(const std::uint32_t* start) {
  const auto last = static_cast<std::uint32_t>(tree_.blocks().size() - 1);
  std::fill_n(best_, count_, bound_);
  for (std::size_t p = 0; p < count_ / packet::size; ++p) {
    packet q = load_packet(p);
    const std::uint32_t from = start[p] > 0 ? start[p] - 1 : 0;
    const std::uint32_t to = std::min(last, start[p] + 1);
    for (std::uint32_t b = from; b <= to; ++b) q.visit(tree_.blocks()[b]);
    store_best(p, q);
  }
}

inline float super_packet::stray_threshold() const {
  float sample[lanes / 5 + 1];
  std::size_t n = 0;
  for (std::size_t i = 0; i < count_; i += 5) sample[n++] = best_[i];
  std::nth_element(sample, sample + n / 2, sample + n);
  return sample[n / 2] * stray_factor;
}

/// Strays are searched alone and then hidden behind a neighbour that is none, so that the box of
/// the queries stays tight.
inline void super_packet::search_strays(std::uint32_t near_block) {
  const float threshold = stray_threshold();
  std::size_t keeper = count_;
  for (std::size_t i = count_; i-- > 0;) {
    stray_[i] = best_[i] > threshold;
    if (!stray_[i]) keeper = i;
  }
  for (std::size_t i = 0; i < count_; ++i) {
    if (!stray_[i]) {
      keeper = i;
      continue;
    }
    found_alone_[i] = nearest_one(tree_, lane(i), best_[i], near_block);
    for (auto& axis : axis_) axis[i] = axis[keeper];
    best_[i] = best_[keeper];
  }
}

/// The box of n lanes (a multiple of 8).
inline lane_box box_of(const float* x, const float* y, const float* z, std::size_t n) {
  lane_box box;
  const float* axis[3] = {x, y, z};
  for (int k = 0; k < 3; ++k) {
    f32x8 low = f32x8::load(axis[k]);
    f32x8 high = low;
    for (std::size_t i = 8; i < n; i += 8) {
      const f32x8 a = f32x8::load(axis[k] + i);
      low = min(low, a);
      high = max(high, a);
    }
    box.low[k] = f32x8::broadcast(lowest(low));
    box.high[k] = f32x8::broadcast(highest(high));
  }
  return box;
}

/// Lists the blocks nearer to the box of all queries than the worst of them needs. False where
/// there are too many.
inline bool super_packet::list_candidates() {
  const lane_box box = box_of(axis_[0], axis_[1], axis_[2], count_);
  const f32x8 worst = f32x8::broadcast(*std::max_element(best_, best_ + count_));
  candidates_ = 0;
  struct place {
    std::uint32_t level, index;
  } pending[96];
  std::size_t size = 0;
  pending[size++] = {static_cast<std::uint32_t>(tree_.levels() - 1), 0};
  while (size > 0) {
    const place at = pending[--size];
    const box_node& node = tree_.level(at.level)[at.index];
    unsigned mask = less(squared_distances(box.low, box.high, node), worst);
    if (at.level == 0 && candidates_ > most_candidates) return false;
    for (; mask != 0; mask &= mask - 1) {
      const auto child = static_cast<std::uint32_t>(std::countr_zero(mask));
      if (at.level == 0) {
        add_candidate(node, child, at.index * 8 + child);
      } else {
        pending[size++] = {at.level - 1, at.index * 8 + child};
      }
    }
  }
  pad_candidates();
  return true;
}

inline void super_packet::add_candidate(const box_node& node,
                                        std::size_t lane,
                                        std::uint32_t block) {
  for (int k = 0; k < 3; ++k) {
    low_[k][candidates_] = node.low[k][lane];
    high_[k][candidates_] = node.high[k][lane];
  }
  block_[candidates_++] = block;
}

/// Fills the list up to a multiple of eight with boxes that nobody needs.
inline void super_packet::pad_candidates() {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  for (; candidates_ % 8 != 0; ++candidates_) {
    for (int k = 0; k < 3; ++k) {
      low_[k][candidates_] = infinity;
      high_[k][candidates_] = -infinity;
    }
  }
}

/// Whether a box is nearer to any of the sixteen queries than what that one has.
inline bool super_packet::may_improve(const packet& q,
                                      const float (&low)[3],
                                      const float (&high)[3]) {
  f32x16 gap[3];
  for (int k = 0; k < 3; ++k) {
    const f32x16 before = f32x16::broadcast(low[k]) - q.axis[k];
    const f32x16 behind = q.axis[k] - f32x16::broadcast(high[k]);
    gap[k] = max(max(before, behind), f32x16::broadcast(0));
  }
  return less(squared_length(gap[0], gap[1], gap[2]), q.best) != 0;
}

inline void super_packet::visit_candidates(std::size_t p, std::uint32_t start) {
  packet q = load_packet(p);
  near_candidates(p);
  for (std::size_t word = 0; word * 64 < candidates_; ++word) {
    for (std::uint64_t mask = near_[word]; mask != 0; mask &= mask - 1) {
      const std::size_t c = word * 64 + static_cast<std::size_t>(std::countr_zero(mask));
      const bool seen = block_[c] + 1 >= start && block_[c] <= start + 1;
      if (!seen && may_improve(q, {low_[0][c], low_[1][c], low_[2][c]},
                               {high_[0][c], high_[1][c], high_[2][c]})) {
        q.visit(tree_.blocks()[block_[c]]);
      }
    }
  }
  store_best(p, q);
}

/// Marks the candidates that are nearer to the box of a packet than the worst of its queries needs.
inline void super_packet::near_candidates(std::size_t p) {
  const std::size_t first = p * packet::size;
  const lane_box box = box_of(axis_[0] + first, axis_[1] + first, axis_[2] + first, packet::size);
  const f32x8 worst =
      f32x8::broadcast(*std::max_element(best_ + first, best_ + first + packet::size));
  std::fill_n(near_, (candidates_ + 63) / 64, 0);
  for (std::size_t i = 0; i < candidates_; i += 8) {
    f32x8 gap[3];
    for (int k = 0; k < 3; ++k) {
      const f32x8 before = f32x8::load(low_[k] + i) - box.high[k];
      const f32x8 behind = box.low[k] - f32x8::load(high_[k] + i);
      gap[k] = max(max(before, behind), f32x8::broadcast(0));
    }
    const std::uint64_t mask = less(squared_length(gap[0], gap[1], gap[2]), worst);
    near_[i / 64] |= mask << (i % 64);
  }
}

inline void super_packet::search_all_alone(std::uint32_t near_block) {
  for (std::size_t i = 0; i < count_; ++i) {
    if (!stray_[i]) best_[i] = nearest_one(tree_, lane(i), best_[i], near_block);
  }
}

}  // namespace AIB_ISA
}  // namespace aib::search
