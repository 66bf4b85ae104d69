// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/align/outliers.hpp>
#include <aib/align/pose_fit.hpp>
#include <aib/align/ransac.hpp>
#include <aib/align/spread.hpp>
#include <aib/core/error.hpp>
#include <aib/math/rotation.hpp>
#include <aib/math/sim3.hpp>
#include <aib/pose/registered.hpp>
#include <aib/pose/trajectory.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numbers>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace aib::align {

struct trajectory_options {
  fit_options fit = {};
  std::size_t n = 0;              ///< fit to the first n registered frames; 0: to all
  outlier_options outliers = {};  ///< nothing is removed unless asked
  std::optional<ransac_options> robust = {};
  double stand_off = 10;  ///< distance at which the error of a turn is foretold, reference's unit
};

/// How well the positions tell the turn that they tell worst.
struct turn_doubt {
  double deg;    ///< its expected error, <= 90
  double error;  ///< what that moves a point `stand_off` away from its axis
};

/// How one trajectory lies in the world of another.
struct alignment {
  math::sim3 transform;               ///< ref_from_est
  std::size_t n_inliers;              ///< frames that the fit used
  std::vector<std::size_t> outliers;  ///< registered frames that it did not use, of those offered
  double rmse;                        ///< of the inliers' positions, unit of the reference
  std::optional<double> half_rmse;    ///< of every other inlier under a fit to the others
  double condition;  ///< first over second singular value of the positions, of the worse side
  std::optional<turn_doubt> turn;  ///< of a fit that turns, to positions alone
  std::vector<std::string> warnings;
};

/// Fits ref_from_est to the positions (and, if asked, orientations) of associated trajectories.
/// Frames without a finite pose are passed over.
///
/// Throws argument_error if the trajectories are not associated, undefined_error if the frames do
/// not tell the transform: the message names what is free.
alignment trajectory(const pose::trajectory& estimate,
                     const pose::trajectory& reference,
                     const trajectory_options& options = {});

namespace detail {

/// The turn that positions tell worst: about their long axis, or the vertical where a fit turns
/// about nothing else.
struct weakest_turn {
  Eigen::Vector3d axis;
  double lever;  ///< root of the square sum of the distances from it
};

inline weakest_turn weakest_turn_of(std::span<const Eigen::Vector3d> positions,
                                    const fit_options& options) {
  const spread s = spread_of(positions);
  if (!is_about_vertical(options.mode))
    return {s.axes.col(0), std::hypot(s.singular_values[1], s.singular_values[2])};
  const Eigen::Vector3d up = options.up.normalized();
  double sum = 0;
  for (const Eigen::Vector3d& p : positions) sum += (p - s.mean).cross(up).squaredNorm();
  return {up, std::sqrt(sum)};
}

/// Standard deviation of a turn, radians, at most a right angle: the residual of a coordinate over
/// the lever.
inline double turn_sigma(double lever, double sse, std::size_t n, std::size_t parameters) {
  constexpr double right_angle = std::numbers::pi / 2;
  const double freedom = 3 * static_cast<double>(n) - static_cast<double>(parameters);
  if (!(freedom > 0) || !(lever > 0)) return right_angle;
  return std::min(right_angle, std::sqrt(sse / freedom) / lever);
}

inline std::size_t parameters_of(align_mode mode) {
  return (is_about_vertical(mode) ? 4u : 6u) + (has_scale(mode) ? 1u : 0u);
}

/// Error of the odd poses of those chosen under a fit to the even ones; nothing where these do not
/// tell it.
inline std::optional<double> half_rmse(const pose_fit& fit, std::span<const std::size_t> chosen) {
  std::vector<std::size_t> even, odd;
  for (std::size_t k = 0; k < chosen.size(); ++k) (k % 2 == 0 ? even : odd).push_back(chosen[k]);
  if (odd.empty()) return std::nullopt;
  try {
    return std::sqrt(fit.square_sum(fit(even), odd) / static_cast<double>(odd.size()));
  } catch (const undefined_error&) {
    return std::nullopt;
  }
}

/// What a user should know about how well the turn is known.
inline std::string turn_warning(const alignment& a, const Eigen::Vector3d& axis, double stand_off) {
  return message("the turn about ", direction_text(axis), ", along which the positions lie ",
                 "(condition ", std::round(a.condition), "), is known to +-",
                 std::round(a.turn->deg * 10) / 10, " deg, ", std::round(a.turn->error * 100) / 100,
                 " at a distance of ", stand_off, "; rotation_weight uses the orientations");
}

/// The scale that the median distances from the median positions tell.
inline double scale_of_medians(std::span<const Eigen::Vector3d> estimate,
                               std::span<const Eigen::Vector3d> reference) {
  return split_outliers(reference, {}).median_distance /
         split_outliers(estimate, {}).median_distance;
}

}  // namespace detail

inline alignment trajectory(const pose::trajectory& estimate,
                            const pose::trajectory& reference,
                            const trajectory_options& options) {
  const pose::registered_frames frames = pose::registered("align::trajectory", estimate, reference);
  const pose_fit fit(frames.estimate, frames.reference, options.fit);
  std::vector<std::size_t> offered(frames.index.size());
  if (options.n > 0) offered.resize(std::min(options.n, offered.size()));
  std::iota(offered.begin(), offered.end(), std::size_t{0});
  if (offered.empty()) {
    throw undefined_error(message("align::trajectory: none of ", estimate.size(),
                                  " frames has a finite pose on both sides"));
  }
  std::vector<std::size_t> used = options.outliers.factor || options.outliers.distance
                                      ? split_outliers(fit.estimate(offered), options.outliers).kept
                                      : offered;
  if (options.robust) used = consensus(fit, used, *options.robust);

  alignment out{.transform = fit(used),
                .n_inliers = used.size(),
                .outliers = {},
                .rmse = 0,
                .half_rmse = detail::half_rmse(fit, used),
                .condition = 1,
                .turn = std::nullopt,
                .warnings = {}};
  std::vector<std::size_t> left_out;
  std::set_difference(offered.begin(), offered.end(), used.begin(), used.end(),
                      std::back_inserter(left_out));
  for (const std::size_t i : left_out) out.outliers.push_back(frames.index[i]);
  const double sse = fit.square_sum(out.transform, used);
  out.rmse = std::sqrt(sse / static_cast<double>(used.size()));
  const align_mode mode = options.fit.mode;
  if (mode == align_mode::first) return out;

  const std::vector<Eigen::Vector3d> x = fit.estimate(used), y = fit.reference(used);
  out.condition = std::max(spread_of(x).condition(), spread_of(y).condition());
  if (mode != align_mode::scale && !(options.fit.rotation_weight > 0)) {
    const auto in_estimate = detail::weakest_turn_of(x, options.fit);
    const auto in_reference = detail::weakest_turn_of(y, options.fit);
    // Of both sides the thinner: noise widens a line, it never narrows one.
    const double lever = std::min(out.transform.scale * in_estimate.lever, in_reference.lever);
    const double turn = detail::turn_sigma(lever, sse, used.size(), detail::parameters_of(mode));
    out.turn = {math::degrees(turn), 2 * options.stand_off * std::sin(turn / 2)};
    const bool thin = !is_about_vertical(mode) && 1 / out.condition < doubted_ratio;
    if (thin || out.turn->deg > 5)
      out.warnings.push_back(detail::turn_warning(out, in_reference.axis, options.stand_off));
  }
  if (has_scale(mode)) {
    const double expected = detail::scale_of_medians(x, y);
    const double off = out.transform.scale / expected;
    if (std::isfinite(expected) && (off < 0.5 || off > 2)) {
      out.warnings.push_back(message("the fitted scale ", out.transform.scale, " is far from the ",
                                     expected, " of the median distances: outliers rule the fit; ",
                                     "see outlier_factor and robust"));
    }
  }
  return out;
}

}  // namespace aib::align
