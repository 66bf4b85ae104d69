// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/core/executor.hpp>
#include <aib/core/isa.hpp>
#include <aib/core/simd_wide.hpp>
#include <aib/math/log_ratio.hpp>
#include <aib/raster/view.hpp>
#include <aib/stats/moments.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
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

/// Whether the rules make another number of a valid estimate.
[[nodiscard]] constexpr bool changes_estimates(const pixel_rules& r) {
  return r.transform != affine{} || r.clamp_min > 0 || r.clamp_log > 0 ||
         r.clamp_max < std::numeric_limits<double>::infinity();
}

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
  double abs_inverse = 0;                         ///< sum |1 / estimate - 1 / reference|
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
  abs_inverse += other.abs_inverse;
  squared_inverse += other.squared_inverse;
  for (std::size_t k = 0; k < 3; ++k) below_delta[k] += other.below_delta[k];
  return *this;
}

/// Throws argument_error unless `other` has the size of the estimate.
template <class Estimate, class Other>
void check_size(std::string_view function,
                raster::view<const Estimate> estimate,
                std::string_view thing,
                raster::view<const Other> other) {
  if (estimate.width == other.width && estimate.height == other.height) return;
  throw argument_error(message(function, ": the estimate is ", estimate.width, "x", estimate.height,
                               ", the ", thing, " ", other.width, "x", other.height,
                               ": downsample one to the other first"));
}

/// Throws argument_error unless both maps, and the mask where there is one, have one size.
template <class Estimate, class Reference>
void check_sizes(std::string_view function,
                 raster::view<const Estimate> estimate,
                 raster::view<const Reference> reference,
                 raster::view<const std::uint8_t> mask = {}) {
  check_size(function, estimate, "reference", reference);
  if (mask.data) check_size(function, estimate, "mask", mask);
}

namespace detail {

inline namespace AIB_ISA {

inline f64x8 load8(const double* p) { return f64x8::load(p); }
inline f64x8 load8(const float* p) { return f64x8::convert(p); }
inline f64x8 load8(const std::uint8_t* p) {
  double inside[8];
  for (std::size_t i = 0; i < 8; ++i) inside[i] = p[i] ? 1.0 : 0.0;
  return f64x8::load(inside);
}

/// Eight from `p`, of which `n` are there: the others are 0.
template <class T>
f64x8 load8(const T* p, std::size_t n) {
  if (n >= 8) return load8(p);
  T some[8] = {};
  std::copy_n(p, n, some);
  return load8(some);
}

}  // namespace AIB_ISA

}  // namespace detail

inline namespace AIB_ISA {

/// Which sums are wanted: those of the log ratio (and the counts) take half the time.
enum class error_set { all, log_ratio };

/// Adds up rows of pixels, eight at a time in fixed lanes: every instruction set gives the same
/// bits.
template <error_set Set = error_set::all>
class error_adder {
 public:
  explicit error_adder(const pixel_rules& rules)
      : rules_(rules), changes_estimate_(changes_estimates(rules)) {}

  /// Adds a row; `mask` is null or as long, of which 0 leaves a pixel out.
  template <class Estimate, class Reference>
  void add(std::span<const Estimate> estimate,
           std::span<const Reference> reference,
           const std::uint8_t* mask);

  /// The sums of all rows so far.
  [[nodiscard]] error_sums result() const;

 private:
  /// Pixels whose log ratios are kept until their mean is known.
  struct block {
    static constexpr std::size_t size = 512;
    f64x8 log_ratio[size / 8];
    f64x8 weight[size / 8];
  };
  /// A pixel that does not count is estimate = reference = 1: all its errors are 0.
  struct pixels {
    f64x8 estimate;
    f64x8 reference;
    f64x8 weight;  ///< 1 where the pixel counts, else 0
  };

  f64x8 transformed(f64x8 raw) const;
  pixels select(f64x8 estimate, f64x8 reference, const std::uint8_t* mask, std::size_t n);
  f64x8 add(const pixels& p);
  void add_errors(const pixels& p, f64x8 log_ratio);
  void add_log_ratios(const block& b, std::size_t n);

  static f64x8 number(double x) { return f64x8::broadcast(x); }
  static f64x8 is_less(f64x8 a, f64x8 b) { return choose(a, b, number(1), number(0)); }
  static f64x8 absolute(f64x8 a) { return max(a, number(0) - a); }

  pixel_rules rules_;
  bool changes_estimate_;  ///< by transform or clamp
  stats::moments log_ratio_;
  f64x8 n_reference_ = number(0);
  f64x8 n_estimate_ = number(0);
  f64x8 abs_log_ = number(0);
  f64x8 abs_difference_ = number(0);
  f64x8 squared_difference_ = number(0);
  f64x8 abs_relative_ = number(0);
  f64x8 squared_relative_ = number(0);
  f64x8 abs_inverse_ = number(0);
  f64x8 squared_inverse_ = number(0);
  f64x8 below_delta_[3] = {number(0), number(0), number(0)};
};

template <error_set Set>
template <class Estimate, class Reference>
void error_adder<Set>::add(std::span<const Estimate> estimate,
                           std::span<const Reference> reference,
                           const std::uint8_t* mask) {
  block b;
  for (std::size_t first = 0; first < estimate.size(); first += block::size) {
    const std::size_t n = std::min(block::size, estimate.size() - first);
    for (std::size_t i = 0; i < n; i += 8) {
      const std::size_t at = first + i;
      const pixels p =
          select(detail::load8(estimate.data() + at, n - i),
                 detail::load8(reference.data() + at, n - i), mask ? mask + at : nullptr, n - i);
      b.log_ratio[i / 8] = add(p);
      b.weight[i / 8] = p.weight;
    }
    add_log_ratios(b, n);
  }
}

template <error_set Set>
f64x8 error_adder<Set>::transformed(f64x8 raw) const {
  const f64x8 e = number(rules_.transform.scale) * raw + number(rules_.transform.shift);
  return min(max(e, number(rules_.clamp_min)), number(rules_.clamp_max));
}

/// Applies the rules.
template <error_set Set>
typename error_adder<Set>::pixels error_adder<Set>::select(f64x8 raw,
                                                           f64x8 reference,
                                                           const std::uint8_t* mask,
                                                           std::size_t n) {
  const f64x8 zero = number(0), inf = number(std::numeric_limits<double>::infinity());
  f64x8 e = raw;
  f64x8 has_estimate = is_less(zero, raw) * is_less(raw, inf);
  f64x8 has_reference =
      is_less(number(rules_.min), reference) * is_less(reference, number(rules_.max));
  if (changes_estimate_) {
    e = transformed(raw);
    has_estimate = has_estimate * is_less(zero, e) * is_less(e, inf);
  }
  if (mask) {
    const f64x8 inside = detail::load8(mask, n);
    has_estimate = has_estimate * inside;
    has_reference = has_reference * inside;
  }
  n_estimate_ = n_estimate_ + has_estimate;
  n_reference_ = n_reference_ + has_reference;
  const f64x8 weight = has_estimate * has_reference;
  return {.estimate = choose(zero, weight, e, number(1)),
          .reference = choose(zero, weight, reference, number(1)),
          .weight = weight};
}

/// Adds all but the moments of the log ratios, and returns those.
template <error_set Set>
f64x8 error_adder<Set>::add(const pixels& p) {
  const f64x8 e = changes_estimate_ ? max(p.estimate, number(rules_.clamp_log)) : p.estimate;
  const f64x8 log_ratio = p.weight * math::log_ratio(p.reference, e);
  if constexpr (Set == error_set::all) add_errors(p, log_ratio);
  return log_ratio;
}

template <error_set Set>
void error_adder<Set>::add_errors(const pixels& p, f64x8 log_ratio) {
  const f64x8 e = p.estimate, r = p.reference;
  const f64x8 per_reference = number(1) / r;
  const f64x8 difference = absolute(e - r);
  const f64x8 relative = difference * per_reference;
  const f64x8 inverse = absolute(number(1) / e - per_reference);
  abs_log_ = abs_log_ + absolute(log_ratio);
  abs_difference_ = abs_difference_ + difference;
  squared_difference_ = squared_difference_ + difference * difference;
  abs_relative_ = abs_relative_ + relative;
  squared_relative_ = squared_relative_ + difference * relative;
  abs_inverse_ = abs_inverse_ + inverse;
  squared_inverse_ = squared_inverse_ + inverse * inverse;
  // Without division: 1.25^k is exact in binary, and so is its product with a float.
  const f64x8 larger = max(e, r), smaller = min(e, r);
  const auto below = [&](double delta) {
    return p.weight * is_less(larger, number(delta) * smaller);
  };
  below_delta_[0] = below_delta_[0] + below(1.25);
  below_delta_[1] = below_delta_[1] + below(1.5625);
  below_delta_[2] = below_delta_[2] + below(1.953125);
}

template <error_set Set>
void error_adder<Set>::add_log_ratios(const block& b, std::size_t n) {
  f64x8 counts = number(0), total = number(0), squares = number(0);
  for (std::size_t i = 0; 8 * i < n; ++i) {
    counts = counts + b.weight[i];
    total = total + b.log_ratio[i];
  }
  const double count = sum(counts);
  const double mean = count > 0 ? sum(total) / count : 0;
  for (std::size_t i = 0; 8 * i < n; ++i) {
    const f64x8 deviation = b.log_ratio[i] - number(mean) * b.weight[i];
    squares = squares + deviation * deviation;
  }
  log_ratio_ += stats::moments::from(static_cast<std::uint64_t>(count), mean, sum(squares));
}

template <error_set Set>
error_sums error_adder<Set>::result() const {
  const auto count = [](f64x8 lanes) { return static_cast<std::uint64_t>(sum(lanes)); };
  return {.log_ratio = log_ratio_,
          .n_reference = count(n_reference_),
          .n_estimate = count(n_estimate_),
          .abs_log = sum(abs_log_),
          .abs_difference = sum(abs_difference_),
          .squared_difference = sum(squared_difference_),
          .abs_relative = sum(abs_relative_),
          .squared_relative = sum(squared_relative_),
          .abs_inverse = sum(abs_inverse_),
          .squared_inverse = sum(squared_inverse_),
          .below_delta = {count(below_delta_[0]), count(below_delta_[1]), count(below_delta_[2])}};
}

/// The sums over all pixels of a frame after one transform; nothing is fitted. Bit-identical for
/// any number of threads and instruction set. Throws argument_error if the sizes differ.
template <error_set Set = error_set::all, class Estimate, class Reference>
error_sums sum_errors(raster::view<const Estimate> estimate,
                      raster::view<const Reference> reference,
                      const pixel_rules& rules,
                      raster::view<const std::uint8_t> mask = {},
                      unsigned threads = 1) {
  check_sizes("depth::errors", estimate, reference, mask);
  constexpr std::size_t pixels_a_chunk = 1 << 16;
  const std::size_t rows = estimate.width ? 1 + pixels_a_chunk / estimate.width : 1;
  const auto sums_of = [&](const chunk& c) {
    error_adder<Set> adder(rules);
    for (std::size_t y = c.begin; y < c.end; ++y)
      adder.add(estimate.row(y), reference.row(y), mask.data ? mask.row(y).data() : nullptr);
    return adder.result();
  };
  const auto combine = [](error_sums total, const error_sums& part) { return total += part; };
  return reduce_chunks(estimate.height, rows, threads, {}, error_sums{}, sums_of, combine);
}

}  // namespace AIB_ISA

}  // namespace aib::depth
