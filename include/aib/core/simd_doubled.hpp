// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/isa.hpp>

#include <cstddef>

namespace aib {

inline namespace AIB_ISA {

/// Twice as many lanes, in halves, with every operation that the halves have.
template <class Half, class Scalar>
struct doubled_lanes {
  static constexpr std::size_t width = 2 * Half::width;
  Half lo, hi;

  static doubled_lanes load(const Scalar* p) {
    return {Half::load(p), Half::load(p + Half::width)};
  }
  static doubled_lanes convert(const float* p) {
    return {Half::convert(p), Half::convert(p + Half::width)};
  }
  static doubled_lanes broadcast(Scalar x) { return {Half::broadcast(x), Half::broadcast(x)}; }
  void store(Scalar* p) const {
    lo.store(p);
    hi.store(p + Half::width);
  }

  using lanes = doubled_lanes;
  friend lanes operator+(lanes a, lanes b) { return {a.lo + b.lo, a.hi + b.hi}; }
  friend lanes operator-(lanes a, lanes b) { return {a.lo - b.lo, a.hi - b.hi}; }
  friend lanes operator*(lanes a, lanes b) { return {a.lo * b.lo, a.hi * b.hi}; }
  friend lanes operator/(lanes a, lanes b) { return {a.lo / b.lo, a.hi / b.hi}; }
  friend lanes operator&(lanes a, lanes b) { return {a.lo & b.lo, a.hi & b.hi}; }
  friend lanes operator|(lanes a, lanes b) { return {a.lo | b.lo, a.hi | b.hi}; }
  friend lanes operator^(lanes a, lanes b) { return {a.lo ^ b.lo, a.hi ^ b.hi}; }
  friend lanes operator<<(lanes a, int bits) { return {a.lo << bits, a.hi << bits}; }
  friend lanes operator>>(lanes a, int bits) { return {a.lo >> bits, a.hi >> bits}; }
  friend lanes sqrt(lanes a) { return {sqrt(a.lo), sqrt(a.hi)}; }
  friend lanes min(lanes a, lanes b) { return {min(a.lo, b.lo), min(a.hi, b.hi)}; }
  friend lanes max(lanes a, lanes b) { return {max(a.lo, b.lo), max(a.hi, b.hi)}; }
  friend unsigned less(lanes a, lanes b) {
    return less(a.lo, b.lo) | less(a.hi, b.hi) << Half::width;
  }
  friend lanes choose(lanes a, lanes b, lanes x, lanes y) {
    return {choose(a.lo, b.lo, x.lo, y.lo), choose(a.hi, b.hi, x.hi, y.hi)};
  }
  friend lanes mantissa(lanes a) { return {mantissa(a.lo), mantissa(a.hi)}; }
  friend lanes exponent(lanes a) { return {exponent(a.lo), exponent(a.hi)}; }
};

}  // namespace AIB_ISA

}  // namespace aib
