// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/align/spread.hpp>
#include <aib/core/concepts.hpp>
#include <aib/core/error.hpp>
#include <aib/math/sim3.hpp>

#include <Eigen/Core>
#include <Eigen/LU>
#include <Eigen/SVD>

#include <cstddef>
#include <limits>
#include <ranges>
#include <span>
#include <string_view>
#include <vector>

namespace aib::align {

/// When points are too close to a line to tell a rotation.
enum class rank_rule {
  relative,  ///< second singular value of either side's positions below 1e-10 of the first
  evo,       ///< fewer than two singular values of the covariance above 2.2e-16, whatever the unit
};

/// A second singular value of this share of the first is refused.
inline constexpr double refused_ratio = 1e-10;

/// A second singular value of this share of the first is worth a warning.
inline constexpr double doubted_ratio = 1e-2;

struct umeyama_options {
  bool scale = true;  ///< false: rigid, scale 1
  rank_rule convention = rank_rule::relative;
};

namespace detail {

/// The proper rotation R that maximises tr(R^T matrix).
/// Source: Umeyama, "Least-squares estimation of transformation parameters between two point
/// patterns", PAMI 1991, Eq. (40)-(43); Markley 1988.
struct best_rotation {
  Eigen::Matrix3d rotation;
  Eigen::Vector3d signed_singular_values;

  explicit best_rotation(const Eigen::Matrix3d& matrix) {
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Vector3d sign(1, 1, 1);
    if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) sign[2] = -1;
    rotation = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
    signed_singular_values = svd.singularValues().cwiseProduct(sign);
  }
};

/// Two sets of points about their means: covariance 1/n sum (y - my)(x - mx)^T, variance of x.
struct paired_moments {
  Eigen::Vector3d estimate_mean = Eigen::Vector3d::Zero(), reference_mean = estimate_mean;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double estimate_variance = 0;

  paired_moments(std::span<const Eigen::Vector3d> estimate,
                 std::span<const Eigen::Vector3d> reference) {
    const auto n = static_cast<double>(estimate.size());
    for (const Eigen::Vector3d& x : estimate) estimate_mean += x / n;
    for (const Eigen::Vector3d& y : reference) reference_mean += y / n;
    for (std::size_t i = 0; i < estimate.size(); ++i) {
      const Eigen::Vector3d x = estimate[i] - estimate_mean, y = reference[i] - reference_mean;
      covariance += y * x.transpose() / n;
      estimate_variance += x.squaredNorm() / n;
    }
  }

  /// The transform with this rotation and scale that moves mean to mean.
  [[nodiscard]] math::sim3 centred(double scale, const Eigen::Matrix3d& rotation) const {
    return {scale, rotation, reference_mean - scale * (rotation * estimate_mean)};
  }
};

inline void check_pairs(std::string_view who, std::size_t n_estimate, std::size_t n_reference) {
  if (n_estimate != n_reference) {
    throw argument_error(message(who, ": as many estimated as reference points expected, found ",
                                 n_estimate, " and ", n_reference));
  }
  if (n_estimate == 0) throw undefined_error(message(who, ": no points"));
}

inline void refuse_a_line(std::string_view who, std::string_view side, const spread& s) {
  if (s.ratio() >= refused_ratio) return;
  const Eigen::Vector3d axis = s.axes.col(0);
  if (!(s.singular_values[0] > s.rounding))
    throw undefined_error(message(who, ": the positions of the ", side, " are all in one place"));
  throw undefined_error(message(who, ": the positions of the ", side,
                                " lie on a line: the turn about ", direction_text(axis),
                                " is free"));
}

inline void refuse_as_evo(const Eigen::Matrix3d& covariance) {
  const Eigen::Vector3d d = Eigen::JacobiSVD<Eigen::Matrix3d>(covariance).singularValues();
  if (d[1] > std::numeric_limits<double>::epsilon()) return;
  throw undefined_error(message("umeyama: degenerate covariance rank, singular values ", d[0], ", ",
                                d[1], ", ", d[2]));
}

}  // namespace detail

/// The similarity ref_from_est that minimises sum |ref - (s R est + t)|^2 over paired points.
///
/// estimate, reference   n x 3 each, any units
///
/// The rotation is proper also for mirrored points. Throws argument_error if the lengths differ or
/// a point is not finite, undefined_error if the positions of a side lie on a line (see rank_rule).
/// Source: Umeyama, PAMI 1991, Eq. (40)-(43).
inline math::sim3 umeyama(std::span<const Eigen::Vector3d> estimate,
                          std::span<const Eigen::Vector3d> reference,
                          const umeyama_options& options = {}) {
  detail::check_pairs("umeyama", estimate.size(), reference.size());
  const spread estimate_spread = spread_of(estimate), reference_spread = spread_of(reference);
  const detail::paired_moments m(estimate, reference);
  if (options.convention == rank_rule::evo) {
    detail::refuse_as_evo(m.covariance);
  } else {
    detail::refuse_a_line("umeyama", "estimate", estimate_spread);
    detail::refuse_a_line("umeyama", "reference", reference_spread);
  }
  const detail::best_rotation best(m.covariance);
  const double scale =
      options.scale ? best.signed_singular_values.sum() / m.estimate_variance : 1.0;
  return m.centred(scale, best.rotation);
}

/// As above, from any ranges of points.
template <point_range Estimate, point_range Reference>
math::sim3 umeyama(const Estimate& estimate,
                   const Reference& reference,
                   const umeyama_options& options = {}) {
  const auto vectors = [](const auto& range) {
    std::vector<Eigen::Vector3d> out;
    out.reserve(std::ranges::size(range));
    for (const auto& p : range) out.push_back(as_vector<double>(p));
    return out;
  };
  const std::vector<Eigen::Vector3d> e = vectors(estimate), r = vectors(reference);
  return umeyama(std::span<const Eigen::Vector3d>(e), std::span<const Eigen::Vector3d>(r), options);
}

}  // namespace aib::align
