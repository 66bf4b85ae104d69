// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/isa.hpp>
#include <aib/core/simd.hpp>

#include <numbers>

namespace aib::math {

inline namespace AIB_ISA {

/// ln(a / b) in four lanes, of positive, finite, normal doubles: within 3e-16 of the largest of 1
/// and the result. The ratio never overflows; equal numbers give exactly 0; the same bits on every
/// machine.
///
/// ln(a / b) = 2 atanh((a - b) / (a + b)), taken on the mantissas by its Taylor series.
inline f64x4 log_ratio(f64x4 a, f64x4 b) {
  const f64x4 zero = f64x4::broadcast(0), one = f64x4::broadcast(1);
  const f64x4 half = f64x4::broadcast(0.5), root = f64x4::broadcast(std::numbers::sqrt2);

  // The larger mantissa is halved where the ratio leaves [1 / sqrt 2, sqrt 2].
  f64x4 ma = mantissa(a), mb = mantissa(b);
  const f64x4 halve_a = choose(root * mb, ma, one, zero);
  const f64x4 halve_b = choose(root * ma, mb, one, zero);
  ma = ma - half * ma * halve_a;
  mb = mb - half * mb * halve_b;
  const f64x4 e = exponent(a) - exponent(b) + (halve_a - halve_b);

  // |s| <= 0.1716: the first term left out is below 3e-17 of the sum.
  const f64x4 s = (ma - mb) / (ma + mb);
  const f64x4 z = s * s;
  const auto term = [&](f64x4 higher, double coefficient) {
    return higher * z + f64x4::broadcast(coefficient);
  };
  f64x4 series = term(f64x4::broadcast(1.0 / 19), 1.0 / 17);
  series = term(term(series, 1.0 / 15), 1.0 / 13);
  series = term(term(series, 1.0 / 11), 1.0 / 9);
  series = term(term(series, 1.0 / 7), 1.0 / 5);
  series = term(series, 1.0 / 3);
  const f64x4 twice = s + s;
  // ln 2 in two parts: the first has few enough bits for e * ln2_high to be exact.
  const f64x4 ln2_high = f64x4::broadcast(0x1.62e42fefa3p-1);
  const f64x4 ln2_low = f64x4::broadcast(0x1.3de6af278ece6p-42);
  return e * ln2_high + (twice + twice * (z * series) + e * ln2_low);
}

/// The same of two numbers.
inline double log_ratio(double a, double b) {
  double result[4];
  log_ratio(f64x4::broadcast(a), f64x4::broadcast(b)).store(result);
  return result[0];
}

}  // namespace AIB_ISA

}  // namespace aib::math
