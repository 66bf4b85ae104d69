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
#include <optional>
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

/// Finds the bin of an angle from a key in [0, 1] that grows or falls with it, without a root or an
/// arc function. The leading bits of the key choose a cell. Most cells lie within one bin; the
/// others name their first edge, and the key is compared. Where it is too near to an edge for its
/// rounding, the table does not know, and the caller calculates the angle.
class key_table {
 public:
  /// Added to the number of an edge in place of a bin.
  static constexpr std::uint32_t edge = 1u << 30;

  /// Keys nearer to an edge than this are not trusted: tens of roundings of a key in [0, 1].
  static constexpr double doubt = 1e-14;

  /// Cell of a key. All keys below the lowest share one.
  static constexpr std::size_t cell_of(double key) {
    return (std::bit_cast<std::uint64_t>(key > lowest ? key : lowest) >> shift) - first;
  }

  /// Cells of a table.
  static constexpr std::size_t size() { return cell_of(1) + 1; }

  /// keys   of the edges, in any order
  /// bin    bin of a key, std::size_t(double); below `edge`
  template <class BinOfKey>
  key_table(std::vector<double> keys, BinOfKey&& bin) : edges_(std::move(keys)), cells_(size()) {
    std::sort(edges_.begin(), edges_.end());
    for (std::size_t k = 0; k <= edges_.size(); ++k) {
      const double low = k == 0 ? 0 : edges_[k - 1], high = k == edges_.size() ? 1 : edges_[k];
      bins_.push_back(static_cast<std::uint32_t>(bin((low + high) / 2)));
      fill(low, high, bins_.back());
    }
    for (std::size_t k = edges_.size(); k-- > 0;)
      fill(edges_[k] - doubt, edges_[k] + doubt, edge + static_cast<std::uint32_t>(k));
  }

  /// One a cell: the bin of all its keys, or `edge` and its first edge.
  [[nodiscard]] const std::vector<std::uint32_t>& cells() const { return cells_; }

  /// The bin of a key; nothing where an edge is too near.
  [[nodiscard]] std::optional<std::uint32_t> find(double key) const {
    const std::uint32_t cell = cells_[cell_of(key)];
    if (cell < edge) return cell;
    std::size_t k = cell - edge;
    while (k < edges_.size() && key > edges_[k] + doubt) ++k;
    if (k < edges_.size() && key >= edges_[k] - doubt) return std::nullopt;
    return bins_[k];
  }

 private:
  static constexpr double lowest = 0x1p-14;
  static constexpr int shift = 43;  // leaves 9 of 52 fraction bits: 512 cells an octave
  static constexpr std::uint64_t first = std::bit_cast<std::uint64_t>(lowest) >> shift;

  void fill(double low, double high, std::uint32_t value) {
    const auto cell = [&](double key) {
      return cells_.begin() + static_cast<std::ptrdiff_t>(cell_of(std::min(key, 1.0)));
    };
    std::fill(cell(low), cell(high) + 1, value);
  }

  std::vector<double> edges_;
  std::vector<std::uint32_t> bins_;  // below the first edge, between two, above the last
  std::vector<std::uint32_t> cells_;
};

/// Table of rotation errors; their key is sin^2 of half the angle. A bin counts `stride`.
[[nodiscard]] inline key_table rotation_table(const angle_bins& bins, std::size_t stride = 1) {
  std::vector<double> keys;
  for (const double e : bins.edges_deg()) {
    const double s = std::sin(math::radians(e) / 2);
    if (e <= 180) keys.push_back(s * s);
  }
  return {std::move(keys), [&](double key) {
            return stride * bins.find(math::degrees(2 * std::asin(std::sqrt(key))));
          }};
}

/// Table of direction errors below 90 degrees; their key is sin^2 of the angle.
[[nodiscard]] inline key_table front_table(const angle_bins& bins) {
  std::vector<double> keys;
  for (const double e : bins.edges_deg()) {
    const double s = std::sin(math::radians(e));
    if (e <= 90) keys.push_back(s * s);
  }
  return {std::move(keys),
          [&](double key) { return bins.find(math::degrees(std::asin(std::sqrt(key)))); }};
}

/// Table of direction errors above 90 degrees; their key is sin^2 of what is missing to 180.
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
