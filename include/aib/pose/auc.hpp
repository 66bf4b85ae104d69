// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/core/executor.hpp>
#include <aib/pose/associate.hpp>
#include <aib/pose/auc_convention.hpp>
#include <aib/pose/frame_pairs.hpp>
#include <aib/pose/registered.hpp>
#include <aib/pose/trajectory.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace aib::pose {

struct auc_options {
  unsigned max_deg = 30;  ///< T, [1, 180]
  auc_convention convention = auc_convention::paper;
  double position_accuracy = 0;  ///< colmap: shorter reference baselines score by rotation alone
  unsigned threads = 0;          ///< 0: all
  struct control control = {};
};

struct auc_result {
  auc_convention convention;
  unsigned max_deg;
  double auc;               ///< share, [0, 1]
  double auc_signed;        ///< the same with signed directions: mirrored centres fold to nothing
  std::vector<double> rra;  ///< share of pairs at 1, 2, .. max_deg degrees
  std::vector<double> rta;  ///< folded where the convention folds
  std::uint64_t n_pairs;
  std::uint64_t n_zero_baseline;  ///< pairs without a direction, which never score
  std::size_t n_unregistered;     ///< frames without a finite pose
};

/// Area under the recall curve of relative pose errors over all frame pairs, 0..max_deg degrees.
///
/// estimate    associated with the reference (`colmap` takes the whole reference where both have
///             names: frames that are missing score there); its world and scale are its own
///
/// Pairs without a direction (see baselines) stay in the denominator; the folding conventions
/// take them for 90 degrees, as their sources do. Invariant to a similarity of either side (`da3`
/// only where it keeps the first camera first).
/// Throws argument_error if the trajectories are not associated or max_deg is out of range,
/// undefined_error if fewer than two frames are registered or no pair has a direction.
/// Source: the conventions' own code, see auc_convention; the paper's Sec. 3.
auc_result auc(const trajectory& estimate,
               const trajectory& reference,
               const auc_options& options = {});

namespace detail {

/// The frames in the form that makes frame_pairs' E_i E_j^-1 the relative pose of a convention.
inline registered_frames frames_for(auc_convention convention, registered_frames frames) {
  for (auto* poses : {&frames.estimate, &frames.reference}) {
    if (reverses(convention)) {
      std::reverse(poses->begin(), poses->end());  // E_j E_i^-1
    } else if (convention == auc_convention::da3) {
      // E_i^-1 E_j of E_i E_0^-1 is the relative pose of the inverse poses.
      const math::rigid3 world_from_first = poses->front();
      for (math::rigid3& pose : *poses) pose = pose.inverse() * world_from_first;
    }
  }
  return frames;
}

/// What the exact area needs of a set of pair errors e, mergeable in order.
struct area_sums {
  double below = 0;  // sum of (T - e) over e <= T
  double last = 0;   // largest e <= T
  std::uint64_t n_zero_baseline = 0;
  std::vector<std::uint64_t> rotation = {};  // errors below k + 1 degrees, from k on
  std::vector<std::uint64_t> translation = {};

  explicit area_sums(unsigned max_deg = 0) : rotation(max_deg), translation(max_deg) {}

  void add(double rotation_deg, double translation_deg) {
    const double e = std::max(rotation_deg, translation_deg);
    const auto limit = static_cast<double>(rotation.size());
    if (e <= limit) {
      below += limit - e;
      last = std::max(last, e);
    }
    if (rotation_deg < limit) ++rotation[static_cast<std::size_t>(rotation_deg)];
    if (translation_deg < limit) ++translation[static_cast<std::size_t>(translation_deg)];
  }

  friend area_sums operator+(area_sums a, const area_sums& b) {
    a.below += b.below;
    a.last = std::max(a.last, b.last);
    a.n_zero_baseline += b.n_zero_baseline;
    for (std::size_t k = 0; k < a.rotation.size(); ++k) {
      a.rotation[k] += b.rotation[k];
      a.translation[k] += b.translation[k];
    }
    return a;
  }
};

/// Sums of all pairs; `add_row(area_sums&, i)` adds those of frame i.
template <class AddRow>
area_sums sum_rows(std::size_t n, const auc_options& options, AddRow&& add_row) {
  return reduce_chunks<area_sums>(
      n, 16, options.threads, options.control, area_sums(options.max_deg),
      [&](const chunk& c) {
        area_sums sums(options.max_deg);
        for (std::size_t i = c.begin; i < c.end; ++i) add_row(sums, i);
        return sums;
      },
      [](area_sums a, const area_sums& b) { return std::move(a) + b; });
}

inline std::vector<double> cumulative_shares(const std::vector<std::uint64_t>& counts, double n) {
  std::vector<double> out;
  std::uint64_t below = 0;
  for (const std::uint64_t c : counts) out.push_back(static_cast<double>(below += c) / n);
  return out;
}

inline auc_result result_of(const area_sums& sums,
                            double area,
                            std::uint64_t n_pairs,
                            std::size_t n_unregistered,
                            const auc_options& options) {
  const auto n = static_cast<double>(n_pairs);
  const double share = area / (n * options.max_deg);
  return {.convention = options.convention,
          .max_deg = options.max_deg,
          .auc = share,
          .auc_signed = share,
          .rra = cumulative_shares(sums.rotation, n),
          .rta = cumulative_shares(sums.translation, n),
          .n_pairs = n_pairs,
          .n_zero_baseline = sums.n_zero_baseline,
          .n_unregistered = n_unregistered};
}

inline auc_result exact_auc(const registered_frames& frames,
                            std::size_t n_unregistered,
                            const auc_options& options) {
  const frame_pairs pairs(frames.estimate, frames.reference);
  const std::size_t n = pairs.frames();
  const area_sums sums = sum_rows(n, options, [&](area_sums& s, std::size_t i) {
    pairs.for_each_error(i, {i + 1, n}, [&](std::size_t, double rotation, double translation) {
      const bool has_direction = !std::isnan(translation);
      s.n_zero_baseline += has_direction ? 0 : 1;
      s.add(rotation, has_direction ? translation : 360);
    });
  });
  const std::uint64_t n_pairs = n * (n - 1) / 2;
  if (sums.n_zero_baseline == n_pairs) {
    throw undefined_error(message("auc: none of ", n_pairs,
                                  " pairs has a direction; relative_angles still gives RRA"));
  }
  return result_of(sums, sums.below, n_pairs, n_unregistered, options);
}

/// Source: COLMAP benchmark/reconstruction/evaluation/utils.py, compute_rel_errors, compute_auc.
inline auc_result colmap_auc(const trajectory& estimate,
                             const trajectory& reference,
                             const auc_options& options) {
  const bool named = !estimate.names.empty() && !reference.names.empty();
  if (!named) check_associated("auc", estimate, reference);
  std::size_t total = 0;  // reference frames, registered or not
  for (const math::rigid3& pose : reference.world_from_camera) total += pose.is_finite() ? 1 : 0;
  const association matched =
      associate(estimate, reference, {.by = named ? match_by::name : match_by::index});
  const registered_frames frames = registered("auc", matched.estimate, matched.reference);
  if (total < 2) throw undefined_error(message("auc: 2 reference frames expected, found ", total));
  const frame_pairs pairs(frames.estimate, frames.reference);
  const std::size_t n = pairs.frames();
  const auto has_short_reference = [&](std::size_t i, std::size_t j) {
    const auto &gi = frames.reference[i].translation, &gj = frames.reference[j].translation;
    return (gj - gi).norm() < options.position_accuracy ||
           !pairs.reference_baselines().has_direction(i, j);
  };
  const area_sums sums = sum_rows(n, options, [&](area_sums& s, std::size_t i) {
    const auto add = [&](std::size_t j, double rotation, double translation) {
      const bool has_direction = !std::isnan(translation);
      s.n_zero_baseline += has_direction ? 0 : 1;
      if (has_short_reference(i, j))
        s.add(rotation, 0);
      else
        s.add(rotation, has_direction ? translation : 90);
    };
    pairs.for_each_error(i, {0, i}, add);
    pairs.for_each_error(i, {i + 1, n}, add);
  });
  return result_of(sums, sums.below + sums.last / 2,
                   static_cast<std::uint64_t>(total) * (total - 1), total - n, options);
}

}  // namespace detail

inline auc_result auc(const trajectory& estimate,
                      const trajectory& reference,
                      const auc_options& options) {
  if (options.max_deg < 1 || options.max_deg > 180)
    throw argument_error(message("auc: max_deg in [1, 180] expected, found ", options.max_deg));
  if (options.convention == auc_convention::colmap)
    return detail::colmap_auc(estimate, reference, options);
  registered_frames frames = registered("auc", estimate, reference);
  const std::size_t n_unregistered = estimate.size() - frames.index.size();
  if (frames.index.size() < 2) {
    throw undefined_error(message("auc: 2 registered frames expected, found ", frames.index.size(),
                                  " of ", estimate.size()));
  }
  if (options.convention == auc_convention::exact)
    return detail::exact_auc(frames, n_unregistered, options);
  frames = detail::frames_for(options.convention, std::move(frames));
  const recall_thresholds thresholds(options.convention, options.max_deg);
  const joint_counts counts = frame_pairs(frames.estimate, frames.reference)
                                  .count(thresholds.rotation_bins(), thresholds.translation_bins(),
                                         options.threads, options.control);
  recall r = thresholds.of(counts);
  return {.convention = options.convention,
          .max_deg = options.max_deg,
          .auc = r.auc,
          .auc_signed = r.auc_signed,
          .rra = std::move(r.rra),
          .rta = std::move(r.rta),
          .n_pairs = counts.pairs(),
          .n_zero_baseline = counts.without_direction(),
          .n_unregistered = n_unregistered};
}

}  // namespace aib::pose
