// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/core/executor.hpp>
#include <aib/core/large_pages.hpp>
#include <aib/core/prefetch.hpp>
#include <aib/search/box_tree.hpp>
#include <aib/search/nearest_one.hpp>
#include <aib/search/nearest_packet.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

namespace aib::search {

struct nearest_options {
  /// Squared distances are searched below this bound only; a query without such a neighbour gets
  /// the bound itself.
  float squared_bound = std::numeric_limits<float>::infinity();
  unsigned threads = 0;  ///< 0: all
  aib::control control = {};
};

inline namespace AIB_ISA {

/// Squared distance from each point of `queries` to its nearest neighbour in `targets`, in the
/// order in which the points of `queries` were given.
///
/// Bit-equal to the minimum of (dx dx + dy dy) + dz dz in float over all targets, for any
/// instruction set and number of threads. Both trees are built along one curve (`common_curve`).
///
/// Source of the idea: all-nearest-neighbour search by dual traversal, Gray and Moore, "N-body
/// problems in statistical learning", NIPS 2000.
std::vector<float> nearest_squared(const box_tree& queries,
                                   const box_tree& targets,
                                   const nearest_options& options = {});

/// For each block of queries the block of targets in which its middle lies on the curve: the two
/// trees are merged like sorted lists.
class curve_merge {
 public:
  curve_merge(const box_tree& queries, const box_tree& targets, std::size_t first_block)
      : queries_(queries.keys()), targets_(targets.keys()) {
    const auto after = std::upper_bound(targets_.begin(), targets_.end(), queries_[first_block]);
    place_ = after == targets_.begin() ? 0 : static_cast<std::size_t>(after - targets_.begin()) - 1;
  }

  /// Blocks are asked for in order.
  std::uint32_t start_of(std::size_t block) {
    std::uint64_t key = queries_[block];
    if (block + 1 < queries_.size()) key += (queries_[block + 1] - key) / 2;
    while (place_ + 1 < targets_.size() && targets_[place_ + 1] <= key) ++place_;
    return static_cast<std::uint32_t>(place_);
  }

 private:
  std::span<const std::uint64_t> queries_, targets_;
  std::size_t place_ = 0;
};

inline std::vector<float> nearest_squared(const box_tree& queries,
                                          const box_tree& targets,
                                          const nearest_options& options) {
  constexpr std::size_t group = super_packet::packets;
  std::vector<float> squared;
  resize_in_large_pages(squared, queries.size());
  const std::size_t n_blocks = queries.blocks().size();
  for_each_chunk(n_blocks, 32 * group, options.threads, options.control, [&](const chunk& c) {
    const auto search = std::make_unique<super_packet>(targets, options.squared_bound);
    curve_merge merge(queries, targets, c.begin);
    for (std::size_t first = c.begin; first < c.end; first += group) {
      const std::size_t count = std::min(group, c.end - first);
      std::uint32_t start[group] = {};
      for (std::size_t b = 0; b < count; ++b) start[b] = merge.start_of(first + b);
      const std::size_t place = first * point_block::size;
      const auto index = queries.index().subspan(
          place, std::min(count * point_block::size, queries.size() - place));
      for (const std::uint32_t i : index) prefetch_write(&squared[i]);
      const auto found = search->search(queries.blocks().subspan(first, count), start);
      for (std::size_t i = 0; i < index.size(); ++i) squared[index[i]] = found[i];
    }
  });
  return squared;
}

}  // namespace AIB_ISA
}  // namespace aib::search
