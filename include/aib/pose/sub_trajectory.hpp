// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/math/rigid3.hpp>
#include <aib/math/rotation.hpp>
#include <aib/pose/delta_pairs.hpp>
#include <aib/pose/registered.hpp>
#include <aib/pose/trajectory.hpp>
#include <aib/stats/summary.hpp>

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <vector>

namespace aib::pose {

struct sub_trajectory_options {
  std::vector<double> lengths = {};  ///< empty: 10, 20, .. 50 % of the reference's path
  double tolerance = 0.2;            ///< share of the length that a sub-trajectory may miss
};

/// Errors over the sub-trajectories of one length.
struct sub_trajectory_errors {
  double length;
  stats::summary translation;          ///< unit of the positions
  stats::summary translation_percent;  ///< of the length
  stats::summary rotation_deg;
  stats::summary rotation_deg_per_m;
  stats::summary yaw_deg;      ///< about the world's z axis
  stats::summary gravity_deg;  ///< of roll and pitch: what gravity would tell
};

/// Relative errors by the length of sub-trajectories, as rpg_trajectory_evaluation has them: every
/// frame starts one that ends where the reference's path is nearest to the length; the error
/// (ref_i^-1 ref_j)^-1 (est_i^-1 est_j) is turned into the estimate's world. Lengths with fewer
/// than two sub-trajectories are left out.
///
/// Invariant to a translation and a turn about z of either side. Frames without a finite pose are
/// passed over. Throws argument_error if the trajectories are not associated or a length is not
/// positive, undefined_error if no length has two.
/// Source: Zhang and Scaramuzza, IROS 2018, Sec. IV; rpg_trajectory_evaluation,
/// compute_trajectory_errors.py.
inline std::vector<sub_trajectory_errors> sub_trajectories(
    const trajectory& estimate,
    const trajectory& reference,
    const sub_trajectory_options& options = {}) {
  const registered_frames frames = registered("sub_trajectories", estimate, reference);
  const std::vector<double> path = path_lengths(frames.reference);
  std::vector<double> lengths = options.lengths;
  if (lengths.empty() && !path.empty() && path.back() > 0) {
    for (int k = 1; k <= 5; ++k) lengths.push_back(path.back() * k / 10);
  }
  std::vector<sub_trajectory_errors> out;
  for (const double length : lengths) {
    if (!(length > 0))
      throw argument_error(message("sub_trajectories: lengths > 0 expected, found ", length));
    std::vector<double> translation, percent, rotation, per_m, yaw, gravity;
    for (const frame_pair& pair : detail::nearest_along_path(path, length, options.tolerance)) {
      const auto motion = [&](const std::vector<math::rigid3>& poses) {
        return poses[pair.from].inverse() * poses[pair.to];
      };
      const math::rigid3 error = motion(frames.reference).inverse() * motion(frames.estimate);
      const Eigen::Matrix3d& w = frames.estimate[pair.to].rotation;
      const Eigen::Matrix3d r = w * error.rotation * w.transpose();
      translation.push_back(error.translation.norm());
      percent.push_back(100 * translation.back() / length);
      rotation.push_back(math::degrees(math::rotation_angle(r)));
      per_m.push_back(rotation.back() / length);
      yaw.push_back(math::degrees(std::abs(std::atan2(r(1, 0), r(0, 0)))));
      const double pitch = std::atan2(-r(2, 0), std::hypot(r(0, 0), r(1, 0)));
      gravity.push_back(math::degrees(std::hypot(pitch, std::atan2(r(2, 1), r(2, 2)))));
    }
    if (translation.size() < 2) continue;
    out.push_back({length, stats::summarize(translation), stats::summarize(percent),
                   stats::summarize(rotation), stats::summarize(per_m), stats::summarize(yaw),
                   stats::summarize(gravity)});
  }
  if (out.empty()) {
    throw undefined_error(message("sub_trajectories: no length has two; the reference's path is ",
                                  path.empty() ? 0 : path.back(), " long"));
  }
  return out;
}

}  // namespace aib::pose
