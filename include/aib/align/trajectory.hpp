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

/// How one trajectory lies in the world of another.
struct alignment {
  math::sim3 transform;               ///< ref_from_est
  std::size_t n_inliers;              ///< frames that the fit used
  std::vector<std::size_t> outliers;  ///< registered frames that it did not use, of those offered
  double rmse;                        ///< of the inliers' positions, unit of the reference
  double condition;   ///< first over second singular value of the positions, of the worse side
  double turn_deg;    ///< expected error of the turn about the long axis of the positions, <= 90
  double turn_error;  ///< what that moves a point `stand_off` away from the axis
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

/// Distances from the long axis of the positions, root of their square sum.
inline double lever(const spread& s) {
  return std::hypot(s.singular_values[1], s.singular_values[2]);
}

/// Standard deviation of the turn about the long axis, radians, at most a right angle: the residual
/// of a coordinate over the lever.
inline double turn_sigma(double lever, double sse, std::size_t n, std::size_t parameters) {
  constexpr double right_angle = std::numbers::pi / 2;
  const double freedom = 3 * static_cast<double>(n) - static_cast<double>(parameters);
  if (!(freedom > 0) || !(lever > 0)) return right_angle;
  return std::min(right_angle, std::sqrt(sse / freedom) / lever);
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
                .condition = 1,
                .turn_deg = 0,
                .turn_error = 0,
                .warnings = {}};
  std::vector<std::size_t> left_out;
  std::set_difference(offered.begin(), offered.end(), used.begin(), used.end(),
                      std::back_inserter(left_out));
  for (const std::size_t i : left_out) out.outliers.push_back(frames.index[i]);
  double sse = 0;
  for (const std::size_t i : used) {
    const double r = fit.residual(out.transform, i);
    sse += r * r;
  }
  out.rmse = std::sqrt(sse / static_cast<double>(used.size()));
  if (options.fit.mode == align_mode::first) return out;

  const std::vector<Eigen::Vector3d> x = fit.estimate(used), y = fit.reference(used);
  const spread s = spread_of(x), s_reference = spread_of(y);
  out.condition = std::max(s.condition(), s_reference.condition());
  const bool turns = options.fit.mode == align_mode::sim3 || options.fit.mode == align_mode::se3;
  if (turns && !(options.fit.rotation_weight > 0)) {
    // Of both sides the thinner: noise widens a line, it never narrows one.
    const double turn = detail::turn_sigma(
        std::min(out.transform.scale * detail::lever(s), detail::lever(s_reference)), sse,
        used.size(), options.fit.mode == align_mode::sim3 ? 7 : 6);
    out.turn_deg = math::degrees(turn);
    out.turn_error = 2 * options.stand_off * std::sin(turn / 2);
    if (1 / out.condition < doubted_ratio || out.turn_deg > 5) {
      const Eigen::Vector3d axis = s_reference.axes.col(0);
      out.warnings.push_back(message(
          "the turn about ", detail::direction_text(axis), ", along which the positions lie ",
          "(condition ", std::round(out.condition), "), is known to +-",
          std::round(out.turn_deg * 10) / 10, " deg, ", std::round(out.turn_error * 100) / 100,
          " at a distance of ", options.stand_off, "; rotation_weight uses the orientations"));
    }
  }
  if (options.fit.mode == align_mode::sim3 || options.fit.mode == align_mode::scale) {
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
