// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/depth/depth_map.hpp>
#include <aib/depth/error_sums.hpp>
#include <aib/raster/view.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

namespace aib::depth {

/// The error of a pixel that a confidence is held against.
enum class pixel_error {
  relative,    ///< |e - r| / r
  difference,  ///< |e - r|
  log_ratio,   ///< |ln r - ln e|
};

struct risk_options {
  pixel_error error = pixel_error::relative;
  std::size_t steps = 100;                               ///< of the curves
  double min = 0;                                        ///< a reference counts above it, exclusive
  double max = std::numeric_limits<double>::infinity();  ///< and below it, exclusive
  raster::view<const std::uint8_t> mask = {};            ///< none, or 0 where a pixel is left out
  affine transform = {};                                 ///< of the estimate, see fitter
};

/// Mean error of the most confident pixels against their share. Curve k is at share (k + 1) /
/// steps.
struct risk_curve {
  std::vector<double> coverage;  ///< share of the pixels kept, rising to 1
  std::vector<double> risk;      ///< mean error of the most confident ones
  std::vector<double> oracle;    ///< mean error of the least wrong ones: no confidence does better
  double aurc;                   ///< area under `risk`
  double ause;                   ///< area between both curves in units of the overall mean error
  std::uint64_t n_valid;         ///< pixels valid in both maps
  std::uint64_t n_unsure;        ///< of those, without a finite confidence: they are kept last
};

/// Whether a confidence map knows where its depth map is wrong. The order of the confidences alone
/// counts, so that any rising scale gives the same; pixels of one confidence share their mean
/// error.
///
/// ause 0: the confidence sorts the pixels by their error; a random one gives a constant risk. A
/// perfect depth map has ause 0.
/// Throws undefined_error if no pixel is valid in both maps, argument_error if sizes differ or
/// steps is 0. Source: Ilg et al., "Uncertainty estimates and multi-hypotheses networks for optical
/// flow", ECCV 2018 (sparsification error); Geifman, El-Yaniv, NeurIPS 2017 (risk, coverage).
[[nodiscard]] risk_curve risk_coverage(raster::view<const float> estimate,
                                       raster::view<const float> reference,
                                       raster::view<const float> confidence,
                                       const risk_options& options = {});

namespace detail {

struct judged_pixel {
  double error;
  float confidence;
};

inline double error_of(double e, double r, pixel_error kind) {
  switch (kind) {
    case pixel_error::difference:
      return std::abs(e - r);
    case pixel_error::log_ratio:
      return std::abs(std::log(r / e));
    default:
      return std::abs(e - r) / r;
  }
}

inline std::vector<judged_pixel> judge(raster::view<const float> estimate,
                                       raster::view<const float> reference,
                                       raster::view<const float> confidence,
                                       const risk_options& o) {
  std::vector<judged_pixel> pixels;
  for (std::size_t y = 0; y < estimate.height; ++y) {
    for (std::size_t x = 0; x < estimate.width; ++x) {
      const auto r = static_cast<double>(reference(x, y)),
                 raw = static_cast<double>(estimate(x, y));
      const double e = o.transform.scale * raw + o.transform.shift;
      const bool counts = (!o.mask.data || o.mask(x, y) != 0) && r > o.min && r < o.max &&
                          is_valid(raw) && is_valid(e);
      if (!counts) continue;
      const float sure = confidence(x, y);
      const float lowest = -std::numeric_limits<float>::infinity();
      pixels.push_back({error_of(e, r, o.error), std::isnan(sure) ? lowest : sure});
    }
  }
  return pixels;
}

/// Mean error of the first share (k + 1) / steps of the pixels, by their running sums.
inline std::vector<double> mean_of_first(const std::vector<double>& errors, std::size_t steps) {
  std::vector<double> sums(errors.size());
  std::partial_sum(errors.begin(), errors.end(), sums.begin());
  std::vector<double> means;
  for (std::size_t k = 1; k <= steps; ++k) {
    const std::size_t n = std::max<std::size_t>(1, k * errors.size() / steps);
    means.push_back(sums[n - 1] / static_cast<double>(n));
  }
  return means;
}

/// The errors, the most confident pixel first; the mean of all where several are as confident.
inline std::vector<double> by_confidence(std::vector<judged_pixel> pixels) {
  std::sort(pixels.begin(), pixels.end(), [](const judged_pixel& a, const judged_pixel& b) {
    return a.confidence != b.confidence ? a.confidence > b.confidence : a.error < b.error;
  });
  std::vector<double> errors;
  for (std::size_t first = 0, end = 0; first < pixels.size(); first = end) {
    double sum = 0;
    for (; end < pixels.size() && pixels[end].confidence == pixels[first].confidence; ++end)
      sum += pixels[end].error;
    errors.resize(end, sum / static_cast<double>(end - first));
  }
  return errors;
}

}  // namespace detail

inline risk_curve risk_coverage(raster::view<const float> estimate,
                                raster::view<const float> reference,
                                raster::view<const float> confidence,
                                const risk_options& options) {
  check_sizes("depth::risk_coverage", estimate, reference, options.mask);
  check_size("depth::risk_coverage", estimate, "confidence map", confidence);
  if (options.steps == 0) throw argument_error("depth::risk_coverage: steps >= 1 expected");
  auto pixels = detail::judge(estimate, reference, confidence, options);
  if (pixels.empty())
    throw undefined_error("depth::risk_coverage: no pixel is valid in estimate and reference");
  std::vector<double> best(pixels.size());
  std::transform(pixels.begin(), pixels.end(), best.begin(), [](const auto& p) { return p.error; });
  std::sort(best.begin(), best.end());
  const auto unsure = std::count_if(pixels.begin(), pixels.end(),
                                    [](const auto& p) { return !std::isfinite(p.confidence); });
  risk_curve curve{};
  curve.n_valid = pixels.size();
  curve.n_unsure = static_cast<std::uint64_t>(unsure);
  curve.risk = detail::mean_of_first(detail::by_confidence(std::move(pixels)), options.steps);
  curve.oracle = detail::mean_of_first(best, options.steps);
  const auto steps = static_cast<double>(options.steps);
  const double overall = curve.oracle.back();
  for (std::size_t k = 0; k < options.steps; ++k) {
    curve.coverage.push_back(static_cast<double>(k + 1) / steps);
    curve.aurc += curve.risk[k] / steps;
    if (overall > 0) curve.ause += (curve.risk[k] - curve.oracle[k]) / overall / steps;
  }
  return curve;
}

}  // namespace aib::depth
