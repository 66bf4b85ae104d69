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
#include <utility>
#include <vector>

namespace aib::pose {

struct pair_histogram_options {
  std::vector<double> rotation_deg = {1, 2, 5, 10, 15, 20, 30, 60, 90};  ///< edges, (0, 360]
  std::vector<double> translation_deg = {1, 2, 5, 10, 15, 20, 30, 60, 90, 120, 150};
  unsigned threads = 0;  ///< 0: all
  struct control control = {};
};

/// Frame pairs by rotation error (rows) and direction error (columns). Bin k holds
/// edge[k - 1] <= error < edge[k]; the first begins at 0, the last has no end.
struct pair_histogram_result {
  std::vector<double> rotation_deg;                ///< edges, ascending, each once
  std::vector<double> translation_deg;             ///< edges, ascending, each once
  std::vector<std::vector<std::uint64_t>> counts;  ///< one row a rotation bin
  std::vector<std::uint64_t> without_direction;    ///< pairs of each rotation bin that have none
  std::uint64_t n_pairs;
  std::uint64_t n_zero_baseline;  ///< sum of `without_direction`
  std::size_t n_unregistered;     ///< frames left out because a pose is not finite
};

/// The joint histogram of relative rotation and signed direction errors of all frame pairs, of
/// which every RRA, RTA and binned AUC with these edges is a sum.
///
/// estimate    associated with the reference; its world and scale are its own
///
/// Throws argument_error if the trajectories are not associated or an edge is out of range,
/// undefined_error if fewer than two frames are registered.
inline pair_histogram_result pair_histogram(const trajectory& estimate,
                                            const trajectory& reference,
                                            const pair_histogram_options& options = {}) {
  const registered_frames frames = registered("pair_histogram", estimate, reference);
  if (frames.index.size() < 2) {
    throw undefined_error(message("pair_histogram: 2 registered frames expected, found ",
                                  frames.index.size(), " of ", estimate.size()));
  }
  const joint_counts counts =
      frame_pairs(frames.estimate, frames.reference)
          .count(angle_bins(options.rotation_deg), angle_bins(options.translation_deg),
                 options.threads, options.control);
  const std::size_t columns = counts.translation().size();
  pair_histogram_result out{.rotation_deg = counts.rotation().edges_deg(),
                            .translation_deg = counts.translation().edges_deg(),
                            .counts = {},
                            .without_direction = {},
                            .n_pairs = counts.pairs(),
                            .n_zero_baseline = counts.without_direction(),
                            .n_unregistered = estimate.size() - frames.index.size()};
  for (std::size_t r = 0; r < counts.rotation().size(); ++r) {
    std::vector<std::uint64_t> row;
    for (std::size_t c = 0; c < columns; ++c) row.push_back(counts.at(r, c));
    out.counts.push_back(std::move(row));
    out.without_direction.push_back(counts.at(r, columns));
  }
  return out;
}

}  // namespace aib::pose
