// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/core/executor.hpp>
#include <aib/pose/frame_pairs.hpp>
#include <aib/pose/registered.hpp>
#include <aib/pose/trajectory.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace aib::pose {

struct relative_angles_options {
  std::vector<double> tau_deg = {5, 15, 30};  ///< thresholds, (0, 180]
  unsigned threads = 0;                       ///< 0: all
  struct control control = {};
};

/// Shares are of all pairs; a pair without a direction never scores in `rta`.
struct relative_angles_result {
  std::vector<double> tau_deg;  ///< as asked for
  std::vector<double> rra;      ///< relative rotation accuracy: share of pairs below each tau
  std::vector<double> rta;      ///< relative translation accuracy, signed directions
  std::uint64_t n_pairs;
  std::uint64_t n_zero_baseline;  ///< pairs without a direction
  std::size_t n_unregistered;     ///< frames left out because a pose is not finite
};

/// Shares of frame pairs whose relative rotation, and whose relative translation direction, is off
/// by strictly less than each tau.
///
/// estimate    associated with the reference; its world and scale are its own
///
/// Invariant to a similarity of either side. Throws argument_error if the trajectories are not
/// associated or a tau is out of range, undefined_error if fewer than two frames are registered.
/// Source: Jin et al., "Image matching across wide baselines", IJCV 2021, Sec. 3.3.
inline relative_angles_result relative_angles(const trajectory& estimate,
                                              const trajectory& reference,
                                              const relative_angles_options& options = {}) {
  for (const double tau : options.tau_deg) {
    if (!(tau > 0 && tau <= 180))
      throw argument_error(message("relative_angles: tau in (0, 180] expected, found ", tau));
  }
  const registered_frames frames = registered("relative_angles", estimate, reference);
  if (frames.index.size() < 2) {
    throw undefined_error(message("relative_angles: 2 registered frames expected, found ",
                                  frames.index.size(), " of ", estimate.size()));
  }
  const angle_bins bins(options.tau_deg);
  const joint_counts counts = frame_pairs(frames.estimate, frames.reference)
                                  .count(bins, bins, options.threads, options.control);
  relative_angles_result out{.tau_deg = options.tau_deg,
                             .rra = {},
                             .rta = {},
                             .n_pairs = counts.pairs(),
                             .n_zero_baseline = counts.without_direction(),
                             .n_unregistered = estimate.size() - frames.index.size()};
  const auto n = static_cast<double>(out.n_pairs);
  for (const double tau : options.tau_deg) {
    const std::size_t below = bins.bins_below(tau);
    out.rra.push_back(static_cast<double>(counts.sum(below, 0, counts.columns())) / n);
    out.rta.push_back(static_cast<double>(counts.sum(bins.size(), 0, below)) / n);
  }
  return out;
}

}  // namespace aib::pose
