// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/pose/auc.hpp>
#include <aib/pose/auc_convention.hpp>
#include <aib/pose/frame_pairs.hpp>
#include <aib/pose/registered.hpp>
#include <aib/pose/trajectory.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace aib::pose {

/// The AUC of some of the pairs.
struct partial_auc {
  std::optional<recall> value;  ///< nothing where no pair has a direction
  std::uint64_t n_pairs;
  std::uint64_t n_zero_baseline;
};

struct auc_by_batch_result {
  partial_auc intra;  ///< pairs of frames of one batch; needs no alignment
  partial_auc cross;  ///< pairs of frames of two batches; means something after alignment only
};

struct gap_range {
  std::size_t first;  ///< smallest difference of two frames' places in the trajectory
  std::size_t last;   ///< largest, inclusive
};

struct auc_by_gap_result {
  gap_range gap;
  partial_auc part;
};

namespace detail {

/// The frames of a convention and the place of each in its order.
struct placed_frames {
  registered_frames frames;
  std::vector<std::size_t> place;  // in the associated trajectories, in the order of the frames
};

inline placed_frames placed(const trajectory& estimate,
                            const trajectory& reference,
                            const auc_options& options) {
  placed_frames out{registered("auc", estimate, reference), {}};
  out.place = out.frames.index;
  if (reverses(options.convention)) std::reverse(out.place.begin(), out.place.end());
  if (!out.place.empty()) out.frames = frames_for(options.convention, std::move(out.frames));
  return out;
}

inline partial_auc part_of(const joint_counts& counts, const recall_thresholds& thresholds) {
  partial_auc out{{}, counts.pairs(), counts.without_direction()};
  if (out.n_pairs > out.n_zero_baseline) out.value = thresholds.of(counts);
  return out;
}

}  // namespace detail

/// AUC over the pairs within batches and over those across batches.
///
/// batch   the batch of each frame of the associated trajectories
///
/// Per-batch alignment to the reference helps the latter, and the former shows the method alone.
/// Throws argument_error if the trajectories are not associated, `batch` has another length or the
/// convention is not one of thresholds (colmap, exact).
inline auc_by_batch_result auc_by_batch(const trajectory& estimate,
                                        const trajectory& reference,
                                        std::span<const std::size_t> batch,
                                        const auc_options& options = {}) {
  if (batch.size() != estimate.size()) {
    throw argument_error(message("auc_by_batch: the batch of each of ", estimate.size(),
                                 " frames expected, found ", batch.size()));
  }
  const recall_thresholds thresholds(options.convention, options.max_deg);
  const detail::placed_frames all = detail::placed(estimate, reference, options);
  const auto batch_of = [&](std::size_t frame) { return batch[all.place[frame]]; };
  std::vector<std::size_t> order(all.place.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return batch_of(a) < batch_of(b); });
  std::vector<math::rigid3> e, r;
  for (const std::size_t i : order) {
    e.push_back(all.frames.estimate[i]);
    r.push_back(all.frames.reference[i]);
  }
  const auto end_of_batch = [&](std::size_t i) {
    const auto end = std::upper_bound(
        order.begin() + static_cast<std::ptrdiff_t>(i), order.end(), batch_of(order[i]),
        [&](std::size_t b, std::size_t frame) { return b < batch_of(frame); });
    return static_cast<std::size_t>(end - order.begin());
  };
  const joint_counts intra = frame_pairs(e, r).count_rows(
      thresholds.rotation_bins(), thresholds.translation_bins(),
      [&](std::size_t i) {
        return pair_row{i + 1, end_of_batch(i)};
      },
      options.threads, options.control);
  joint_counts cross = frame_pairs(all.frames.estimate, all.frames.reference)
                           .count(thresholds.rotation_bins(), thresholds.translation_bins(),
                                  options.threads, options.control);
  cross -= intra;
  return {detail::part_of(intra, thresholds), detail::part_of(cross, thresholds)};
}

/// AUC over the pairs of frames that lie so many places apart: how far errors accumulate.
///
/// Throws as auc_by_batch, and argument_error if a range is empty or begins at 0.
inline std::vector<auc_by_gap_result> auc_by_gap(const trajectory& estimate,
                                                 const trajectory& reference,
                                                 std::span<const gap_range> gaps,
                                                 const auc_options& options = {}) {
  const recall_thresholds thresholds(options.convention, options.max_deg);
  const detail::placed_frames all = detail::placed(estimate, reference, options);
  const frame_pairs pairs(all.frames.estimate, all.frames.reference);
  std::vector<std::size_t> place = all.place;  // ascending
  if (reverses(options.convention)) {
    for (std::size_t& p : place) p = estimate.size() - 1 - p;
  }
  std::vector<auc_by_gap_result> out;
  for (const gap_range& gap : gaps) {
    if (gap.first < 1 || gap.last < gap.first) {
      throw argument_error(message("auc_by_gap: a range of gaps from 1 on expected, found ",
                                   gap.first, "..", gap.last));
    }
    const auto row = [&](std::size_t i) {
      const auto begin = std::lower_bound(place.begin(), place.end(), place[i] + gap.first);
      const auto end = std::upper_bound(begin, place.end(), place[i] + gap.last);
      return pair_row{static_cast<std::size_t>(begin - place.begin()),
                      static_cast<std::size_t>(end - place.begin())};
    };
    const joint_counts counts =
        pairs.count_rows(thresholds.rotation_bins(), thresholds.translation_bins(), row,
                         options.threads, options.control);
    out.push_back({gap, detail::part_of(counts, thresholds)});
  }
  return out;
}

}  // namespace aib::pose
