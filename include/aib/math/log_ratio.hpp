// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/isa.hpp>

#include <bit>
#include <cstdint>
#include <numbers>

namespace aib::math {

namespace detail {

inline namespace AIB_ISA {

/// The exponent of a positive normal number, as a double.
inline double exponent(double x) {
  // The exponent bits put into the mantissa of 2^52 make 2^52 + exponent + 1023.
  const std::uint64_t bits = std::bit_cast<std::uint64_t>(x) >> 52;
  return std::bit_cast<double>(bits | 0x4330000000000000u) - (0x1p52 + 1023);
}

/// The number with its exponent replaced by 0: in [1, 2).
inline double mantissa(double x) {
  const std::uint64_t bits = std::bit_cast<std::uint64_t>(x);
  return std::bit_cast<double>((bits & 0x000fffffffffffffu) | 0x3ff0000000000000u);
}

}  // namespace AIB_ISA

}  // namespace detail

inline namespace AIB_ISA {

/// ln(a / b) of two positive, finite, normal doubles, within 3e-16 of the largest of 1 and the
/// result. The ratio never overflows; equal numbers give exactly 0.
///
/// Free of branches, calls and tables, so that a loop over it becomes vector code; the same bits on
/// every machine. ln(a / b) = 2 atanh((a - b) / (a + b)) on the mantissas, by its Taylor series.
inline double log_ratio(double a, double b) {
  // The larger mantissa is halved where the ratio leaves [1 / sqrt 2, sqrt 2].
  double ma = detail::mantissa(a);
  double mb = detail::mantissa(b);
  const double half_a = ma > std::numbers::sqrt2 * mb ? 1.0 : 0.0;
  const double half_b = mb > std::numbers::sqrt2 * ma ? 1.0 : 0.0;
  ma -= 0.5 * ma * half_a;
  mb -= 0.5 * mb * half_b;
  const double e = detail::exponent(a) - detail::exponent(b) + (half_a - half_b);

  // |s| <= 0.1716: the first term left out is below 3e-17 of the sum.
  const double s = (ma - mb) / (ma + mb);
  const double z = s * s;
  double series = 1.0 / 19;
  series = series * z + 1.0 / 17;
  series = series * z + 1.0 / 15;
  series = series * z + 1.0 / 13;
  series = series * z + 1.0 / 11;
  series = series * z + 1.0 / 9;
  series = series * z + 1.0 / 7;
  series = series * z + 1.0 / 5;
  series = series * z + 1.0 / 3;
  const double mantissas = 2 * s + 2 * s * (z * series);
  // ln 2 in two parts: the first has few enough bits for e * ln2_high to be exact.
  constexpr double ln2_high = 0x1.62e42fefa3p-1;
  constexpr double ln2_low = 0x1.3de6af278ece6p-42;
  return e * ln2_high + (mantissas + e * ln2_low);
}

}  // namespace AIB_ISA

}  // namespace aib::math
