// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/isa.hpp>
#include <aib/core/simd.hpp>

#include <numbers>

namespace aib::math {

inline namespace AIB_ISA {

/// ln(a / b) in four lanes, of positive, finite, normal doubles: within 3e-16 of the largest of 1
/// and the result. The ratio never overflows; equal numbers give exactly 0, near ones of one binade
/// keep their digits; the same bits on every machine.
///
/// ln(a / b) = 2 atanh((a - b) / (a + b)), taken on the mantissas, whose quotient s is at most 1/3;
/// atanh(s) / s by a Chebyshev interpolation in s^2 on [0, 1/9], within 6e-18.
inline f64x4 log_ratio(f64x4 a, f64x4 b) {
  const f64x4 ma = mantissa(a), mb = mantissa(b);
  const f64x4 s = (ma - mb) / (ma + mb);
  const f64x4 z = s * s;
  const auto term = [&](f64x4 higher, double coefficient) {
    return higher * z + f64x4::broadcast(coefficient);
  };
  f64x4 series = term(f64x4::broadcast(0x1.4b0a26c5f2aefp-4), 0x1.687a6e7c95176p-5);
  series = term(term(series, 0x1.eb905e8575054p-5), 0x1.10ac75dc602b1p-4);
  series = term(term(series, 0x1.3b18b294bebf9p-4), 0x1.745cf0b0e03bdp-4);
  series = term(term(series, 0x1.c71c727143318p-4), 0x1.24924923d44c6p-3);
  series = term(term(series, 0x1.999999999a3ddp-3), 0x1.5555555555555p-2);
  const f64x4 twice = s + s;
  return (exponent(a) - exponent(b)) * f64x4::broadcast(std::numbers::ln2) +
         (twice + twice * (z * series));
}

/// The same of two numbers.
inline double log_ratio(double a, double b) {
  double result[4];
  log_ratio(f64x4::broadcast(a), f64x4::broadcast(b)).store(result);
  return result[0];
}

}  // namespace AIB_ISA

}  // namespace aib::math
