// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/align/trajectory.hpp>
#include <aib/core/error.hpp>
#include <aib/math/sim3.hpp>
#include <aib/pose/registered.hpp>
#include <aib/pose/trajectory.hpp>

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

namespace aib::align {

/// Which frames make a batch: the first of these that is set.
struct batches_options {
  std::vector<std::vector<std::string>> names =
      {};  ///< of each batch; those of no pose are missing
  std::vector<std::vector<std::size_t>> frames = {};  ///< of each batch
  std::vector<std::size_t> sizes = {};                ///< of each batch, one after another
  std::size_t size = 200;         ///< of all batches, one after another; the last has what is left
  trajectory_options align = {};  ///< of each batch
};

/// A batch of frames and how it lies in the world of the reference.
struct batch_alignment {
  std::vector<std::size_t> frames;        ///< of the associated trajectories, in the batch's order
  std::vector<std::string> missing = {};  ///< names of the batch that no pose has
  std::optional<alignment> fit = {};      ///< nothing where the frames do not tell the transform
  std::string degenerate = {};            ///< then why
  std::optional<double> seam =
      {};  ///< jump of the position error from the batch before to this one
};

/// Aligns each batch of associated trajectories on its own. A batch whose frames do not tell its
/// transform is named, not guessed.
///
/// Throws argument_error if the trajectories are not associated, the sizes do not add up to their
/// length, a frame is in two batches or beyond the last, or names are given where poses have none.
std::vector<batch_alignment> batches(const pose::trajectory& estimate,
                                     const pose::trajectory& reference,
                                     const batches_options& options = {});

/// Each batch moved by its transform; the poses of degenerate batches and of frames in no batch
/// become NaN, unregistered.
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

inline std::vector<batch_alignment> batches_of_sizes(std::size_t frames,
                                                     const batches_options& options) {
  std::vector<batch_alignment> out;
  std::size_t begin = 0;
  for (const std::size_t size : batch_sizes(frames, options)) {
    out.push_back({.frames = std::vector<std::size_t>(size)});
    std::iota(out.back().frames.begin(), out.back().frames.end(), begin);
    begin += size;
  }
  return out;
}

inline std::vector<batch_alignment> batches_of_names(const pose::trajectory& estimate,
                                                     const pose::trajectory& reference,
                                                     const batches_options& options) {
  const auto& names = reference.names.empty() ? estimate.names : reference.names;
  if (names.empty()) throw argument_error("align::batches: by name, but no pose has one");
  std::unordered_map<std::string, std::size_t> frame_of;
  for (std::size_t i = 0; i < names.size(); ++i) frame_of.emplace(names[i], i);
  std::vector<batch_alignment> out;
  for (const std::vector<std::string>& batch : options.names) {
    out.emplace_back();
    for (const std::string& name : batch) {
      const auto at = frame_of.find(name);
      if (at == frame_of.end())
        out.back().missing.push_back(name);
      else
        out.back().frames.push_back(at->second);
    }
  }
  return out;
}

inline std::vector<batch_alignment> batch_lists(const pose::trajectory& estimate,
                                                const pose::trajectory& reference,
                                                const batches_options& options) {
  if (!options.names.empty()) return batches_of_names(estimate, reference, options);
  if (options.frames.empty()) return batches_of_sizes(estimate.size(), options);
  std::vector<batch_alignment> out;
  for (const std::vector<std::size_t>& frames : options.frames) out.push_back({.frames = frames});
  return out;
}

/// Throws argument_error unless every frame exists and is in one batch at most.
inline void check_batches(const std::vector<batch_alignment>& batches, std::size_t n) {
  std::vector<bool> taken(n);
  for (const batch_alignment& batch : batches) {
    for (const std::size_t i : batch.frames) {
      if (i >= n) {
        throw argument_error(message("align::batches: frames below ", n, " expected, found ", i));
      }
      if (taken[i]) throw argument_error(message("align::batches: frame ", i, " comes twice"));
      taken[i] = true;
    }
  }
}

/// Error of a position under a transform; NaN where a pose is not finite.
inline Eigen::Vector3d position_error(const math::sim3& ref_from_est,
                                      const pose::trajectory& estimate,
                                      const pose::trajectory& reference,
                                      std::size_t i) {
  return ref_from_est * estimate.world_from_camera[i].translation -
         reference.world_from_camera[i].translation;
}

inline void align_batch(const pose::trajectory& estimate,
                        const pose::trajectory& reference,
                        const trajectory_options& options,
                        batch_alignment& batch) {
  try {
    batch.fit =
        trajectory(select(estimate, batch.frames), select(reference, batch.frames), options);
    for (std::size_t& i : batch.fit->outliers) i = batch.frames[i];
  } catch (const undefined_error& failure) {
    batch.degenerate = failure.what();
  }
}

/// From the last frame of one batch to the first of the next.
inline std::optional<double> seam_of(const batch_alignment& before,
                                     const batch_alignment& batch,
                                     const pose::trajectory& estimate,
                                     const pose::trajectory& reference) {
  if (!before.fit || !batch.fit) return std::nullopt;
  const double jump =
      (position_error(batch.fit->transform, estimate, reference, batch.frames.front()) -
       position_error(before.fit->transform, estimate, reference, before.frames.back()))
          .norm();
  if (!std::isfinite(jump)) return std::nullopt;
  return jump;
}

}  // namespace detail

inline std::vector<batch_alignment> batches(const pose::trajectory& estimate,
                                            const pose::trajectory& reference,
                                            const batches_options& options) {
  pose::check_associated("align::batches", estimate, reference);
  std::vector<batch_alignment> out = detail::batch_lists(estimate, reference, options);
  detail::check_batches(out, estimate.size());
  for (batch_alignment& batch : out) detail::align_batch(estimate, reference, options.align, batch);
  for (std::size_t k = 1; k < out.size(); ++k)
    out[k].seam = detail::seam_of(out[k - 1], out[k], estimate, reference);
  return out;
}

inline pose::trajectory transformed(const std::vector<batch_alignment>& batches,
                                    pose::trajectory estimate) {
  std::vector<bool> moved(estimate.size());
  for (const batch_alignment& batch : batches) {
    if (!batch.fit) continue;
    for (const std::size_t i : batch.frames) {
      math::rigid3& pose = estimate.world_from_camera.at(i);
      pose = batch.fit->transform * pose;
      moved[i] = true;
    }
  }
  for (std::size_t i = 0; i < moved.size(); ++i) {
    if (!moved[i])
      estimate.world_from_camera[i].translation.setConstant(
          std::numeric_limits<double>::quiet_NaN());
  }
  return estimate;
}

}  // namespace aib::align
