// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/isa.hpp>
#include <aib/core/simd.hpp>

#include <numbers>

namespace aib::math {

inline namespace AIB_ISA {

/// ln(a / b) in lanes (f64x4, f64x8), of positive, finite, normal doubles: within 3e-16 of the
/// largest of 1 and the result. The ratio never overflows; equal numbers give exactly 0, near ones
/// of one binade keep their digits; the same bits on every machine.
///
/// ln(a / b) = 2 atanh((a - b) / (a + b)), taken on the mantissas, whose quotient s is at most 1/3;
/// atanh(s) / s by a Chebyshev interpolation in s^2 on [0, 1/9], within 6e-18.
template <class Lanes>
Lanes log_ratio(Lanes a, Lanes b) {
  const Lanes ma = mantissa(a), mb = mantissa(b);
  const Lanes s = (ma - mb) / (ma + mb);
  const Lanes z = s * s, z2 = z * z, z4 = z2 * z2;
  // Terms in pairs (Estrin's scheme): the processor works on all of them at a time.
  const auto pair = [&](double low, double high) {
    return Lanes::broadcast(low) + z * Lanes::broadcast(high);
  };
  const Lanes low = pair(0x1.5555555555555p-2, 0x1.999999999a3ddp-3) +
                    z2 * pair(0x1.24924923d44c6p-3, 0x1.c71c727143318p-4);
  const Lanes middle = pair(0x1.745cf0b0e03bdp-4, 0x1.3b18b294bebf9p-4) +
                       z2 * pair(0x1.10ac75dc602b1p-4, 0x1.eb905e8575054p-5);
  const Lanes high = pair(0x1.687a6e7c95176p-5, 0x1.4b0a26c5f2aefp-4);
  const Lanes series = low + z4 * (middle + z4 * high);
  const Lanes twice = s + s;
  return (exponent(a) - exponent(b)) * Lanes::broadcast(std::numbers::ln2) +
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
