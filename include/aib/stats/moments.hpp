// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace aib::stats {

/// Count, mean, variance and range of a stream of numbers, mergeable. Deviations are summed about a
/// running mean, so that a small spread about a large mean is kept. Source: Chan, Golub, LeVeque,
/// "Updating formulae and a pairwise algorithm for computing sample variances", 1979.
class moments {
 public:
  /// The moments of values that were summed elsewhere: `squares` is the sum of squared deviations
  /// from `mean`. The range is not known and stays empty.
  [[nodiscard]] static moments from(std::uint64_t count, double mean, double squares) {
    moments m;
    m.count_ = count;
    m.mean_ = mean;
    m.squares_ = squares;
    return m;
  }

  void add(double value) {
    ++count_;
    const double delta = value - mean_;
    mean_ += delta / static_cast<double>(count_);
    squares_ += delta * (value - mean_);
    min_ = std::min(min_, value);
    max_ = std::max(max_, value);
  }

  moments& operator+=(const moments& other) {
    if (other.count_ == 0) return *this;
    if (count_ == 0) return *this = other;
    const auto n = static_cast<double>(count_);
    const auto m = static_cast<double>(other.count_);
    const double delta = other.mean_ - mean_;
    mean_ += delta * (m / (n + m));
    squares_ += other.squares_ + delta * delta * (n * m / (n + m));
    count_ += other.count_;
    min_ = std::min(min_, other.min_);
    max_ = std::max(max_, other.max_);
    return *this;
  }

  [[nodiscard]] std::uint64_t count() const { return count_; }
  [[nodiscard]] double mean() const { return mean_; }  ///< 0 of nothing
  [[nodiscard]] double sum() const { return mean_ * static_cast<double>(count_); }
  [[nodiscard]] double variance() const {  ///< population (ddof 0)
    return count_ ? squares_ / static_cast<double>(count_) : 0;
  }
  [[nodiscard]] double deviation() const { return std::sqrt(variance()); }  ///< population
  [[nodiscard]] double mean_square() const { return variance() + mean_ * mean_; }
  [[nodiscard]] double min() const { return min_; }  ///< +inf of nothing
  [[nodiscard]] double max() const { return max_; }  ///< -inf of nothing

 private:
  std::uint64_t count_ = 0;
  double mean_ = 0;
  double squares_ = 0;
  double min_ = std::numeric_limits<double>::infinity();
  double max_ = -std::numeric_limits<double>::infinity();
};

}  // namespace aib::stats
