// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/math/rigid3.hpp>
#include <aib/pose/pose_relation.hpp>
#include <aib/pose/registered.hpp>
#include <aib/pose/trajectory.hpp>
#include <aib/stats/summary.hpp>

#include <cstddef>

namespace aib::pose {

struct ape_options {
  pose_relation relation = pose_relation::translation;
};

/// Absolute pose error: of each frame the motion E = est^-1 ref. Aligns nothing. Frames without a
/// finite pose are passed over.
///
/// Invariant to a common rigid motion. Throws argument_error if the trajectories are not associated
/// or the relation is a ratio, undefined_error if no frame is registered on both sides.
/// Source: Sturm et al., IROS 2012, Sec. IV-B; evo, core/metrics.py, APE.
inline pose_errors ape(const trajectory& estimate,
                       const trajectory& reference,
                       const ape_options& options = {}) {
  if (options.relation == pose_relation::point_distance_ratio)
    throw argument_error("ape: point_distance_ratio is a relation of pairs; see rpe");
  const registered_frames frames = registered("ape", estimate, reference);
  if (frames.index.empty()) {
    throw undefined_error(
        message("ape: none of ", estimate.size(), " frames has a finite pose on both sides"));
  }
  pose_errors out{.summary = {}, .errors = {}, .index = frames.index};
  for (std::size_t i = 0; i < frames.index.size(); ++i)
    out.errors.push_back(
        magnitude(options.relation, frames.estimate[i].inverse() * frames.reference[i]));
  out.summary = stats::summarize(out.errors);
  return out;
}

}  // namespace aib::pose
