// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/math/rigid3.hpp>
#include <aib/pose/delta_pairs.hpp>
#include <aib/pose/pose_relation.hpp>
#include <aib/pose/registered.hpp>
#include <aib/pose/trajectory.hpp>
#include <aib/stats/summary.hpp>

#include <cmath>
#include <cstddef>
#include <vector>

namespace aib::pose {

/// Whose path or turning tells which poses are a delta apart.
enum class pairs_from { estimate, reference };

struct rpe_options {
  pose_relation relation = pose_relation::translation;
  delta_options pairs = {};
  pairs_from from = pairs_from::estimate;  ///< evo's default
};

/// Relative pose error: of each pair of poses a delta apart the motion
/// E = (ref_i^-1 ref_j)^-1 (est_i^-1 est_j). Frames without a finite pose are passed over before
/// deltas are counted.
///
/// Invariant to a rigid motion of either side. Pairs with a reference distance of 0 have no
/// point_distance_ratio and are left out. Throws argument_error if the trajectories are not
/// associated or delta is not positive, undefined_error if no pair is a delta apart.
/// Source: Sturm et al., IROS 2012, Sec. IV-A; evo, core/metrics.py, RPE.
inline pose_errors rpe(const trajectory& estimate,
                       const trajectory& reference,
                       const rpe_options& options = {}) {
  const registered_frames frames = registered("rpe", estimate, reference);
  const auto& path = options.from == pairs_from::estimate ? frames.estimate : frames.reference;
  const bool ratio = options.relation == pose_relation::point_distance_ratio;
  pose_errors out;
  for (const frame_pair& pair : delta_pairs(path, options.pairs)) {
    const auto motion = [&](const std::vector<math::rigid3>& poses) {
      return poses[pair.from].inverse() * poses[pair.to];
    };
    const math::rigid3 est = motion(frames.estimate), ref = motion(frames.reference);
    double error = magnitude(options.relation, ref.inverse() * est);
    if (ratio || options.relation == pose_relation::point_distance)
      error = std::abs(ref.translation.norm() - est.translation.norm());
    if (ratio) {
      if (ref.translation.norm() == 0) continue;
      error *= 100 / ref.translation.norm();
    }
    out.errors.push_back(error);
    out.index.push_back(frames.index[pair.to]);
  }
  if (out.errors.empty()) throw undefined_error("rpe: no reference pose moves over a delta");
  out.summary = stats::summarize(out.errors);
  return out;
}

}  // namespace aib::pose
