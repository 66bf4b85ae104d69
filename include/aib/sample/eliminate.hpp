// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/cloud.hpp>
#include <aib/cloud/neighbours.hpp>
#include <aib/cloud/select.hpp>
#include <aib/core/error.hpp>
#include <aib/core/executor.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <queue>
#include <utility>
#include <vector>

namespace aib::sample {

struct eliminate_options {
  std::size_t n = 0;     ///< points that stay
  double area = 0;       ///< of the surface that the points lie on, square units
  unsigned threads = 0;  ///< 0: all
  aib::control control = {};
};

namespace detail {

/// Points and how strongly their neighbours crowd them.
class crowd {
 public:
  crowd(const cloud::cloud& points, const eliminate_options& options)
      : points_(points),
        control_(options.control),
        search_(points, options.control),
        reach_(2 * std::sqrt(options.area /
                             (2 * std::numbers::sqrt3 * static_cast<double>(options.n)))),
        weight_(points.size()),
        gone_(points.size()) {
    for_each_chunk(points.size(), 1024, options.threads, control_, [&](const chunk& c) {
      for (std::size_t i = c.begin; i < c.end; ++i) {
        for (const std::size_t j : neighbours_of(i)) weight_[i] += pressure(i, j);
      }
    });
  }

  /// Takes the most crowded points away until n are left.
  [[nodiscard]] std::vector<std::size_t> reduced_to(std::size_t n) {
    using entry = std::pair<double, std::size_t>;
    std::priority_queue<entry> queue;
    for (std::size_t i = 0; i < weight_.size(); ++i) queue.emplace(weight_[i], i);
    for (std::size_t left = weight_.size(); left > n;) {
      demand_go(control_);
      const auto [weight, i] = queue.top();
      queue.pop();
      if (gone_[i] || weight != weight_[i]) continue;  // has been put in again with less
      gone_[i] = true;
      --left;
      for (const std::size_t j : neighbours_of(i)) {
        if (gone_[j]) continue;
        weight_[j] -= pressure(j, i);
        queue.emplace(weight_[j], j);
      }
    }
    std::vector<std::size_t> kept;
    for (std::size_t i = 0; i < gone_.size(); ++i) {
      if (!gone_[i]) kept.push_back(i);
    }
    return kept;
  }

 private:
  /// Ascending, so that sums do not depend on the tree.
  [[nodiscard]] std::vector<std::size_t> neighbours_of(std::size_t i) const {
    std::vector<std::size_t> near;
    search_.for_each_within(points_.position(i), reach_, [&](std::size_t j) {
      if (j != i) near.push_back(j);
    });
    std::sort(near.begin(), near.end());
    return near;
  }

  /// Yuksel, equation 2, with alpha = 8.
  [[nodiscard]] double pressure(std::size_t i, std::size_t j) const {
    const double d = (points_.position(i) - points_.position(j)).norm();
    return std::pow(std::max(0.0, 1 - d / reach_), 8);
  }

  const cloud::cloud& points_;
  const control& control_;
  cloud::neighbours search_;
  double reach_;
  std::vector<double> weight_;
  std::vector<char> gone_;
};

}  // namespace detail

/// n of many points on a surface, evenly spread: the most crowded goes first, again and again
/// (a Poisson-disk sample). In the order of the cloud; all where there are not more than n.
///
/// points   finite; five times n or more give a good spread
///
/// Throws argument_error unless n and area are positive.
/// Source: Yuksel, "Sample elimination for generating Poisson disk sample sets", CGF 2015.
[[nodiscard]] inline cloud::cloud eliminate(const cloud::cloud& points,
                                            const eliminate_options& options) {
  if (options.n == 0 || !(options.area > 0)) {
    throw argument_error(message("sample::eliminate: n and area > 0 expected, found ", options.n,
                                 " and ", options.area));
  }
  if (points.size() <= options.n) return points;
  return cloud::select(points, detail::crowd(points, options).reduced_to(options.n));
}

}  // namespace aib::sample
