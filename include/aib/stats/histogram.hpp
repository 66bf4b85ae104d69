// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace aib::stats {

/// Counts of values in equal bins on [low, high), mergeable. Values outside are counted, not
/// dropped.
class histogram {
 public:
  /// Throws argument_error unless low < high and bins > 0.
  histogram(double low, double high, std::size_t bins) : low_(low), high_(high), counts_(bins) {
    if (!(low < high) || bins == 0) {
      throw argument_error(message("stats::histogram: low < high and bins > 0 expected, found ",
                                   low, ", ", high, ", ", bins));
    }
  }

  /// A NaN counts as above.
  void add(double value) {
    if (value < low_) {
      ++below_;
    } else if (value < high_) {
      const double place = (value - low_) / (high_ - low_) * static_cast<double>(counts_.size());
      ++counts_[std::min(static_cast<std::size_t>(place), counts_.size() - 1)];
    } else {
      ++above_;
    }
  }

  /// Throws argument_error if the bins differ.
  histogram& operator+=(const histogram& other) {
    if (other.low_ != low_ || other.high_ != high_ || other.counts_.size() != counts_.size()) {
      throw argument_error("stats::histogram: the bins of merged histograms differ");
    }
    for (std::size_t i = 0; i < counts_.size(); ++i) counts_[i] += other.counts_[i];
    below_ += other.below_;
    above_ += other.above_;
    return *this;
  }

  [[nodiscard]] const std::vector<std::uint64_t>& counts() const { return counts_; }
  [[nodiscard]] std::uint64_t below() const { return below_; }
  [[nodiscard]] std::uint64_t above() const { return above_; }
  [[nodiscard]] std::uint64_t total() const {
    std::uint64_t n = below_ + above_;
    for (const std::uint64_t c : counts_) n += c;
    return n;
  }
  /// Lower edge of bin i; edge(bins) is the upper end.
  [[nodiscard]] double edge(std::size_t i) const {
    return low_ + (high_ - low_) * static_cast<double>(i) / static_cast<double>(counts_.size());
  }

 private:
  double low_, high_;
  std::vector<std::uint64_t> counts_;
  std::uint64_t below_ = 0;
  std::uint64_t above_ = 0;
};

}  // namespace aib::stats
