// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/depth/crop.hpp>
#include <aib/depth/depth_map.hpp>
#include <aib/depth/error_sums.hpp>
#include <aib/depth/fit.hpp>
#include <aib/raster/view.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <string_view>

namespace aib::depth {

/// See pixel_rules for the order of the steps and for `clamp_log`.
struct error_options {
  alignment align = alignment::none;                     ///< fitted to this frame
  double min = 0;                                        ///< a reference counts above it, exclusive
  double max = std::numeric_limits<double>::infinity();  ///< and below it, exclusive
  raster::view<const std::uint8_t> mask = {};            ///< none, or 0 where a pixel is left out
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
inline constexpr std::array<error_field, 16> error_fields{{
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
    {"delta1", &error_summary::delta1},
    {"delta2", &error_summary::delta2},
    {"delta3", &error_summary::delta3},
    {"coverage", &error_summary::coverage},
    {"scale", &error_summary::scale},
    {"shift", &error_summary::shift},
}};

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
};

/// A frame without a valid pixel has the identity for a fit. Throws argument_error if the sizes
/// differ, or if the options have both a fit and a transform.
template <class Estimate, class Reference>
frame_sums measure(raster::view<const Estimate> estimate,
                   raster::view<const Reference> reference,
                   const error_options& options) {
  check_sizes("depth::errors", estimate, reference, options.mask);
  estimate = cropped(estimate, options.crop);
  reference = cropped(reference, options.crop);
  const raster::view<const std::uint8_t> mask = cropped(options.mask, options.crop);
  pixel_rules rules = rules_of(options);
  if (options.align != alignment::none) {
    if (options.transform != affine{})
      throw argument_error("depth::errors: either `align` or `transform` expected, found both");
    fitter fit(options.align, rules);
    fit.add(estimate, reference, mask);
    if (fit.n_valid() > 0) rules.transform = fit.result();
  }
  return {sum_errors(estimate, reference, rules, mask, options.threads), rules.transform};
}

template <class Estimate, class Reference>
error_summary errors(raster::view<const Estimate> estimate,
                     raster::view<const Reference> reference,
                     const error_options& options) {
  const frame_sums frame = measure(estimate, reference, options);
  return summarize(frame.sums, frame.transform);
}

template <class Estimate, class Reference>
error_summary errors(const basic_depth_map<Estimate>& estimate,
                     const basic_depth_map<Reference>& reference,
                     const error_options& options = {}) {
  return errors(estimate.values.view(), reference.values.view(), options);
}

}  // namespace aib::depth
