// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/math/rotation.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace aib::pose {

/// Bins of angles between ascending edges in degrees: bin k holds edge[k - 1] <= angle < edge[k].
class angle_bins {
 public:
  /// Sorts the edges and drops repeated ones. Throws argument_error unless each is in (0, 360].
  explicit angle_bins(std::vector<double> edges_deg) : edges_deg_(std::move(edges_deg)) {
    for (const double e : edges_deg_) {
      if (e > 0 && e <= 360) continue;
      throw argument_error(message("angle_bins: edges in (0, 360] degrees expected, found ", e));
    }
    std::sort(edges_deg_.begin(), edges_deg_.end());
    edges_deg_.erase(std::unique(edges_deg_.begin(), edges_deg_.end()), edges_deg_.end());
  }

  [[nodiscard]] std::size_t size() const { return edges_deg_.size() + 1; }
  [[nodiscard]] const std::vector<double>& edges_deg() const { return edges_deg_; }

  /// Bin of an angle: the number of edges that it reaches.
  [[nodiscard]] std::size_t find(double angle_deg) const {
    return static_cast<std::size_t>(
        std::upper_bound(edges_deg_.begin(), edges_deg_.end(), angle_deg) - edges_deg_.begin());
  }

  /// Number of bins that lie wholly below an edge. Throws argument_error if it is none of ours.
  [[nodiscard]] std::size_t bins_below(double edge_deg) const {
    const auto at = std::lower_bound(edges_deg_.begin(), edges_deg_.end(), edge_deg);
    if (at == edges_deg_.end() || *at != edge_deg)
      throw argument_error(message("angle_bins: ", edge_deg, " degrees is not an edge"));
    return static_cast<std::size_t>(at - edges_deg_.begin()) + 1;
  }

 private:
  std::vector<double> edges_deg_;
};

/// Finds the bin of an angle from a key in [0, 1] that grows or falls with it, without a root, an
/// arc function or a search: the leading bits of the key choose a cell, which holds at most one
/// edge. Where a key is too near to an edge for its rounding, or a cell holds several edges, the
/// table says so, and the caller calculates the angle.
class key_table {
 public:
  struct cell {
    double edge;           ///< key; infinite: no edge here; NaN: ask the angle
    std::uint32_t bin[2];  ///< of keys above, of keys below the edge: indexed by a sign bit
  };

  /// Cells of a table.
  static constexpr std::size_t size() { return cell_of(1) + 1; }

  /// Keys nearer to an edge than this are not trusted: tens of roundings of a key in [0, 1].
  static constexpr double doubt = 1e-14;

  /// Cell of a key.
  static constexpr std::size_t cell_of(double key) {
    return (std::bit_cast<std::uint64_t>(key > lowest ? key : lowest) >> shift) - first;
  }

  /// keys   keys of the edges, in any order
  /// bin    bin of a key, std::size_t(double)
  template <class BinOfKey>
  key_table(std::vector<double> keys, BinOfKey&& bin) {
    std::sort(keys.begin(), keys.end());
    cells_.reserve(size());
    for (std::size_t i = 0; i < size(); ++i) {
      const double low = i == 0 ? 0 : lower_end(i);
      const double high = std::min(1.0, lower_end(i + 1));
      const auto from = std::lower_bound(keys.begin(), keys.end(), low - doubt);
      const auto to = std::upper_bound(keys.begin(), keys.end(), high + doubt);
      cells_.push_back(from == to ? without_edge(bin((low + high) / 2))
                                  : with_edges(low, *from, *(to - 1), high, bin));
    }
  }

  [[nodiscard]] const std::vector<cell>& cells() const { return cells_; }

 private:
  static constexpr double lowest = 0x1p-20;
  static constexpr int shift = 46;  // leaves 6 of 52 fraction bits: 64 cells an octave
  static constexpr std::uint64_t first = std::bit_cast<std::uint64_t>(lowest) >> shift;

  static double lower_end(std::size_t i) { return std::bit_cast<double>((first + i) << shift); }

  static cell without_edge(std::size_t bin) {
    const auto b = static_cast<std::uint32_t>(bin);
    return {std::numeric_limits<double>::infinity(), {b, b}};
  }

  template <class BinOfKey>
  static cell with_edges(double low, double edge, double last, double high, BinOfKey& bin) {
    if (last - edge > doubt / 4) return {std::numeric_limits<double>::quiet_NaN(), {0, 0}};
    return {edge,
            {static_cast<std::uint32_t>(bin(std::min(1.0, (edge + high) / 2))),
             static_cast<std::uint32_t>(bin(std::max(0.0, (low + edge) / 2)))}};
  }

  std::vector<cell> cells_;
};

/// Key of a rotation error: sin^2 of half the angle.
[[nodiscard]] inline key_table rotation_table(const angle_bins& bins) {
  std::vector<double> keys;
  for (const double e : bins.edges_deg()) {
    const double s = std::sin(math::radians(e) / 2);
    if (e <= 180) keys.push_back(s * s);
  }
  return {std::move(keys),
          [&](double key) { return bins.find(math::degrees(2 * std::asin(std::sqrt(key)))); }};
}

/// Key of a direction error below 90 degrees: sin^2 of the angle.
[[nodiscard]] inline key_table front_table(const angle_bins& bins) {
  std::vector<double> keys;
  for (const double e : bins.edges_deg()) {
    const double s = std::sin(math::radians(e));
    if (e <= 90) keys.push_back(s * s);
  }
  return {std::move(keys),
          [&](double key) { return bins.find(math::degrees(std::asin(std::sqrt(key)))); }};
}

/// Key of a direction error above 90 degrees: sin^2 of what is missing to 180.
[[nodiscard]] inline key_table back_table(const angle_bins& bins) {
  std::vector<double> keys;
  for (const double e : bins.edges_deg()) {
    const double s = std::sin(math::radians(180 - e));
    if (e >= 90 && e <= 180) keys.push_back(s * s);
  }
  return {std::move(keys),
          [&](double key) { return bins.find(180 - math::degrees(std::asin(std::sqrt(key)))); }};
}

}  // namespace aib::pose
