// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/align/trajectory.hpp>
#include <aib/core/error.hpp>
#include <aib/math/sim3.hpp>
#include <aib/pose/registered.hpp>
#include <aib/pose/trajectory.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

namespace aib::align {

struct batches_options {
  std::size_t size = 200;               ///< frames of a batch; the last has what is left
  std::vector<std::size_t> sizes = {};  ///< frames of each batch instead, in order
  trajectory_options align = {};        ///< of each batch
};

/// A batch of frames [begin, end) and how it lies in the world of the reference.
struct batch_alignment {
  std::size_t begin;
  std::size_t end;
  std::optional<alignment> fit;     ///< nothing where the frames do not tell the transform
  std::string degenerate;           ///< then why
  std::optional<double> half_rmse;  ///< of every other inlier, fitted to the others
  std::optional<double> seam;  ///< jump of the position error from the batch before to this one
};

/// Aligns each of the sequential batches of associated trajectories on its own. A batch whose
/// frames do not tell its transform is named, not guessed.
///
/// Throws argument_error if the trajectories are not associated or the sizes do not add up to their
/// length.
std::vector<batch_alignment> batches(const pose::trajectory& estimate,
                                     const pose::trajectory& reference,
                                     const batches_options& options = {});

/// Each batch moved by its transform; the poses of degenerate batches become NaN, unregistered.
pose::trajectory transformed(const std::vector<batch_alignment>& batches,
                             pose::trajectory estimate);

namespace detail {

inline std::vector<std::size_t> batch_sizes(std::size_t frames, const batches_options& options) {
  if (!options.sizes.empty()) {
    const std::size_t sum =
        std::accumulate(options.sizes.begin(), options.sizes.end(), std::size_t{0});
    if (sum == frames) return options.sizes;
    throw argument_error(
        message("align::batches: sizes that add up to ", frames, " frames expected, found ", sum));
  }
  if (options.size == 0) throw argument_error("align::batches: size > 0 expected");
  std::vector<std::size_t> sizes(frames / options.size, options.size);
  if (frames % options.size != 0) sizes.push_back(frames % options.size);
  return sizes;
}

inline pose::trajectory slice(const pose::trajectory& t, std::size_t begin, std::size_t end) {
  std::vector<std::size_t> indices(end - begin);
  std::iota(indices.begin(), indices.end(), begin);
  return select(t, indices);
}

/// Error of the odd frames of those chosen under a fit to the even ones.
inline std::optional<double> half_rmse(const pose_fit& fit,
                                       const std::vector<std::size_t>& chosen) {
  std::vector<std::size_t> even, odd;
  for (std::size_t k = 0; k < chosen.size(); ++k) (k % 2 == 0 ? even : odd).push_back(chosen[k]);
  if (odd.empty()) return std::nullopt;
  try {
    const math::sim3 ref_from_est = fit(even);
    double sse = 0;
    for (const std::size_t i : odd) sse += std::pow(fit.residual(ref_from_est, i), 2);
    return std::sqrt(sse / static_cast<double>(odd.size()));
  } catch (const undefined_error&) {
    return std::nullopt;
  }
}

/// Errors of positions under a transform; NaN where a pose is not finite.
inline Eigen::Vector3d position_error(const math::sim3& ref_from_est,
                                      const pose::trajectory& estimate,
                                      const pose::trajectory& reference,
                                      std::size_t i) {
  return ref_from_est * estimate.world_from_camera[i].translation -
         reference.world_from_camera[i].translation;
}

inline batch_alignment align_batch(const pose::trajectory& estimate,
                                   const pose::trajectory& reference,
                                   std::size_t begin,
                                   std::size_t end,
                                   const trajectory_options& options) {
  batch_alignment out{begin, end, {}, {}, {}, {}};
  const pose::trajectory e = slice(estimate, begin, end), r = slice(reference, begin, end);
  try {
    out.fit = trajectory(e, r, options);
  } catch (const undefined_error& failure) {
    out.degenerate = failure.what();
    return out;
  }
  const pose::registered_frames frames = pose::registered("align::batches", e, r);
  const auto& outliers = out.fit->outliers;
  std::vector<std::size_t> inliers;
  for (std::size_t k = 0; k < frames.index.size(); ++k) {
    if (!std::binary_search(outliers.begin(), outliers.end(), frames.index[k]))
      inliers.push_back(k);
  }
  out.half_rmse = half_rmse(pose_fit(frames.estimate, frames.reference, options.fit), inliers);
  for (std::size_t& i : out.fit->outliers) i += begin;
  return out;
}

}  // namespace detail

inline std::vector<batch_alignment> batches(const pose::trajectory& estimate,
                                            const pose::trajectory& reference,
                                            const batches_options& options) {
  pose::check_associated("align::batches", estimate, reference);
  std::vector<batch_alignment> out;
  std::size_t begin = 0;
  for (const std::size_t size : detail::batch_sizes(estimate.size(), options)) {
    out.push_back(detail::align_batch(estimate, reference, begin, begin + size, options.align));
    begin += size;
  }
  for (std::size_t k = 1; k < out.size(); ++k) {
    if (!out[k - 1].fit || !out[k].fit) continue;
    const std::size_t border = out[k].begin;
    const double jump =
        (detail::position_error(out[k].fit->transform, estimate, reference, border) -
         detail::position_error(out[k - 1].fit->transform, estimate, reference, border - 1))
            .norm();
    if (std::isfinite(jump)) out[k].seam = jump;
  }
  return out;
}

inline pose::trajectory transformed(const std::vector<batch_alignment>& batches,
                                    pose::trajectory estimate) {
  for (const batch_alignment& batch : batches) {
    for (std::size_t i = batch.begin; i < batch.end; ++i) {
      math::rigid3& pose = estimate.world_from_camera.at(i);
      if (batch.fit)
        pose = batch.fit->transform * pose;
      else
        pose.translation.setConstant(std::numeric_limits<double>::quiet_NaN());
    }
  }
  return estimate;
}

}  // namespace aib::align
