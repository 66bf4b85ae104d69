// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/align/umeyama.hpp>
#include <aib/cloud/cloud.hpp>
#include <aib/cloud/point_tree.hpp>
#include <aib/core/error.hpp>
#include <aib/core/executor.hpp>
#include <aib/math/rotation.hpp>
#include <aib/math/sim3.hpp>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace aib::align {

/// What an iteration makes small.
enum class icp_metric {
  point,  ///< distances between corresponding points
  plane,  ///< distances along the normals of the reference
};

struct icp_options {
  /// A pair farther apart is none. Several distances are a schedule, run one after another.
  std::vector<double> max_distance = {};
  icp_metric metric = icp_metric::point;
  bool with_scale = false;
  math::sim3 init = {};              ///< ref_from_est to begin with
  std::size_t max_iterations = 100;  ///< for each distance of the schedule
  double relative_change = 1e-9;     ///< of fitness and rmse, below which it has converged
  unsigned threads = 0;              ///< 0: all
  aib::control control = {};         ///< its progress counts iterations
};

struct icp_result {
  math::sim3 transform;  ///< ref_from_est
  double fitness;        ///< share of the estimate that has a corresponding point
  double rmse;           ///< of the distances of corresponding points
  std::size_t n_pairs;
  std::size_t n_iterations;  ///< of the whole schedule
  bool converged;            ///< the last stage stopped before max_iterations
};

/// Iterative closest point: moves the estimate onto the reference from a rough alignment.
///
/// Correspondences are nearest neighbours in double below max_distance. The update is Umeyama's for
/// points, a linearised least-squares step for planes (needs normals of the reference). The same
/// for any number of threads.
///
/// Throws argument_error without a positive max_distance or without normals where they are needed,
/// undefined_error if a cloud has no finite point or no pair is near enough.
/// Source: Besl and McKay, PAMI 1992; Chen and Medioni, IVC 1992; stopping rule as Open3D.
[[nodiscard]] icp_result icp(const cloud::cloud& estimate,
                             const cloud::cloud& reference,
                             const icp_options& options);

namespace detail {

/// Corresponding points, the estimate's as they lie now.
struct icp_pairs {
  std::vector<Eigen::Vector3d> estimate;
  std::vector<Eigen::Vector3d> reference;
  std::vector<Eigen::Vector3d> normal;  ///< of the reference, for planes
  double fitness = 0;
  double rmse = 0;
};

class icp_solver {
 public:
  icp_solver(const cloud::cloud& estimate,
             const cloud::cloud& reference,
             const icp_options& options)
      : options_(options),
        reference_cloud_(reference),
        estimate_(estimate, reference.origin, options.control),
        reference_(reference, reference.origin, options.control),
        tree_(3, reference_, {10}) {
    demand_points(estimate_, estimate);
    demand_points(reference_, reference);
  }

  [[nodiscard]] icp_result run();

 private:
  static constexpr std::size_t none = ~std::size_t{0};

  static void demand_points(const cloud::detail::finite_positions& finite, const cloud::cloud& c) {
    if (!finite.position.empty()) return;
    throw undefined_error(message("align::icp: no finite point in a cloud of ", c.size()));
  }
  [[nodiscard]] std::vector<std::size_t> nearest(std::span<const Eigen::Vector3d> moved,
                                                 double max_distance) const;
  [[nodiscard]] icp_pairs pairs(const math::sim3& now, double max_distance) const;
  [[nodiscard]] math::sim3 step(const icp_pairs& p) const;
  void tell(double share) const;
  [[nodiscard]] math::sim3 plane_step(const icp_pairs& p) const;

  const icp_options& options_;
  const cloud::cloud& reference_cloud_;
  cloud::detail::finite_positions estimate_;
  cloud::detail::finite_positions reference_;
  cloud::detail::point_tree tree_;
};

inline std::vector<std::size_t> icp_solver::nearest(std::span<const Eigen::Vector3d> moved,
                                                    double max_distance) const {
  std::vector<std::size_t> match(moved.size(), none);
  for_each_chunk(moved.size(), 4096, options_.threads, {options_.control.stop},
                 [&](const chunk& c) {
                   for (std::size_t i = c.begin; i < c.end; ++i) {
                     std::size_t index = 0;
                     double squared = 0;
                     tree_.knnSearch(moved[i].data(), 1, &index, &squared);
                     if (squared < max_distance * max_distance) match[i] = index;
                   }
                 });
  return match;
}

inline icp_pairs icp_solver::pairs(const math::sim3& now, double max_distance) const {
  std::vector<Eigen::Vector3d> moved;
  moved.reserve(estimate_.position.size());
  for (const Eigen::Vector3d& p : estimate_.position) moved.push_back(now * p);
  const auto match = nearest(moved, max_distance);
  icp_pairs found;
  double squares = 0;
  for (std::size_t i = 0; i < moved.size(); ++i) {
    if (match[i] == none) continue;
    const Eigen::Vector3d& to = reference_.position[match[i]];
    found.estimate.push_back(moved[i]);
    found.reference.push_back(to);
    if (options_.metric == icp_metric::plane) {
      const std::size_t source = reference_.source[match[i]];
      found.normal.push_back(reference_cloud_.normals[source].cast<double>());
    }
    squares += (moved[i] - to).squaredNorm();
  }
  const auto n = static_cast<double>(found.estimate.size());
  found.fitness = n / static_cast<double>(moved.size());
  found.rmse = n > 0 ? std::sqrt(squares / n) : 0;
  return found;
}

/// Solves for a small turn, shift and (with scale) stretch that bring the estimate onto the planes.
inline math::sim3 icp_solver::plane_step(const icp_pairs& p) const {
  const int unknowns = options_.with_scale ? 7 : 6;
  Eigen::MatrixXd normal_matrix = Eigen::MatrixXd::Zero(unknowns, unknowns);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(unknowns);
  for (std::size_t i = 0; i < p.estimate.size(); ++i) {
    const Eigen::Vector3d& x = p.estimate[i];
    const Eigen::Vector3d& n = p.normal[i];
    const double residual = n.dot(p.reference[i] - x);
    Eigen::VectorXd row(unknowns);
    row.head<3>() = x.cross(n);
    row.segment<3>(3) = n;
    if (options_.with_scale) row[6] = n.dot(x);
    if (!row.allFinite()) continue;
    normal_matrix += row * row.transpose();
    right += row * residual;
  }
  const Eigen::VectorXd u = normal_matrix.ldlt().solve(right);
  if (!u.allFinite()) throw undefined_error("align::icp: the planes do not hold the estimate");
  const Eigen::Vector3d turn = u.head<3>();
  return {options_.with_scale ? 1 + u[6] : 1, math::rotation_from(turn), u.segment<3>(3)};
}

inline math::sim3 icp_solver::step(const icp_pairs& p) const {
  if (options_.metric == icp_metric::plane) return plane_step(p);
  return umeyama(p.estimate, p.reference, {.scale = options_.with_scale});
}

inline void icp_solver::tell(double share) const {
  if (options_.control.progress) options_.control.progress(share);
}

inline icp_result icp_solver::run() {
  const auto most = static_cast<double>(options_.max_distance.size() * options_.max_iterations);
  const Eigen::Vector3d& origin = reference_cloud_.origin;
  const math::sim3 to_local{1, Eigen::Matrix3d::Identity(), -origin};
  math::sim3 now = to_local * options_.init * to_local.inverse();
  icp_result result{};
  for (const double distance : options_.max_distance) {
    icp_pairs p = pairs(now, distance);
    result.converged = false;
    for (std::size_t i = 0; i < options_.max_iterations && !result.converged; ++i) {
      if (p.estimate.empty()) {
        throw undefined_error(
            message("align::icp: no point of the estimate within ", distance, " of the reference"));
      }
      now = step(p) * now;
      icp_pairs next = pairs(now, distance);
      result.converged = std::abs(next.fitness - p.fitness) < options_.relative_change &&
                         std::abs(next.rmse - p.rmse) < options_.relative_change;
      p = std::move(next);
      tell(static_cast<double>(++result.n_iterations) / most);
    }
    result.fitness = p.fitness;
    result.rmse = p.rmse;
    result.n_pairs = p.estimate.size();
  }
  tell(1);
  result.transform = to_local.inverse() * now * to_local;
  return result;
}

inline void check_icp(const cloud::cloud& reference, const icp_options& options) {
  if (options.max_distance.empty()) throw argument_error("align::icp: max_distance expected");
  for (const double d : options.max_distance) {
    if (!(d > 0)) throw argument_error(message("align::icp: max_distance > 0 expected, found ", d));
  }
  if (options.metric == icp_metric::plane && reference.normals.size() != reference.size()) {
    throw argument_error("align::icp: metric plane expects a reference with normals");
  }
}

}  // namespace detail

inline icp_result icp(const cloud::cloud& estimate,
                      const cloud::cloud& reference,
                      const icp_options& options) {
  detail::check_icp(reference, options);
  return detail::icp_solver(estimate, reference, options).run();
}

}  // namespace aib::align
