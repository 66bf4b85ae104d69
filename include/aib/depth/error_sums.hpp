// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/core/executor.hpp>
#include <aib/core/isa.hpp>
#include <aib/math/log_ratio.hpp>
#include <aib/raster/view.hpp>
#include <aib/stats/moments.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>

namespace aib::depth {

/// `scale * depth + shift`.
struct affine {
  double scale = 1;
  double shift = 0;

  friend bool operator==(const affine&, const affine&) = default;
};

/// Which pixels count, and what happens to an estimate before it is compared, in this order: a
/// reference counts strictly between `min` and `max`; an estimate where it is finite and > 0; it is
/// transformed, clamped, and counts where the outcome is finite and > 0.
struct pixel_rules {
  double min = 0;
  double max = std::numeric_limits<double>::infinity();
  affine transform = {};  ///< reference_from_estimate
  double clamp_min = 0;
  double clamp_max = std::numeric_limits<double>::infinity();
  double clamp_log = 0;  ///< least estimate within logarithms, other errors take it as it is
};

/// What the depth errors of a set of pixels are made of. Mergeable: `a += b`.
///
/// The log ratio ln(reference / estimate) is kept as moments, so that a small spread about a large
/// mean survives.
struct error_sums {
  stats::moments log_ratio = {};
  std::uint64_t n_reference = 0;                  ///< pixels with a valid reference
  std::uint64_t n_estimate = 0;                   ///< pixels with a valid estimate
  double abs_log = 0;                             ///< sum |ln(reference / estimate)|
  double abs_difference = 0;                      ///< sum |estimate - reference|
  double squared_difference = 0;                  ///< sum (estimate - reference)^2
  double abs_relative = 0;                        ///< sum |estimate - reference| / reference
  double squared_relative = 0;                    ///< sum (estimate - reference)^2 / reference
  double squared_inverse = 0;                     ///< sum (1 / estimate - 1 / reference)^2
  std::array<std::uint64_t, 3> below_delta = {};  ///< ratios strictly below 1.25, 1.25^2, 1.25^3

  error_sums& operator+=(const error_sums& other);
};

inline error_sums& error_sums::operator+=(const error_sums& other) {
  log_ratio += other.log_ratio;
  n_reference += other.n_reference;
  n_estimate += other.n_estimate;
  abs_log += other.abs_log;
  abs_difference += other.abs_difference;
  squared_difference += other.squared_difference;
  abs_relative += other.abs_relative;
  squared_relative += other.squared_relative;
  squared_inverse += other.squared_inverse;
  for (std::size_t k = 0; k < 3; ++k) below_delta[k] += other.below_delta[k];
  return *this;
}

/// Throws argument_error unless both maps, and the mask where there is one, have one size.
template <class Estimate, class Reference>
void check_sizes(std::string_view function,
                 raster::view<const Estimate> estimate,
                 raster::view<const Reference> reference,
                 raster::view<const std::uint8_t> mask = {}) {
  const auto fail = [&](std::string_view thing, std::size_t width, std::size_t height) {
    throw argument_error(message(function, ": the estimate is ", estimate.width, "x",
                                 estimate.height, ", the ", thing, " ", width, "x", height,
                                 ": downsample one to the other first"));
  };
  if (estimate.width != reference.width || estimate.height != reference.height)
    fail("reference", reference.width, reference.height);
  if (mask.data && (estimate.width != mask.width || estimate.height != mask.height))
    fail("mask", mask.width, mask.height);
}

namespace detail {

inline namespace AIB_ISA {

/// term(0) + ... + term(size - 1), added in a tree of halves.
template <std::size_t size, class Term>
double tree_sum(const Term& term) {
  if constexpr (size == 1) {
    return term(0);
  } else if constexpr (size > 32) {
    return tree_sum<size / 2>([&](std::size_t i) { return term(i) + term(i + size / 2); });
  } else {
    double half[size / 2];
    for (std::size_t i = 0; i < size / 2; ++i) half[i] = term(i) + term(i + size / 2);
    return tree_sum<size / 2>([&](std::size_t i) { return half[i]; });
  }
}

}  // namespace AIB_ISA

}  // namespace detail

inline namespace AIB_ISA {

/// Collects pixels and adds them up block by block. The loops run over whole blocks of doubles,
/// have no branch and sum in a fixed tree: compilers make vector code of them, and every
/// instruction set gives the same bits.
class error_block {
 public:
  static constexpr std::size_t size = 256;

  explicit error_block(const pixel_rules& rules) : rules_(rules) {}

  /// Adds n pixels; `mask` is null or n bytes, of which 0 leaves a pixel out.
  template <class Estimate, class Reference>
  void add(const Estimate* estimate,
           const Reference* reference,
           const std::uint8_t* mask,
           std::size_t n);

  /// The sums of all pixels so far.
  error_sums result();

 private:
  struct column {
    alignas(64) double values[size];
    double& operator[](std::size_t i) { return values[i]; }
    const double& operator[](std::size_t i) const { return values[i]; }
  };

  template <class Scalar>
  void take(column& to, const Scalar* from, const std::uint8_t* mask, std::size_t n) const;
  void flush();
  void select();
  [[nodiscard]] error_sums errors();

  pixel_rules rules_;
  error_sums total_;
  std::size_t filled_ = 0;
  column estimate_;
  column reference_;
  column weight_;  ///< 1 where the pixel counts, else 0
  column log_ratio_;
  column per_estimate_;
  column per_reference_;
};

template <class Estimate, class Reference>
void error_block::add(const Estimate* estimate,
                      const Reference* reference,
                      const std::uint8_t* mask,
                      std::size_t n) {
  while (n > 0) {
    const std::size_t k = std::min(n, size - filled_);
    take(estimate_, estimate, mask, k);
    take(reference_, reference, mask, k);
    filled_ += k;
    if (filled_ == size) flush();
    estimate += k;
    reference += k;
    if (mask) mask += k;
    n -= k;
  }
}

template <class Scalar>
void error_block::take(column& to,
                       const Scalar* from,
                       const std::uint8_t* mask,
                       std::size_t n) const {
  double* const at = to.values + filled_;
  for (std::size_t i = 0; i < n; ++i) at[i] = static_cast<double>(from[i]);
  if (!mask) return;
  for (std::size_t i = 0; i < n; ++i) at[i] = mask[i] ? at[i] : 0.0;
}

inline error_sums error_block::result() {
  if (filled_ > 0) flush();
  return total_;
}

inline void error_block::flush() {
  for (std::size_t i = filled_; i < size; ++i) estimate_[i] = reference_[i] = 0;
  filled_ = 0;
  select();
  total_ += errors();
}

/// Applies the rules. A pixel that does not count becomes estimate = reference = 1: all its errors
/// are 0.
inline void error_block::select() {
  constexpr double inf = std::numeric_limits<double>::infinity();
  const pixel_rules rules = rules_;
  column has_estimate, has_reference;
  for (std::size_t i = 0; i < size; ++i) {
    const double raw = estimate_[i];
    const double r = reference_[i];
    double e = rules.transform.scale * raw + rules.transform.shift;
    e = e < rules.clamp_min ? rules.clamp_min : e;
    e = e > rules.clamp_max ? rules.clamp_max : e;
    const double raw_valid = (raw > 0 ? 1.0 : 0.0) * (raw < inf ? 1.0 : 0.0);
    const double in_front = (e > 0 ? 1.0 : 0.0) * (e < inf ? 1.0 : 0.0);
    has_estimate[i] = raw_valid * in_front;
    has_reference[i] = (r > rules.min ? 1.0 : 0.0) * (r < rules.max ? 1.0 : 0.0);
    weight_[i] = has_estimate[i] * has_reference[i];
    estimate_[i] = weight_[i] > 0 ? e : 1.0;
    reference_[i] = weight_[i] > 0 ? r : 1.0;
  }
  const auto count = [](const column& c) {
    return static_cast<std::uint64_t>(detail::tree_sum<size>([&](std::size_t i) { return c[i]; }));
  };
  total_.n_estimate += count(has_estimate);
  total_.n_reference += count(has_reference);
}

inline error_sums error_block::errors() {
  const double clamp_log = rules_.clamp_log;
  column larger, smaller;
  for (std::size_t i = 0; i < size; ++i) {
    const double in_log = estimate_[i] < clamp_log ? clamp_log : estimate_[i];
    log_ratio_[i] = math::log_ratio(reference_[i], in_log) * weight_[i];
    per_estimate_[i] = 1 / estimate_[i];
    per_reference_[i] = 1 / reference_[i];
    larger[i] = estimate_[i] > reference_[i] ? estimate_[i] : reference_[i];
    smaller[i] = estimate_[i] > reference_[i] ? reference_[i] : estimate_[i];
  }
  const auto sum = [](const auto& term) { return detail::tree_sum<size>(term); };
  const column& e = estimate_;
  const column& r = reference_;
  const double n = sum([&](std::size_t i) { return weight_[i]; });
  const double mean = n > 0 ? sum([&](std::size_t i) { return log_ratio_[i]; }) / n : 0;
  const double squares = sum([&](std::size_t i) {
    const double deviation = (log_ratio_[i] - mean) * weight_[i];
    return deviation * deviation;
  });
  // Without division: 1.25^k is exact in binary, and so is its product with a float.
  const auto below = [&](double delta) {
    column is_below;
    for (std::size_t i = 0; i < size; ++i) is_below[i] = larger[i] < delta * smaller[i] ? 1.0 : 0.0;
    const double count = sum([&](std::size_t i) { return is_below[i] * weight_[i]; });
    return static_cast<std::uint64_t>(count);
  };
  return {
      .log_ratio = stats::moments::from(static_cast<std::uint64_t>(n), mean, squares),
      .abs_log = sum([&](std::size_t i) { return std::abs(log_ratio_[i]); }),
      .abs_difference = sum([&](std::size_t i) { return std::abs(e[i] - r[i]); }),
      .squared_difference = sum([&](std::size_t i) { return (e[i] - r[i]) * (e[i] - r[i]); }),
      .abs_relative = sum([&](std::size_t i) { return std::abs(e[i] - r[i]) * per_reference_[i]; }),
      .squared_relative =
          sum([&](std::size_t i) { return (e[i] - r[i]) * (e[i] - r[i]) * per_reference_[i]; }),
      .squared_inverse = sum([&](std::size_t i) {
        const double difference = per_estimate_[i] - per_reference_[i];
        return difference * difference;
      }),
      .below_delta = {below(1.25), below(1.5625), below(1.953125)},
  };
}

/// The sums over all pixels of a frame after one transform; nothing is fitted. Bit-identical for
/// any number of threads and instruction set. Throws argument_error if the sizes differ.
template <class Estimate, class Reference>
error_sums sum_errors(raster::view<const Estimate> estimate,
                      raster::view<const Reference> reference,
                      const pixel_rules& rules,
                      raster::view<const std::uint8_t> mask = {},
                      unsigned threads = 1) {
  check_sizes("depth::errors", estimate, reference, mask);
  constexpr std::size_t pixels_a_chunk = 1 << 16;
  const std::size_t rows = estimate.width ? 1 + pixels_a_chunk / estimate.width : 1;
  const auto sums_of = [&](const chunk& c) {
    error_block block(rules);
    for (std::size_t y = c.begin; y < c.end; ++y) {
      block.add(estimate.row(y).data(), reference.row(y).data(),
                mask.data ? mask.row(y).data() : nullptr, estimate.width);
    }
    return block.result();
  };
  const auto combine = [](error_sums total, const error_sums& part) { return total += part; };
  return reduce_chunks(estimate.height, rows, threads, {}, error_sums{}, sums_of, combine);
}

}  // namespace AIB_ISA

}  // namespace aib::depth
