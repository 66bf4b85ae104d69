// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/depth/error_sums.hpp>
#include <aib/raster/view.hpp>
#include <aib/stats/moments.hpp>
#include <aib/stats/quantiles.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace aib::depth {

/// How the scale of an estimate, and its shift, follow from the pixels valid in both maps.
enum class alignment {
  none,          ///< the depths as they are
  median,        ///< median reference / median estimate, numpy's median
  median_lower,  ///< the same with the lower of two middle values, torch's median
  scale,         ///< least squares: sum er / sum ee
  scale_l1,      ///< least absolute differences by ten reweighted steps, as CUT3R has it
  scale_shift,   ///< least squares in scale and shift
  log,           ///< exp of the mean log ratio: the scale that srmse is blind to
};

/// Fits the scale (and shift) that takes estimates to references, over one frame, a batch or a
/// sequence: `add` every frame, then `result`. Fitters of parts merge by `a += b`.
///
/// The medians and scale_l1 keep every valid pair of pixels, 16 bytes each; the others sums alone.
class fitter {
 public:
  /// Only the validity of `rules` is used: min and max of the reference.
  explicit fitter(alignment kind = alignment::none, const pixel_rules& rules = {})
      : kind_(kind), rules_(rules) {}

  /// Throws argument_error if the sizes differ.
  template <class Estimate, class Reference>
  void add(raster::view<const Estimate> estimate,
           raster::view<const Reference> reference,
           raster::view<const std::uint8_t> mask = {});

  /// A fitter of nothing (alignment::none) becomes the other. Throws argument_error if kinds
  /// differ.
  fitter& operator+=(const fitter& other);

  /// Pixels valid in both maps, 0 for alignment::none.
  [[nodiscard]] std::uint64_t n_valid() const;

  /// Throws undefined_error if no pixel was valid in both, or if every estimate is the same while a
  /// shift is asked for. Identity for alignment::none.
  [[nodiscard]] affine result() const;

 private:
  /// Means, and sums of products of deviations from them.
  struct pair_moments {
    double n = 0;
    double mean_estimate = 0;
    double mean_reference = 0;
    double estimate_estimate = 0;
    double estimate_reference = 0;

    pair_moments& operator+=(const pair_moments& other);
  };

  [[nodiscard]] bool counts(double estimate, double reference) const {
    return estimate > 0 && std::isfinite(estimate) && reference > rules_.min &&
           reference < rules_.max;
  }
  template <class Estimate, class Reference>
  void add_row(std::span<const Estimate> estimate,
               std::span<const Reference> reference,
               const std::uint8_t* mask);
  [[nodiscard]] bool keeps_pairs() const {
    return kind_ == alignment::median || kind_ == alignment::median_lower ||
           kind_ == alignment::scale_l1;
  }
  [[nodiscard]] affine median() const;
  [[nodiscard]] affine least_absolute() const;
  [[nodiscard]] affine least_squares() const;

  alignment kind_;
  pixel_rules rules_;
  stats::moments log_ratio_;
  pair_moments pairs_;
  std::vector<double> estimates_;
  std::vector<double> references_;
};

template <class Estimate, class Reference>
void fitter::add(raster::view<const Estimate> estimate,
                 raster::view<const Reference> reference,
                 raster::view<const std::uint8_t> mask) {
  check_sizes("depth::fitter", estimate, reference, mask);
  if (kind_ == alignment::log) {
    const pixel_rules valid = {.min = rules_.min, .max = rules_.max};
    log_ratio_ += sum_errors<error_set::log_ratio>(estimate, reference, valid, mask).log_ratio;
  } else if (kind_ != alignment::none) {
    for (std::size_t y = 0; y < estimate.height; ++y)
      add_row(estimate.row(y), reference.row(y), mask.data ? mask.row(y).data() : nullptr);
  }
}

template <class Estimate, class Reference>
void fitter::add_row(std::span<const Estimate> estimate,
                     std::span<const Reference> reference,
                     const std::uint8_t* mask) {
  pair_moments row;
  // Sums about the first pair of the row, so that no digits are lost to a large mean.
  double first_e = 0, first_r = 0, sum_e = 0, sum_r = 0, sum_ee = 0, sum_er = 0;
  for (std::size_t x = 0; x < estimate.size(); ++x) {
    const auto e = static_cast<double>(estimate[x]);
    const auto r = static_cast<double>(reference[x]);
    if ((mask && mask[x] == 0) || !counts(e, r)) continue;
    if (keeps_pairs()) {
      estimates_.push_back(e);
      references_.push_back(r);
      continue;
    }
    if (row.n == 0) {
      first_e = e;
      first_r = r;
    }
    ++row.n;
    sum_e += e - first_e;
    sum_r += r - first_r;
    sum_ee += (e - first_e) * (e - first_e);
    sum_er += (e - first_e) * (r - first_r);
  }
  if (row.n == 0) return;
  row.mean_estimate = first_e + sum_e / row.n;
  row.mean_reference = first_r + sum_r / row.n;
  row.estimate_estimate = sum_ee - sum_e * sum_e / row.n;
  row.estimate_reference = sum_er - sum_e * sum_r / row.n;
  pairs_ += row;
}

inline fitter::pair_moments& fitter::pair_moments::operator+=(const pair_moments& other) {
  if (other.n == 0) return *this;
  const double share = other.n / (n + other.n);
  const double apart_e = other.mean_estimate - mean_estimate;
  const double apart_r = other.mean_reference - mean_reference;
  estimate_estimate += other.estimate_estimate + apart_e * apart_e * n * share;
  estimate_reference += other.estimate_reference + apart_e * apart_r * n * share;
  mean_estimate += apart_e * share;
  mean_reference += apart_r * share;
  n += other.n;
  return *this;
}

inline fitter& fitter::operator+=(const fitter& other) {
  if (kind_ == alignment::none) return *this = other;
  if (other.kind_ != kind_) throw argument_error("depth::fitter: merged fits differ in kind");
  log_ratio_ += other.log_ratio_;
  pairs_ += other.pairs_;
  estimates_.insert(estimates_.end(), other.estimates_.begin(), other.estimates_.end());
  references_.insert(references_.end(), other.references_.begin(), other.references_.end());
  return *this;
}

inline std::uint64_t fitter::n_valid() const {
  return log_ratio_.count() + static_cast<std::uint64_t>(pairs_.n) + estimates_.size();
}

inline affine fitter::result() const {
  if (kind_ == alignment::none) return {};
  if (n_valid() == 0)
    throw undefined_error("depth::fitter: no pixel is valid in estimate and reference");
  switch (kind_) {
    case alignment::median:
    case alignment::median_lower:
      return median();
    case alignment::scale_l1:
      return least_absolute();
    case alignment::log:
      return {std::exp(log_ratio_.mean()), 0};
    default:
      return least_squares();
  }
}

inline affine fitter::median() const {
  const auto rule =
      kind_ == alignment::median ? stats::quantile_rule::midpoint : stats::quantile_rule::lower;
  const std::span<const double> e = estimates_, r = references_;
  return {stats::quantile(r, 0.5, rule) / stats::quantile(e, 0.5, rule), 0};
}

/// Weiszfeld's reweighted least squares, started at the ratio of the means and stopped after ten
/// steps: close to the least absolute differences, and the number CUT3R and pi3 report.
inline affine fitter::least_absolute() const {
  constexpr int steps = 10;
  constexpr double least_residual = 1e-8;
  double sum_estimate = 0, sum_reference = 0;
  for (const double e : estimates_) sum_estimate += e;
  for (const double r : references_) sum_reference += r;
  double scale = sum_reference / sum_estimate;
  for (int step = 0; step < steps; ++step) {
    double estimate_reference = 0, estimate_estimate = 0;
    for (std::size_t i = 0; i < estimates_.size(); ++i) {
      const double e = estimates_[i], r = references_[i];
      const double weight = 1 / (std::abs(scale * e - r) + least_residual);
      estimate_reference += weight * e * r;
      estimate_estimate += weight * e * e;
    }
    scale = estimate_reference / estimate_estimate;
  }
  return {scale, 0};
}

inline affine fitter::least_squares() const {
  const pair_moments& p = pairs_;
  if (kind_ == alignment::scale) {
    return {(p.estimate_reference + p.n * p.mean_estimate * p.mean_reference) /
                (p.estimate_estimate + p.n * p.mean_estimate * p.mean_estimate),
            0};
  }
  if (!(p.estimate_estimate > 0)) {
    throw undefined_error(message("depth::fitter: scale and shift of ", n_valid(),
                                  " pixels with one and the same estimate"));
  }
  const double scale = p.estimate_reference / p.estimate_estimate;
  return {scale, p.mean_reference - scale * p.mean_estimate};
}

}  // namespace aib::depth
