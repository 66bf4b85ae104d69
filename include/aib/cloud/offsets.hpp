// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/cloud.hpp>
#include <aib/cloud/neighbours.hpp>
#include <aib/cloud/positions.hpp>
#include <aib/core/error.hpp>
#include <aib/core/executor.hpp>
#include <aib/stats/quantiles.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace aib::cloud {

/// Signed distances, one a point of a cloud, with their statistics: which way something has moved.
///
/// Statistics throw undefined_error where no value is finite.
class offsets {
 public:
  explicit offsets(std::vector<float> values) : values_(std::move(values)) {
    for (const float v : values_) {
      if (!std::isfinite(v)) continue;
      ++n_finite_;
      sum_ += v;
    }
    for (const float v : values_) {
      if (!std::isfinite(v)) continue;
      squares_ += (v - sum_ / n()) * (v - sum_ / n());
      absolute_ += std::abs(v);
    }
  }

  /// One value a point, in its order; NaN for a point that has none.
  [[nodiscard]] std::span<const float> values() const { return values_; }
  [[nodiscard]] std::size_t size() const { return values_.size(); }
  [[nodiscard]] float operator[](std::size_t i) const { return values_[i]; }
  [[nodiscard]] std::size_t n_finite() const { return n_finite_; }
  [[nodiscard]] std::size_t n_dropped() const { return size() - n_finite_; }

  [[nodiscard]] double mean() const { return demand_values(), sum_ / n(); }
  [[nodiscard]] double mean_absolute() const { return demand_values(), absolute_ / n(); }
  /// Standard deviation about the mean, over all values (not n - 1).
  [[nodiscard]] double deviation() const { return demand_values(), std::sqrt(squares_ / n()); }
  [[nodiscard]] double median() const { return quantile(0.5); }
  /// q in [0, 1], interpolated linearly.
  [[nodiscard]] double quantile(double q) const {
    demand_values();
    std::vector<float> finite;
    finite.reserve(n_finite_);
    std::copy_if(values_.begin(), values_.end(), std::back_inserter(finite),
                 [](float v) { return std::isfinite(v); });
    return stats::quantile_in_place<float>(finite, q);
  }

 private:
  [[nodiscard]] double n() const { return static_cast<double>(n_finite_); }
  void demand_values() const {
    if (n_finite_ > 0) return;
    throw undefined_error(message("cloud::offsets: no finite value of ", size()));
  }

  std::vector<float> values_;
  std::size_t n_finite_ = 0;
  double sum_ = 0;
  double squares_ = 0;
  double absolute_ = 0;
};

/// How far each point lies before (positive) or behind the reference: its offset from the nearest
/// point of the reference along that point's normal.
///
/// Small where both surfaces agree but one is shifted along itself, so not a distance between
/// clouds. Throws argument_error if the reference has no normals, undefined_error if it has no
/// finite point.
[[nodiscard]] inline offsets offsets_along_normals(const cloud& from,
                                                   const cloud& reference,
                                                   unsigned threads = 0,
                                                   const control& control = {}) {
  if (reference.normals.size() != reference.size()) {
    throw argument_error("cloud::offsets_along_normals: a reference with normals expected");
  }
  const neighbours search(reference, control);
  if (search.size() == 0) {
    throw undefined_error(
        message("cloud::offsets_along_normals: no finite point in the reference (",
                reference.size(), " points)"));
  }
  std::vector<float> values(from.size(), std::numeric_limits<float>::quiet_NaN());
  for_each_chunk(from.size(), 1024, threads, control, [&](const chunk& c) {
    for (std::size_t i = c.begin; i < c.end; ++i) {
      if (!is_finite(from.points[i])) continue;
      const std::size_t nearest = search.nearest(from.position(i), 1).front().index;
      const Eigen::Vector3d apart = from.position(i) - reference.position(nearest);
      values[i] = static_cast<float>(apart.dot(reference.normals[nearest].cast<double>()));
    }
  });
  return offsets(std::move(values));
}

}  // namespace aib::cloud
