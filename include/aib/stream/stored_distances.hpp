// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/distances.hpp>
#include <aib/core/error.hpp>
#include <aib/stream/spill.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace aib::stream {

/// Distances that lie on disk, with the statistics of cloud::distances, bit for bit.
class stored_distances {
 public:
  stored_distances(const std::filesystem::path& folder, const cloud::distance_options& options)
      : values_(folder), options_(options), upper_halves_(halves) {}

  /// Takes the next distance: NaN for a point that is not finite.
  void append(float value) {
    chunk_.push_back(value);
    if (chunk_.size() == cloud::detail::value_chunk) take_chunk();
  }
  /// To be called after the last.
  void finish() { take_chunk(); }

  [[nodiscard]] std::size_t n_dropped() const { return sums_.dropped; }
  [[nodiscard]] std::size_t n_finite() const { return values_.size() - sums_.dropped; }
  [[nodiscard]] double mean() const { return sums_.sum / counted(); }
  [[nodiscard]] double rmse() const { return std::sqrt(sums_.squares / counted()); }
  [[nodiscard]] double max() const { return demand_values(), sums_.max; }
  [[nodiscard]] double share_beyond() const {
    return static_cast<double>(n_beyond_) / static_cast<double>(n_finite());
  }

  [[nodiscard]] double median() const {
    demand_values();
    const double place = 0.5 * static_cast<double>(n_counted() - 1);
    const auto below = static_cast<std::uint64_t>(place);
    const double low = nth(below);
    const double share = place - static_cast<double>(below);
    return share == 0 ? low : low + (static_cast<double>(nth(below + 1)) - low) * share;
  }

  [[nodiscard]] std::vector<double> shares_below(std::span<const double> tau) const {
    std::vector<std::uint64_t> below(tau.size());
    for_each_value([&](float d) {
      for (std::size_t k = 0; k < tau.size(); ++k) below[k] += static_cast<double>(d) < tau[k];
    });
    std::vector<double> shares;
    for (const std::uint64_t n : below)
      shares.push_back(static_cast<double>(n) / static_cast<double>(n_finite()));
    return shares;
  }

 private:
  static constexpr std::size_t halves = std::size_t{1} << 16;

  [[nodiscard]] std::uint64_t n_counted() const {
    return n_finite() - (cloud::detail::drops(options_) ? n_beyond_ : 0);
  }
  [[nodiscard]] double counted() const { return demand_values(), static_cast<double>(n_counted()); }
  void demand_values() const {
    if (n_counted() > 0) return;
    throw undefined_error(message("stream::compare_clouds: no distance that counts (", n_finite(),
                                  " points, ", n_beyond_, " beyond max_distance)"));
  }

  [[nodiscard]] bool counts(float d) const {
    return !std::isnan(d) && !(cloud::detail::drops(options_) && std::isinf(d));
  }

  /// Distances are not negative, so that their bits have their order.
  void take_chunk() {
    n_beyond_ += cloud::detail::cut_at_maximum(chunk_, options_);
    sums_ += cloud::detail::sums_of(chunk_, options_);
    for (const float d : chunk_) {
      if (counts(d)) ++upper_halves_[std::bit_cast<std::uint32_t>(d) >> 16];
    }
    values_.append(std::span<const float>(chunk_));
    chunk_.clear();
  }

  template <class Visit>
  void for_each_value(Visit&& visit) const {
    std::vector<float> block;
    for (std::uint64_t first = 0; first < values_.size(); first += block.size()) {
      block.resize(static_cast<std::size_t>(
          std::min<std::uint64_t>(values_.size() - first, cloud::detail::value_chunk)));
      values_.read(first, block);
      for (const float d : block) visit(d);
    }
  }

  /// Bin of the value of a rank, and how many values lie in the bins below it.
  static std::pair<std::uint32_t, std::uint64_t> bin_of(std::span<const std::uint64_t> bins,
                                                        std::uint64_t rank) {
    std::uint64_t below = 0;
    std::uint32_t bin = 0;
    while (below + bins[bin] <= rank) below += bins[bin++];
    return {bin, below};
  }

  /// The value of a rank, from 0: by the upper half of its bits, then the lower.
  [[nodiscard]] float nth(std::uint64_t rank) const {
    const auto [upper, below] = bin_of(upper_halves_, rank);
    std::vector<std::uint64_t> lower_halves(halves);
    for_each_value([&, upper = upper](float d) {
      const auto bits = std::bit_cast<std::uint32_t>(d);
      if (counts(d) && bits >> 16 == upper) ++lower_halves[bits & 0xffff];
    });
    return std::bit_cast<float>(upper << 16 | bin_of(lower_halves, rank - below).first);
  }

  mutable spill<float> values_;
  cloud::distance_options options_;
  std::vector<float> chunk_;
  std::vector<std::uint64_t> upper_halves_;
  cloud::detail::distance_sums sums_;
  std::uint64_t n_beyond_ = 0;
};

}  // namespace aib::stream
