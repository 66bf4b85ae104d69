// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/isa.hpp>
#include <aib/core/simd.hpp>

#include <limits>
#include <numbers>

namespace aib::math {

inline namespace AIB_ISA {

/// Angles of the vectors (x, y), y >= 0, from the x axis, in radians, [0, pi], in four lanes:
/// within 5e-16 of std::atan2(y, x), none more than 7e-16 of itself; 0 for (0, 0). The same
/// bits on every machine.
///
/// The angle of the shorter over the longer side is that of a near centre, 0, pi/8 or pi/4, and the
/// arc tangent of at most tan(pi/16), by its Taylor series.
inline f64x4 angle_of(f64x4 x, f64x4 y) {
  constexpr double pi = std::numbers::pi;
  constexpr double tan_1 = 0.19891236737965800, tan_3 = 0.66817863791929891;  // of pi/16, 3 pi/16
  constexpr double tan_2 = std::numbers::sqrt2 - 1;
  const auto all = [](double value) { return f64x4::broadcast(value); };
  const f64x4 zero = all(0), width = max(x, zero - x);
  const f64x4 low = min(width, y),
              high = max(max(width, y), all(std::numeric_limits<double>::min()));

  const auto beyond = [&](double tangent, f64x4 yes, f64x4 no) {
    return choose(all(tangent) * high, low, yes, no);
  };
  const f64x4 tangent = beyond(tan_3, all(1), beyond(tan_1, all(tan_2), zero));
  const f64x4 centre = beyond(tan_3, all(pi / 4), beyond(tan_1, all(pi / 8), zero));
  const f64x4 u = (low - tangent * high) / (high + tangent * low);
  const f64x4 z = u * u;
  const auto term = [&](f64x4 higher, double n) { return all(1 / n) - higher * z; };
  f64x4 series = all(1.0 / 25);
  series = term(term(term(series, 23), 21), 19);
  series = term(term(term(series, 17), 15), 13);
  series = term(term(term(series, 11), 9), 7);
  series = term(term(series, 5), 3);
  f64x4 angle = centre + (u - u * (z * series));

  angle = choose(width, y, all(pi / 2) - angle, angle);
  return choose(x, zero, all(pi) - angle, angle);
}

}  // namespace AIB_ISA

}  // namespace aib::math
