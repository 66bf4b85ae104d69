// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace aib::stats {

/// What a quantile between two values is.
enum class quantile_rule {
  linear,    ///< interpolated, numpy's default
  lower,     ///< the smaller value (torch.median)
  midpoint,  ///< their mean
};

/// Quantile of unsorted values, q in [0, 1]. Reorders `values`; takes linear time.
/// Throws undefined_error if there is no value, argument_error if q is outside [0, 1].
template <class Scalar>
double quantile_in_place(std::span<Scalar> values,
                         double q,
                         quantile_rule rule = quantile_rule::linear) {
  if (values.empty()) throw undefined_error("stats::quantile: no values");
  if (!(q >= 0 && q <= 1))
    throw argument_error(message("stats::quantile: q in [0, 1] expected, found ", q));
  const double place = q * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(below);
  std::nth_element(values.begin(), nth, values.end());
  const double low = static_cast<double>(*nth);
  const double share = place - static_cast<double>(below);
  if (share == 0 || rule == quantile_rule::lower) return low;
  const double high = static_cast<double>(*std::min_element(nth + 1, values.end()));
  if (low == high) return low;  // of two infinities too
  return rule == quantile_rule::midpoint ? (low + high) / 2 : low + (high - low) * share;
}

/// As quantile_in_place, on a copy.
template <class Scalar>
double quantile(std::span<const Scalar> values,
                double q,
                quantile_rule rule = quantile_rule::linear) {
  std::vector<Scalar> copy(values.begin(), values.end());
  return quantile_in_place<Scalar>(copy, q, rule);
}

/// The middle value, or the mean of the two middle values.
template <class Scalar>
double median(std::span<const Scalar> values) {
  return quantile(values, 0.5);
}

}  // namespace aib::stats
