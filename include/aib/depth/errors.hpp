// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/depth/crop.hpp>
#include <aib/depth/depth_map.hpp>
#include <aib/depth/error_sums.hpp>
#include <aib/depth/fit.hpp>
#include <aib/depth/label_sums.hpp>
#include <aib/raster/view.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <string_view>

namespace aib::depth {

/// See pixel_rules for the order of the steps and for `clamp_log`.
struct error_options {
  alignment align = alignment::none;                     ///< fitted to this frame
  double min = 0;                                        ///< a reference counts above it, exclusive
  double max = std::numeric_limits<double>::infinity();  ///< and below it, exclusive
  raster::view<const std::uint8_t> mask = {};            ///< none, or 0 where a pixel is left out
  raster::view<const std::uint16_t> labels = {};         ///< none, or what each pixel shows
  crop_rule crop = crop_rule::none;                      ///< the rest is left out
  affine transform = {};  ///< of a batch or sequence (see fitter), where nothing is aligned here
  double clamp_min = 0;   ///< smaller estimates become this
  double clamp_max = std::numeric_limits<double>::infinity();  ///< larger ones this
  double clamp_log = 0;                                        ///< the same in logarithms alone
  unsigned threads = 1;  ///< 0: all. A frame takes milliseconds: give threads to the frames
};

/// Errors of an estimated depth map over the V pixels valid in estimate and reference;
/// d = ln(reference / estimate), lengths in the unit of the maps. `scale` and `shift` took the
/// estimate to the reference.
struct error_summary {
  double srmse;        ///< mean (d - mean d)^2, the formula of the paper: no root
  double si_log_rmse;  ///< its root
  double silog;        ///< 100 times that root, KITTI's
  double abs_rel;      ///< mean |e - r| / r
  double sq_rel;       ///< mean (e - r)^2 / r
  double rmse;         ///< root of mean (e - r)^2
  double mae;          ///< mean |e - r|
  double rmse_log;     ///< root of mean d^2
  double log10;        ///< mean |log10 e - log10 r|
  double irmse;        ///< root of mean (1 / e - 1 / r)^2
  double imae;         ///< mean |1 / e - 1 / r|
  double delta1;       ///< share with max(e / r, r / e) < 1.25
  double delta2;       ///< ... < 1.25^2
  double delta3;       ///< ... < 1.25^3
  double coverage;     ///< V / valid pixels of the reference
  double scale;
  double shift;
  std::uint64_t n_valid;      ///< V
  std::uint64_t n_reference;  ///< valid pixels of the reference
  std::uint64_t n_estimate;   ///< valid pixels of the estimate
};

/// Name of a number of error_summary, and where it is.
struct error_field {
  std::string_view name;
  double error_summary::*value;
};

/// Every number of error_summary but the counts, in its order: for tables and means.
inline constexpr std::array<error_field, 17> error_fields{{
    {"srmse", &error_summary::srmse},
    {"si_log_rmse", &error_summary::si_log_rmse},
    {"silog", &error_summary::silog},
    {"abs_rel", &error_summary::abs_rel},
    {"sq_rel", &error_summary::sq_rel},
    {"rmse", &error_summary::rmse},
    {"mae", &error_summary::mae},
    {"rmse_log", &error_summary::rmse_log},
    {"log10", &error_summary::log10},
    {"irmse", &error_summary::irmse},
    {"imae", &error_summary::imae},
    {"delta1", &error_summary::delta1},
    {"delta2", &error_summary::delta2},
    {"delta3", &error_summary::delta3},
    {"coverage", &error_summary::coverage},
    {"scale", &error_summary::scale},
    {"shift", &error_summary::shift},
}};

/// Whether a number is a share, of which more is better.
[[nodiscard]] constexpr bool is_share(double error_summary::*field) {
  return field == &error_summary::delta1 || field == &error_summary::delta2 ||
         field == &error_summary::delta3 || field == &error_summary::coverage;
}

/// The errors that sums amount to. Throws undefined_error, with the counts, if no pixel was valid.
error_summary summarize(const error_sums& sums, const affine& transform = {});

/// Errors of one depth map against its reference.
///
/// estimate   h x w, float or double
/// reference  h x w, float or double
///
/// The caller downsamples: maps of two sizes are an argument_error that names both. Throws
/// undefined_error, with the counts, if no pixel is valid in both.
/// Source: Eigen, Puhrsch, Fergus, "Depth map prediction from a single image using a multi-scale
/// deep network", NeurIPS 2014; silog and irmse: KITTI depth benchmark, Uhrig et al., 3DV 2017.
template <class Estimate, class Reference>
error_summary errors(raster::view<const Estimate> estimate,
                     raster::view<const Reference> reference,
                     const error_options& options = {});

/// The part of the options that does not depend on the frame.
[[nodiscard]] inline pixel_rules rules_of(const error_options& o) {
  return {.min = o.min,
          .max = o.max,
          .transform = o.transform,
          .clamp_min = o.clamp_min,
          .clamp_max = o.clamp_max,
          .clamp_log = o.clamp_log};
}

inline error_summary summarize(const error_sums& sums, const affine& transform) {
  const std::uint64_t n_valid = sums.log_ratio.count();
  if (n_valid == 0) {
    throw undefined_error(message("depth::errors: no pixel is valid in both maps, ",
                                  sums.n_estimate, " in the estimate, ", sums.n_reference,
                                  " in the reference"));
  }
  const auto n = static_cast<double>(n_valid);
  const auto share = [&](std::size_t k) { return static_cast<double>(sums.below_delta[k]) / n; };
  return {
      .srmse = sums.log_ratio.variance(),
      .si_log_rmse = sums.log_ratio.deviation(),
      .silog = 100 * sums.log_ratio.deviation(),
      .abs_rel = sums.abs_relative / n,
      .sq_rel = sums.squared_relative / n,
      .rmse = std::sqrt(sums.squared_difference / n),
      .mae = sums.abs_difference / n,
      .rmse_log = std::sqrt(sums.log_ratio.mean_square()),
      .log10 = sums.abs_log / n / std::numbers::ln10,
      .irmse = std::sqrt(sums.squared_inverse / n),
      .imae = sums.abs_inverse / n,
      .delta1 = share(0),
      .delta2 = share(1),
      .delta3 = share(2),
      .coverage = n / static_cast<double>(sums.n_reference),
      .scale = transform.scale,
      .shift = transform.shift,
      .n_valid = n_valid,
      .n_reference = sums.n_reference,
      .n_estimate = sums.n_estimate,
  };
}

/// The sums of a frame, and what took its estimates to its references: the fit that the options ask
/// for, or their transform.
struct frame_sums {
  error_sums sums;
  affine transform = {};
  label_sums by_label = {};  ///< where the options have labels
};

/// A frame without a valid pixel has the identity for a fit. Throws argument_error if the sizes
/// differ, or if the options have both a fit and a transform.
template <error_set Set = error_set::all, class Estimate, class Reference>
frame_sums measure(raster::view<const Estimate> estimate,
                   raster::view<const Reference> reference,
                   const error_options& options) {
  check_sizes("depth::errors", estimate, reference, options.mask);
  if (options.labels.data) check_size("depth::errors", estimate, "label image", options.labels);
  estimate = cropped(estimate, options.crop);
  reference = cropped(reference, options.crop);
  const raster::view<const std::uint8_t> mask = cropped(options.mask, options.crop);
  const raster::view<const std::uint16_t> labels = cropped(options.labels, options.crop);
  pixel_rules rules = rules_of(options);
  if (options.align != alignment::none) {
    if (options.transform != affine{})
      throw argument_error("depth::errors: either `align` or `transform` expected, found both");
    fitter fit(options.align, rules);
    fit.add(estimate, reference, mask);
    if (fit.n_valid() > 0) rules.transform = fit.result();
  }
  frame_sums frame{sum_errors<Set>(estimate, reference, rules, mask, options.threads),
                   rules.transform};
  if (labels.data) frame.by_label = sum_errors_by_label(estimate, reference, labels, rules, mask);
  return frame;
}

/// The srmse of `errors` alone, to the same bits, in half the time. Throws as `errors` does.
template <class Estimate, class Reference>
double srmse(raster::view<const Estimate> estimate,
             raster::view<const Reference> reference,
             const error_options& options = {}) {
  const frame_sums frame = measure<error_set::log_ratio>(estimate, reference, options);
  return summarize(frame.sums, frame.transform).srmse;
}

template <class Estimate, class Reference>
error_summary errors(raster::view<const Estimate> estimate,
                     raster::view<const Reference> reference,
                     const error_options& options) {
  const frame_sums frame = measure(estimate, reference, options);
  return summarize(frame.sums, frame.transform);
}

/// What is known of a set of pixels: its sums, and its errors where it has a valid pixel.
struct error_record {
  error_sums sums = {};
  std::optional<error_summary> errors = {};
};

[[nodiscard]] inline error_record record_of(const error_sums& sums, const affine& transform) {
  error_record record{sums};
  if (sums.log_ratio.count() > 0) record.errors = summarize(sums, transform);
  return record;
}

/// Errors of the pixels of each label that occurs in `options.labels`: of glass, frame, truss ...
/// Where something is fitted, it is fitted to the whole frame. Throws argument_error where there
/// are no labels, and as errors does.
template <class Estimate, class Reference>
std::map<std::uint16_t, error_record> errors_by_label(raster::view<const Estimate> estimate,
                                                      raster::view<const Reference> reference,
                                                      const error_options& options) {
  if (!options.labels.data) throw argument_error("depth::errors_by_label: labels expected");
  const frame_sums frame = measure(estimate, reference, options);
  std::map<std::uint16_t, error_record> records;
  for (const auto& [label, sums] : frame.by_label)
    records.emplace(label, record_of(sums, frame.transform));
  return records;
}

template <class Estimate, class Reference>
error_summary errors(const basic_depth_map<Estimate>& estimate,
                     const basic_depth_map<Reference>& reference,
                     const error_options& options = {}) {
  return errors(estimate.values.view(), reference.values.view(), options);
}

}  // namespace aib::depth
