// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/cloud.hpp>
#include <aib/cloud/distances.hpp>
#include <aib/cloud/positions.hpp>
#include <aib/core/isa.hpp>

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace aib::cloud {

struct compare_options {
  std::vector<double> tau = {};             ///< thresholds of precision, recall and F-score
  std::optional<double> max_distance = {};  ///< none: every distance counts as it is
  maximum_rule rule = maximum_rule::drop;
  unsigned threads = 0;  ///< 0: all
  aib::control control = {};
};

/// Scores at one threshold.
/// Source: Knapitsch et al., "Tanks and Temples", SIGGRAPH 2017, section 4.
struct threshold_scores {
  double tau;
  double precision;  ///< share of the estimate strictly below tau of the reference
  double recall;     ///< share of the reference strictly below tau of the estimate
  double f_score;    ///< harmonic mean of both; 0 where both are 0
};

/// How an estimated cloud differs from a reference. Lengths in the unit of the clouds.
struct comparison {
  double accuracy;      ///< mean distance from the estimate to the reference
  double completeness;  ///< mean distance from the reference to the estimate
  double chamfer;       ///< sum of both
  double chamfer_mean;  ///< half of it
  double f1_distance;   ///< harmonic mean of both, a length; 0 where both are 0
  double accuracy_median;
  double completeness_median;
  double accuracy_rmse;
  double completeness_rmse;
  double hausdorff;                      ///< the larger of both directed maxima
  std::vector<threshold_scores> scores;  ///< one a threshold, in the order asked for
  std::size_t n_estimate;                ///< points that were compared
  std::size_t n_reference;
  std::size_t n_dropped;    ///< points of both clouds that are not finite
  double estimate_beyond;   ///< share of the estimate not below max_distance
  double reference_beyond;  ///< share of the reference not below max_distance
};

/// Distances of the points of a cloud, in memory or not, that know their statistics.
template <class T>
concept distance_statistics = requires(const T& d, std::span<const double> tau) {
  { d.mean() } -> std::convertible_to<double>;
  { d.median() } -> std::convertible_to<double>;
  { d.rmse() } -> std::convertible_to<double>;
  { d.max() } -> std::convertible_to<double>;
  { d.n_finite() } -> std::convertible_to<std::size_t>;
  { d.n_dropped() } -> std::convertible_to<std::size_t>;
  { d.share_beyond() } -> std::convertible_to<double>;
  { d.shares_below(tau) } -> std::convertible_to<std::vector<double>>;
};

namespace detail {

inline double harmonic_mean(double a, double b) { return a + b > 0 ? 2 * a * b / (a + b) : 0; }

}  // namespace detail

inline namespace AIB_ISA {

/// Distances in both directions, each cloud sorted and indexed once.
struct two_way_distances {
  distances to_reference;  ///< of the points of the estimate
  distances to_estimate;   ///< of the points of the reference
};

/// Distances from the estimate to the reference and back.
/// Throws undefined_error if either cloud has no finite point.
[[nodiscard]] inline two_way_distances distances_both_ways(const cloud& estimate,
                                                           const cloud& reference,
                                                           const distance_options& options = {}) {
  detail::check_maximum(options);
  const finite_points e(estimate, reference.origin);
  const finite_points r(reference, reference.origin);
  detail::demand_points("cloud::compare", "estimated", e);
  detail::demand_points("cloud::compare", "reference", r);
  const search::curve order = search::common_curve(e.points(), r.points());
  const search::box_tree e_tree(e.points(), order, options.threads, options.control);
  const search::box_tree r_tree(r.points(), order, options.threads, options.control);
  const auto search = detail::search_options(options);
  return {distances(detail::roots_in_place(e, search::nearest_squared(e_tree, r_tree, search)),
                    options),
          distances(detail::roots_in_place(r, search::nearest_squared(r_tree, e_tree, search)),
                    options)};
}

/// Precision, recall and F-score at thresholds, in their order: with many of them, a curve.
template <distance_statistics Distances>
[[nodiscard]] std::vector<threshold_scores> scores_at(const Distances& to_reference,
                                                      const Distances& to_estimate,
                                                      std::span<const double> tau) {
  const auto precision = to_reference.shares_below(tau);
  const auto recall = to_estimate.shares_below(tau);
  std::vector<threshold_scores> scores;
  for (std::size_t i = 0; i < tau.size(); ++i) {
    scores.push_back(
        {tau[i], precision[i], recall[i], detail::harmonic_mean(precision[i], recall[i])});
  }
  return scores;
}

/// The scores of distances in both directions, wherever they come from.
template <distance_statistics Distances>
[[nodiscard]] comparison score(const Distances& to_reference,
                               const Distances& to_estimate,
                               std::span<const double> tau = {}) {
  const double accuracy = to_reference.mean();
  const double completeness = to_estimate.mean();
  comparison c{.accuracy = accuracy,
               .completeness = completeness,
               .chamfer = accuracy + completeness,
               .chamfer_mean = (accuracy + completeness) / 2,
               .f1_distance = detail::harmonic_mean(accuracy, completeness),
               .accuracy_median = to_reference.median(),
               .completeness_median = to_estimate.median(),
               .accuracy_rmse = to_reference.rmse(),
               .completeness_rmse = to_estimate.rmse(),
               .hausdorff = std::max(to_reference.max(), to_estimate.max()),
               .scores = {},
               .n_estimate = to_reference.n_finite(),
               .n_reference = to_estimate.n_finite(),
               .n_dropped = to_reference.n_dropped() + to_estimate.n_dropped(),
               .estimate_beyond = to_reference.share_beyond(),
               .reference_beyond = to_estimate.share_beyond()};
  c.scores = scores_at(to_reference, to_estimate, tau);
  return c;
}

/// Compares an estimated cloud with a reference: every metric of point clouds from one search.
///
/// Nothing is aligned. A reference sampled from a surface puts a floor under accuracy, see
/// sample::mesh; mesh::compare has none.
/// Throws undefined_error if either cloud has no finite point, argument_error if a tau is above
/// max_distance.
[[nodiscard]] inline comparison compare(const cloud& estimate,
                                        const cloud& reference,
                                        const compare_options& options = {}) {
  const auto both = distances_both_ways(estimate, reference,
                                        {.max_distance = options.max_distance,
                                         .rule = options.rule,
                                         .threads = options.threads,
                                         .control = options.control});
  return score(both.to_reference, both.to_estimate, options.tau);
}

}  // namespace AIB_ISA
}  // namespace aib::cloud
