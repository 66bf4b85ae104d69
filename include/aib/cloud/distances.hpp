// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/cloud.hpp>
#include <aib/cloud/positions.hpp>
#include <aib/core/error.hpp>
#include <aib/core/executor.hpp>
#include <aib/core/isa.hpp>
#include <aib/search/nearest.hpp>
#include <aib/stats/histogram.hpp>
#include <aib/stats/quantiles.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace aib::cloud {

/// What becomes of a distance that is not below the maximum.
enum class maximum_rule {
  drop,   ///< left out of all statistics but shares (DTU)
  clamp,  ///< counts as the maximum (CloudCompare)
};

struct distance_options {
  std::optional<double> max_distance = {};  ///< none: every distance counts as it is
  maximum_rule rule = maximum_rule::drop;
  unsigned threads = 0;  ///< 0: all
  aib::control control = {};
};

inline namespace AIB_ISA {

/// Distances from each point of a cloud to another thing, with their statistics.
///
/// Statistics throw undefined_error where no distance counts.
class distances {
 public:
  /// Distance from each point to its nearest neighbour, Euclidean, exact in float: both clouds are
  /// brought to one origin in double first. Points that are not finite (see is_finite) are dropped.
  ///
  /// Throws undefined_error if either cloud has no finite point, argument_error if max_distance is
  /// not positive.
  distances(const cloud& from, const cloud& to, const distance_options& options = {});

  /// Distances that are known: NaN for a point that had none, any value >= max_distance where it is
  /// that far or farther.
  explicit distances(std::vector<float> values, const distance_options& options = {});

  /// One value a point of the cloud, in its order: NaN for a point that is not finite; beyond the
  /// maximum +infinity (drop) or the maximum (clamp).
  [[nodiscard]] std::span<const float> values() const { return values_; }
  [[nodiscard]] std::size_t size() const { return values_.size(); }
  [[nodiscard]] float operator[](std::size_t i) const { return values_[i]; }

  [[nodiscard]] std::size_t n_dropped() const { return n_dropped_; }  ///< not finite
  [[nodiscard]] std::size_t n_beyond() const { return n_beyond_; }    ///< not below max_distance
  [[nodiscard]] std::size_t n_finite() const { return size() - n_dropped_; }
  [[nodiscard]] double share_beyond() const;  ///< of the finite points

  [[nodiscard]] double mean() const;
  [[nodiscard]] double rmse() const;
  [[nodiscard]] double max() const;
  [[nodiscard]] double median() const { return quantile(0.5); }
  /// q in [0, 1], interpolated linearly.
  [[nodiscard]] double quantile(double q) const;

  /// Counts of the distances in equal bins on [0, high). Points beyond the maximum count as above
  /// it with `drop`, as the maximum with `clamp`; those that are not finite are left out.
  [[nodiscard]] stats::histogram histogram(double high, std::size_t bins) const;

  /// Share of the finite points whose distance is strictly below tau. Points beyond the maximum are
  /// in the denominator. Throws argument_error if tau is above the maximum.
  [[nodiscard]] double share_below(double tau) const;

  /// The same for several thresholds, in their order, from one pass.
  [[nodiscard]] std::vector<double> shares_below(std::span<const double> tau) const;

 private:
  void apply_maximum();
  void summarize();
  [[nodiscard]] std::size_t n_counted() const;
  void demand_values(const char* what) const;

  std::vector<float> values_;
  distance_options options_;
  std::size_t n_dropped_ = 0;
  std::size_t n_beyond_ = 0;
  double sum_ = 0;
  double sum_of_squares_ = 0;
  double max_ = 0;
};

}  // namespace AIB_ISA

namespace detail {

inline constexpr std::size_t value_chunk = 1 << 16;

inline void demand_points(const char* function, const char* which, const finite_points& p) {
  if (p.points().empty()) {
    throw undefined_error(message(function, ": no finite point in the ", which, " cloud (",
                                  p.n_given(), " points, ", p.n_dropped(), " not finite)"));
  }
}

inline void check_maximum(const distance_options& options) {
  if (options.max_distance && !(*options.max_distance > 0)) {
    throw argument_error(
        message("cloud::distances: max_distance > 0 expected, found ", *options.max_distance));
  }
}

inline void check_tau(double tau, const distance_options& options) {
  if (!options.max_distance || tau <= *options.max_distance) return;
  throw argument_error(
      message("cloud::distances: tau ", tau, " is above max_distance ", *options.max_distance));
}

/// Whether distances beyond the maximum are left out.
inline bool drops(const distance_options& options) {
  return options.max_distance && options.rule == maximum_rule::drop;
}

/// Makes of distances not below the maximum what the rule says; returns how many there are.
inline std::size_t cut_at_maximum(std::span<float> values, const distance_options& options) {
  if (!options.max_distance) return 0;
  const float beyond = drops(options) ? std::numeric_limits<float>::infinity()
                                      : static_cast<float>(*options.max_distance);
  std::size_t n = 0;
  for (float& value : values) {
    if (static_cast<double>(value) >= *options.max_distance) {
      value = beyond;
      ++n;
    }
  }
  return n;
}

/// Sums over a chunk of distances; those of chunks are added in order.
struct distance_sums {
  std::size_t dropped = 0;
  double sum = 0, squares = 0, max = 0;

  distance_sums& operator+=(const distance_sums& other) {
    dropped += other.dropped;
    sum += other.sum;
    squares += other.squares;
    max = std::max(max, other.max);
    return *this;
  }
};

inline distance_sums sums_of(std::span<const float> values, const distance_options& options) {
  const bool skip_infinite = drops(options);
  distance_sums s;
  for (const float value : values) {
    const double d = value;
    if (std::isnan(d)) ++s.dropped;
    if (std::isnan(d) || (skip_infinite && std::isinf(d))) continue;
    s.sum += d;
    s.squares += d * d;
    s.max = std::max(s.max, d);
  }
  return s;
}

/// A float not below the square of the largest distance that counts.
inline float squared_bound(const distance_options& options) {
  if (!options.max_distance) return std::numeric_limits<float>::infinity();
  const double reach = *options.max_distance * (1 + 1e-6);
  const double largest = std::numeric_limits<float>::max();
  return static_cast<float>(std::min(reach * reach, largest));
}

/// Distances in the order of the cloud, of squares in the order of its finite points.
inline std::vector<float> roots_in_place(const finite_points& from, std::vector<float> squared) {
  for (float& d : squared) d = std::sqrt(d);
  if (from.n_dropped() == 0) return squared;
  std::vector<float> values(from.n_given(), std::numeric_limits<float>::quiet_NaN());
  for (std::size_t i = 0; i < squared.size(); ++i) values[from.source_index(i)] = squared[i];
  return values;
}

inline search::nearest_options search_options(const distance_options& options) {
  return {.squared_bound = squared_bound(options),
          .threads = options.threads,
          .control = options.control};
}

}  // namespace detail

inline namespace AIB_ISA {

inline distances::distances(const cloud& from, const cloud& to, const distance_options& options)
    : options_(options) {
  detail::check_maximum(options);
  const finite_points a(from, to.origin);
  const finite_points b(to, to.origin);
  detail::demand_points("cloud::distances", "first", a);
  detail::demand_points("cloud::distances", "second", b);
  const search::curve order = search::common_curve(a.points(), b.points());
  const search::box_tree queries(a.points(), order, options.threads, options.control);
  const search::box_tree targets(b.points(), order, options.threads, options.control);
  values_ = detail::roots_in_place(
      a, search::nearest_squared(queries, targets, detail::search_options(options)));
  apply_maximum();
  summarize();
}

inline distances::distances(std::vector<float> values, const distance_options& options)
    : values_(std::move(values)), options_(options) {
  detail::check_maximum(options);
  apply_maximum();
  summarize();
}

inline void distances::apply_maximum() { n_beyond_ = detail::cut_at_maximum(values_, options_); }

inline void distances::summarize() {
  const auto sum_chunk = [&](const chunk& c) {
    return detail::sums_of(values().subspan(c.begin, c.end - c.begin), options_);
  };
  const auto total = reduce_chunks(values_.size(), detail::value_chunk, options_.threads, {},
                                   detail::distance_sums{}, sum_chunk,
                                   [](auto a, const auto& b) { return a += b; });
  n_dropped_ = total.dropped;
  sum_ = total.sum;
  sum_of_squares_ = total.squares;
  max_ = total.max;
}

inline std::size_t distances::n_counted() const {
  const bool drop = options_.max_distance && options_.rule == maximum_rule::drop;
  return n_finite() - (drop ? n_beyond_ : 0);
}

inline void distances::demand_values(const char* what) const {
  if (n_counted() > 0) return;
  throw undefined_error(message("cloud::distances: no distance to take the ", what, " of (", size(),
                                " points, ", n_dropped_, " not finite, ", n_beyond_,
                                " beyond max_distance)"));
}

inline double distances::share_beyond() const {
  if (n_finite() == 0) demand_values("share");
  return static_cast<double>(n_beyond_) / static_cast<double>(n_finite());
}

inline double distances::mean() const {
  demand_values("mean");
  return sum_ / static_cast<double>(n_counted());
}

inline double distances::rmse() const {
  demand_values("root mean square");
  return std::sqrt(sum_of_squares_ / static_cast<double>(n_counted()));
}

inline double distances::max() const {
  demand_values("maximum");
  return max_;
}

inline double distances::quantile(double q) const {
  demand_values("quantile");
  std::vector<float> counted;
  counted.reserve(n_counted());
  const bool all = n_counted() == n_finite();
  std::copy_if(values_.begin(), values_.end(), std::back_inserter(counted),
               [&](float d) { return !std::isnan(d) && (all || !std::isinf(d)); });
  return stats::quantile_in_place<float>(counted, q);
}

inline stats::histogram distances::histogram(double high, std::size_t bins) const {
  stats::histogram counts(0, high, bins);
  for (const float d : values_) {
    if (!std::isnan(d)) counts.add(d);
  }
  return counts;
}

inline std::vector<double> distances::shares_below(std::span<const double> tau) const {
  if (n_finite() == 0) demand_values("share");
  for (const double t : tau) detail::check_tau(t, options_);
  std::vector<double> ascending(tau.begin(), tau.end());
  std::sort(ascending.begin(), ascending.end());
  const auto first_above = [&](double d) {
    const auto above = std::upper_bound(ascending.begin(), ascending.end(), d);
    return static_cast<std::size_t>(above - ascending.begin());
  };
  using counts = std::vector<std::size_t>;  // of values whose first threshold above is this one
  const auto count_chunk = [&](const chunk& c) {
    counts n(tau.size() + 1);
    for (std::size_t i = c.begin; i < c.end; ++i) {
      if (!std::isnan(values_[i])) ++n[first_above(values_[i])];
    }
    return n;
  };
  const auto add = [](counts a, const counts& b) {
    for (std::size_t k = 0; k < a.size(); ++k) a[k] += b[k];
    return a;
  };
  counts below = reduce_chunks(values_.size(), detail::value_chunk, options_.threads, {},
                               counts(tau.size() + 1), count_chunk, add);
  for (std::size_t k = 1; k < below.size(); ++k) below[k] += below[k - 1];
  std::vector<double> share;
  for (const double t : tau) {
    const auto place = std::lower_bound(ascending.begin(), ascending.end(), t) - ascending.begin();
    share.push_back(static_cast<double>(below[static_cast<std::size_t>(place)]) /
                    static_cast<double>(n_finite()));
  }
  return share;
}

inline double distances::share_below(double tau) const {
  return shares_below(std::span(&tau, 1)).front();
}

}  // namespace AIB_ISA
}  // namespace aib::cloud
