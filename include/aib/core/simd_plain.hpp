// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/isa.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace aib {

namespace detail {

inline constexpr std::int64_t fraction_bits = 0x000fffffffffffff;
/// The exponent bits of x behind the leading bits of 2^52 make the double 2^52 + 1023 + exponent.
inline constexpr double exponent_offset = 0x1p52 + 1023;

}  // namespace detail

inline namespace AIB_ISA {

/// Lanes in plain code, for machines without vector code of their own here.
template <class Scalar, std::size_t Width>
struct plain_lanes {
  static constexpr std::size_t width = Width;
  Scalar v[Width];

  static plain_lanes load(const Scalar* p) {
    plain_lanes out;
    std::memcpy(out.v, p, sizeof out.v);
    return out;
  }
  static plain_lanes convert(const float* p) {
    plain_lanes out;
    for (std::size_t i = 0; i < Width; ++i) out.v[i] = p[i];
    return out;
  }
  static plain_lanes broadcast(Scalar x) {
    plain_lanes out;
    std::fill_n(out.v, Width, x);
    return out;
  }
  void store(Scalar* p) const { std::memcpy(p, v, sizeof v); }

  template <class Op>
  static plain_lanes each(const plain_lanes& a, const plain_lanes& b, Op op) {
    plain_lanes out;
    for (std::size_t i = 0; i < Width; ++i) out.v[i] = op(a.v[i], b.v[i]);
    return out;
  }
  friend plain_lanes operator+(const plain_lanes& a, const plain_lanes& b) {
    return each(a, b, [](Scalar x, Scalar y) { return x + y; });
  }
  friend plain_lanes operator-(const plain_lanes& a, const plain_lanes& b) {
    return each(a, b, [](Scalar x, Scalar y) { return x - y; });
  }
  friend plain_lanes operator*(const plain_lanes& a, const plain_lanes& b) {
    return each(a, b, [](Scalar x, Scalar y) { return x * y; });
  }
  friend plain_lanes operator/(const plain_lanes& a, const plain_lanes& b) {
    return each(a, b, [](Scalar x, Scalar y) { return x / y; });
  }
  friend plain_lanes operator&(const plain_lanes& a, const plain_lanes& b) {
    return each(a, b, [](Scalar x, Scalar y) { return x & y; });
  }
  friend plain_lanes operator|(const plain_lanes& a, const plain_lanes& b) {
    return each(a, b, [](Scalar x, Scalar y) { return x | y; });
  }
  friend plain_lanes operator^(const plain_lanes& a, const plain_lanes& b) {
    return each(a, b, [](Scalar x, Scalar y) { return x ^ y; });
  }
  friend plain_lanes operator<<(const plain_lanes& a, int bits) {
    return each(a, a, [bits](Scalar x, Scalar) { return x << bits; });
  }
  friend plain_lanes operator>>(const plain_lanes& a, int bits) {
    return each(a, a, [bits](Scalar x, Scalar) { return x >> bits; });
  }
  friend plain_lanes sqrt(const plain_lanes& a) {
    return each(a, a, [](Scalar x, Scalar) { return std::sqrt(x); });
  }
  friend plain_lanes min(const plain_lanes& a, const plain_lanes& b) {
    return each(a, b, [](Scalar x, Scalar y) { return x < y ? x : y; });
  }
  friend plain_lanes max(const plain_lanes& a, const plain_lanes& b) {
    return each(a, b, [](Scalar x, Scalar y) { return x > y ? x : y; });
  }
  friend unsigned less(const plain_lanes& a, const plain_lanes& b) {
    unsigned bits = 0;
    for (std::size_t i = 0; i < Width; ++i) bits |= static_cast<unsigned>(a.v[i] < b.v[i]) << i;
    return bits;
  }
  friend plain_lanes choose(const plain_lanes& a,
                            const plain_lanes& b,
                            const plain_lanes& x,
                            const plain_lanes& y) {
    plain_lanes out;
    for (std::size_t i = 0; i < Width; ++i) out.v[i] = a.v[i] < b.v[i] ? x.v[i] : y.v[i];
    return out;
  }
  friend plain_lanes mantissa(const plain_lanes& a) requires(sizeof(Scalar) == 8) {
    return each(a, a, [](Scalar x, Scalar) {
      const auto bits = std::bit_cast<std::int64_t>(x) & detail::fraction_bits;
      return std::bit_cast<Scalar>(bits | std::bit_cast<std::int64_t>(Scalar{1}));
    });
  }
  friend plain_lanes exponent(const plain_lanes& a) requires(sizeof(Scalar) == 8) {
    return each(a, a, [](Scalar x, Scalar) {
      return static_cast<Scalar>((std::bit_cast<std::int64_t>(x) >> 52) - 1023);
    });
  }
};

}  // namespace AIB_ISA

}  // namespace aib
