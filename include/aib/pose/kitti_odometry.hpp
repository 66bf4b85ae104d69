// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/math/rigid3.hpp>
#include <aib/math/rotation.hpp>
#include <aib/pose/delta_pairs.hpp>
#include <aib/pose/registered.hpp>
#include <aib/pose/trajectory.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace aib::pose {

struct kitti_odometry_options {
  std::vector<double> lengths_m = {100, 200, 300, 400, 500, 600, 700, 800};
  std::size_t step = 10;  ///< frames from one start to the next
};

/// Mean errors of segments.
struct segment_errors {
  double translation_percent;  ///< of the segment's length
  double rotation_deg_per_m;
  std::uint64_t n;  ///< segments
};

struct kitti_odometry_result {
  segment_errors all;                     ///< over all segments, each counts once
  std::vector<double> lengths_m;          ///< those that have a segment
  std::vector<segment_errors> by_length;  ///< one of each
};

/// KITTI odometry's errors: over segments of the reference's path, from every `step`-th frame, the
/// motion (est_i^-1 est_j)^-1 (ref_i^-1 ref_j), divided by the segment's length.
///
/// Invariant to a rigid motion of either side. Frames without a finite pose are passed over. Throws
/// argument_error if the trajectories are not associated, undefined_error if the path is shorter
/// than every length.
/// Source: Geiger, Lenz, Urtasun, CVPR 2012; devkit, evaluate_odometry.cpp.
inline kitti_odometry_result kitti_odometry(const trajectory& estimate,
                                            const trajectory& reference,
                                            const kitti_odometry_options& options = {}) {
  if (options.step == 0) throw argument_error("kitti_odometry: step > 0 expected");
  const registered_frames frames = registered("kitti_odometry", estimate, reference);
  const std::vector<double> path = path_lengths(frames.reference);
  kitti_odometry_result out{};
  for (const double length : options.lengths_m) {
    if (!(length > 0))
      throw argument_error(message("kitti_odometry: lengths > 0 expected, found ", length));
    segment_errors sum{};
    for (std::size_t i = 0; i < path.size(); i += options.step) {
      std::size_t j = i;
      while (j < path.size() && !(path[j] > path[i] + length)) ++j;
      if (j == path.size()) break;
      const auto motion = [&](const std::vector<math::rigid3>& poses) {
        return poses[i].inverse() * poses[j];
      };
      const math::rigid3 error = motion(frames.estimate).inverse() * motion(frames.reference);
      sum.translation_percent += 100 * error.translation.norm() / length;
      sum.rotation_deg_per_m += math::degrees(math::rotation_angle(error.rotation)) / length;
      ++sum.n;
    }
    if (sum.n == 0) continue;
    const auto n = static_cast<double>(sum.n);
    out.all.translation_percent += sum.translation_percent;
    out.all.rotation_deg_per_m += sum.rotation_deg_per_m;
    out.all.n += sum.n;
    out.lengths_m.push_back(length);
    out.by_length.push_back({sum.translation_percent / n, sum.rotation_deg_per_m / n, sum.n});
  }
  if (out.all.n == 0) {
    throw undefined_error(message("kitti_odometry: no segment; the reference's path is ",
                                  path.empty() ? 0 : path.back(), " m long"));
  }
  out.all.translation_percent /= static_cast<double>(out.all.n);
  out.all.rotation_deg_per_m /= static_cast<double>(out.all.n);
  return out;
}

}  // namespace aib::pose
