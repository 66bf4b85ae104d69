// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/isa.hpp>
#include <aib/core/simd_doubled.hpp>
#include <aib/core/simd_plain.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

#if !defined(AIB_PLAIN) && defined(__SSE2__)
#include <immintrin.h>
#endif

/// Eight floats and four doubles that are calculated together, for the few loops where that pays.
///
/// The same bits on every machine: each operation is the IEEE one on each lane, nothing is
/// contracted. `min(a, b)` and `max(a, b)` give `b` where the lanes are unordered. `less(a, b)` has
/// bit i set where a < b in lane i. `choose(a, b, x, y)` is x where a < b, else y.
/// `load` and `store` need no alignment. `convert` loads floats into doubles. Of doubles that are
/// positive and normal, `mantissa` is in [1, 2) and `exponent` the power of 2 beside it.
namespace aib {

inline namespace AIB_ISA {

#if !defined(AIB_PLAIN) && defined(__AVX2__)

struct f32x8 {
  static constexpr std::size_t width = 8;
  __m256 v;

  static f32x8 load(const float* p) { return {_mm256_loadu_ps(p)}; }
  static f32x8 broadcast(float x) { return {_mm256_set1_ps(x)}; }
  void store(float* p) const { _mm256_storeu_ps(p, v); }

  friend f32x8 operator+(f32x8 a, f32x8 b) { return {_mm256_add_ps(a.v, b.v)}; }
  friend f32x8 operator-(f32x8 a, f32x8 b) { return {_mm256_sub_ps(a.v, b.v)}; }
  friend f32x8 operator*(f32x8 a, f32x8 b) { return {_mm256_mul_ps(a.v, b.v)}; }
  friend f32x8 operator/(f32x8 a, f32x8 b) { return {_mm256_div_ps(a.v, b.v)}; }
  friend f32x8 sqrt(f32x8 a) { return {_mm256_sqrt_ps(a.v)}; }
  friend f32x8 min(f32x8 a, f32x8 b) { return {_mm256_min_ps(a.v, b.v)}; }
  friend f32x8 max(f32x8 a, f32x8 b) { return {_mm256_max_ps(a.v, b.v)}; }
  friend unsigned less(f32x8 a, f32x8 b) {
    return static_cast<unsigned>(_mm256_movemask_ps(_mm256_cmp_ps(a.v, b.v, _CMP_LT_OQ)));
  }
  friend f32x8 choose(f32x8 a, f32x8 b, f32x8 x, f32x8 y) {
    return {_mm256_blendv_ps(y.v, x.v, _mm256_cmp_ps(a.v, b.v, _CMP_LT_OQ))};
  }
};

struct f64x4 {
  static constexpr std::size_t width = 4;
  __m256d v;

  static f64x4 load(const double* p) { return {_mm256_loadu_pd(p)}; }
  static f64x4 convert(const float* p) { return {_mm256_cvtps_pd(_mm_loadu_ps(p))}; }
  static f64x4 broadcast(double x) { return {_mm256_set1_pd(x)}; }
  void store(double* p) const { _mm256_storeu_pd(p, v); }

  friend f64x4 operator+(f64x4 a, f64x4 b) { return {_mm256_add_pd(a.v, b.v)}; }
  friend f64x4 operator-(f64x4 a, f64x4 b) { return {_mm256_sub_pd(a.v, b.v)}; }
  friend f64x4 operator*(f64x4 a, f64x4 b) { return {_mm256_mul_pd(a.v, b.v)}; }
  friend f64x4 operator/(f64x4 a, f64x4 b) { return {_mm256_div_pd(a.v, b.v)}; }
  friend f64x4 sqrt(f64x4 a) { return {_mm256_sqrt_pd(a.v)}; }
  friend f64x4 min(f64x4 a, f64x4 b) { return {_mm256_min_pd(a.v, b.v)}; }
  friend f64x4 max(f64x4 a, f64x4 b) { return {_mm256_max_pd(a.v, b.v)}; }
  friend unsigned less(f64x4 a, f64x4 b) {
    return static_cast<unsigned>(_mm256_movemask_pd(_mm256_cmp_pd(a.v, b.v, _CMP_LT_OQ)));
  }
  friend f64x4 choose(f64x4 a, f64x4 b, f64x4 x, f64x4 y) {
    return {_mm256_blendv_pd(y.v, x.v, _mm256_cmp_pd(a.v, b.v, _CMP_LT_OQ))};
  }
  friend f64x4 mantissa(f64x4 a) {
    const __m256d one = _mm256_set1_pd(1);
    const __m256d fraction = _mm256_castsi256_pd(_mm256_set1_epi64x(detail::fraction_bits));
    return {_mm256_or_pd(_mm256_and_pd(a.v, fraction), one)};
  }
  friend f64x4 exponent(f64x4 a) {
    const __m256i shifted = _mm256_srli_epi64(_mm256_castpd_si256(a.v), 52);
    const __m256d offset = _mm256_set1_pd(0x1p52);
    return {_mm256_sub_pd(_mm256_or_pd(_mm256_castsi256_pd(shifted), offset),
                          _mm256_set1_pd(detail::exponent_offset))};
  }
};

#elif !defined(AIB_PLAIN) && defined(__SSE2__)

struct f32x4 {
  static constexpr std::size_t width = 4;
  __m128 v;

  static f32x4 load(const float* p) { return {_mm_loadu_ps(p)}; }
  static f32x4 broadcast(float x) { return {_mm_set1_ps(x)}; }
  void store(float* p) const { _mm_storeu_ps(p, v); }

  friend f32x4 operator+(f32x4 a, f32x4 b) { return {_mm_add_ps(a.v, b.v)}; }
  friend f32x4 operator-(f32x4 a, f32x4 b) { return {_mm_sub_ps(a.v, b.v)}; }
  friend f32x4 operator*(f32x4 a, f32x4 b) { return {_mm_mul_ps(a.v, b.v)}; }
  friend f32x4 operator/(f32x4 a, f32x4 b) { return {_mm_div_ps(a.v, b.v)}; }
  friend f32x4 sqrt(f32x4 a) { return {_mm_sqrt_ps(a.v)}; }
  friend f32x4 min(f32x4 a, f32x4 b) { return {_mm_min_ps(a.v, b.v)}; }
  friend f32x4 max(f32x4 a, f32x4 b) { return {_mm_max_ps(a.v, b.v)}; }
  friend unsigned less(f32x4 a, f32x4 b) {
    return static_cast<unsigned>(_mm_movemask_ps(_mm_cmplt_ps(a.v, b.v)));
  }
  friend f32x4 choose(f32x4 a, f32x4 b, f32x4 x, f32x4 y) {
    const __m128 mask = _mm_cmplt_ps(a.v, b.v);
    return {_mm_or_ps(_mm_and_ps(mask, x.v), _mm_andnot_ps(mask, y.v))};
  }
};

struct f64x2 {
  static constexpr std::size_t width = 2;
  __m128d v;

  static f64x2 load(const double* p) { return {_mm_loadu_pd(p)}; }
  static f64x2 convert(const float* p) {
    const __m128i floats = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(p));
    return {_mm_cvtps_pd(_mm_castsi128_ps(floats))};
  }
  static f64x2 broadcast(double x) { return {_mm_set1_pd(x)}; }
  void store(double* p) const { _mm_storeu_pd(p, v); }

  friend f64x2 operator+(f64x2 a, f64x2 b) { return {_mm_add_pd(a.v, b.v)}; }
  friend f64x2 operator-(f64x2 a, f64x2 b) { return {_mm_sub_pd(a.v, b.v)}; }
  friend f64x2 operator*(f64x2 a, f64x2 b) { return {_mm_mul_pd(a.v, b.v)}; }
  friend f64x2 operator/(f64x2 a, f64x2 b) { return {_mm_div_pd(a.v, b.v)}; }
  friend f64x2 sqrt(f64x2 a) { return {_mm_sqrt_pd(a.v)}; }
  friend f64x2 min(f64x2 a, f64x2 b) { return {_mm_min_pd(a.v, b.v)}; }
  friend f64x2 max(f64x2 a, f64x2 b) { return {_mm_max_pd(a.v, b.v)}; }
  friend unsigned less(f64x2 a, f64x2 b) {
    return static_cast<unsigned>(_mm_movemask_pd(_mm_cmplt_pd(a.v, b.v)));
  }
  friend f64x2 choose(f64x2 a, f64x2 b, f64x2 x, f64x2 y) {
    const __m128d mask = _mm_cmplt_pd(a.v, b.v);
    return {_mm_or_pd(_mm_and_pd(mask, x.v), _mm_andnot_pd(mask, y.v))};
  }
  friend f64x2 mantissa(f64x2 a) {
    const __m128d fraction = _mm_castsi128_pd(_mm_set1_epi64x(detail::fraction_bits));
    return {_mm_or_pd(_mm_and_pd(a.v, fraction), _mm_set1_pd(1))};
  }
  friend f64x2 exponent(f64x2 a) {
    const __m128d shifted = _mm_castsi128_pd(_mm_srli_epi64(_mm_castpd_si128(a.v), 52));
    return {
        _mm_sub_pd(_mm_or_pd(shifted, _mm_set1_pd(0x1p52)), _mm_set1_pd(detail::exponent_offset))};
  }
};

using f32x8 = doubled_lanes<f32x4, float>;
using f64x4 = doubled_lanes<f64x2, double>;

#else

using f32x8 = plain_lanes<float, 8>;
using f64x4 = plain_lanes<double, 4>;

#endif

/// The smallest and the largest of the lanes; no lane is NaN.
inline float lowest(f32x8 a) {
  float lane[8];
  a.store(lane);
  return *std::min_element(lane, lane + 8);
}
inline float highest(f32x8 a) {
  float lane[8];
  a.store(lane);
  return *std::max_element(lane, lane + 8);
}

/// Sum of the lanes in a fixed order.
inline double sum(f64x4 a) {
  double lane[4];
  a.store(lane);
  return (lane[0] + lane[1]) + (lane[2] + lane[3]);
}

}  // namespace AIB_ISA
}  // namespace aib
