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
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace aib::cloud {

struct normal_options {
  std::size_t neighbours = 30;  ///< the point itself included
  unsigned threads = 0;         ///< 0: all
  aib::control control = {};
};

/// The cloud with a normal for each point: the direction in which its nearest neighbours spread
/// least. The sign is arbitrary. A point that is not finite, or has fewer than two others, gets
/// (0, 0, 1).
/// Source: Hoppe et al., SIGGRAPH 1992, section 3.2.
[[nodiscard]] inline cloud with_normals(const cloud& c, const normal_options& options = {}) {
  const neighbours search(c, options.control);
  cloud result = c;
  result.normals.assign(c.size(), Eigen::Vector3f(0, 0, 1));
  for_each_chunk(c.size(), 1024, options.threads, options.control, [&](const chunk& part) {
    for (std::size_t i = part.begin; i < part.end; ++i) {
      if (!is_finite(c.points[i])) continue;
      const auto found = search.nearest(c.position(i), options.neighbours);
      if (found.size() < 3) continue;
      Eigen::Vector3d mean(0, 0, 0);
      for (const neighbour& n : found) mean += c.points[n.index].cast<double>();
      mean /= static_cast<double>(found.size());
      Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
      for (const neighbour& n : found) {
        const Eigen::Vector3d d = c.points[n.index].cast<double>() - mean;
        covariance += d * d.transpose();
      }
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
      const Eigen::Vector3d least = solver.eigenvectors().col(0);
      result.normals[i] = least.cast<float>();
    }
  });
  return result;
}

/// Agreement of normals: |cosine| of the angle to the normal of the nearest point of the other
/// cloud.
struct normal_consistency_result {
  double estimate_mean;  ///< over the estimate ("NC1" of CUT3R)
  double estimate_median;
  double reference_mean;  ///< over the reference ("NC2")
  double reference_median;
};

namespace detail {

inline std::vector<double> normal_cosines(const cloud& from,
                                          const cloud& to,
                                          unsigned threads,
                                          const control& control) {
  const neighbours search(to, control);
  std::vector<double> cosine(from.size(), std::numeric_limits<double>::quiet_NaN());
  for_each_chunk(from.size(), 1024, threads, control, [&](const chunk& part) {
    for (std::size_t i = part.begin; i < part.end; ++i) {
      if (!is_finite(from.points[i])) continue;
      const auto found = search.nearest(from.position(i), 1);
      if (found.empty()) continue;
      const Eigen::Vector3d a = from.normals[i].cast<double>();
      const Eigen::Vector3d b = to.normals[found[0].index].cast<double>();
      cosine[i] = std::abs(a.dot(b));
    }
  });
  std::erase_if(cosine, [](double c) { return std::isnan(c); });
  if (cosine.empty()) throw undefined_error("cloud::normal_consistency: no pair of finite points");
  return cosine;
}

inline double mean_of(std::span<const double> values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

}  // namespace detail

/// How well the normals of two clouds agree, over each cloud. Signs play no part.
/// Throws argument_error if a cloud has no normals, undefined_error if one has no finite point.
/// Source: Wang et al., "Continuous 3D perception model with persistent state" (CUT3R), CVPR 2025.
[[nodiscard]] inline normal_consistency_result normal_consistency(const cloud& estimate,
                                                                  const cloud& reference,
                                                                  unsigned threads = 0,
                                                                  const control& control = {}) {
  for (const cloud* c : {&estimate, &reference}) {
    if (c->normals.size() != c->size()) {
      throw argument_error("cloud::normal_consistency: clouds with normals expected");
    }
  }
  const auto e = detail::normal_cosines(estimate, reference, threads, control);
  const auto r = detail::normal_cosines(reference, estimate, threads, control);
  const std::span<const double> es(e), rs(r);
  return {detail::mean_of(es), stats::median(es), detail::mean_of(rs), stats::median(rs)};
}

}  // namespace aib::cloud
