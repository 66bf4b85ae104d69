// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/isa.hpp>
#include <aib/core/simd.hpp>
#include <aib/core/simd_doubled.hpp>

#include <cstddef>

namespace aib {

inline namespace AIB_ISA {

#if !defined(AIB_PLAIN) && defined(__AVX512F__)

/// Sixteen floats that are calculated together, see simd.hpp.
struct f32x16 {
  static constexpr std::size_t width = 16;
  static constexpr __mmask16 all = 0xffff;
  __m512 v;

  static f32x16 load(const float* p) { return {_mm512_loadu_ps(p)}; }
  static f32x16 broadcast(float x) { return {_mm512_set1_ps(x)}; }
  void store(float* p) const { _mm512_storeu_ps(p, v); }

  friend f32x16 operator+(f32x16 a, f32x16 b) { return {_mm512_add_ps(a.v, b.v)}; }
  friend f32x16 operator-(f32x16 a, f32x16 b) { return {_mm512_sub_ps(a.v, b.v)}; }
  friend f32x16 operator*(f32x16 a, f32x16 b) { return {_mm512_mul_ps(a.v, b.v)}; }
  friend f32x16 min(f32x16 a, f32x16 b) { return {_mm512_maskz_min_ps(all, a.v, b.v)}; }
  friend f32x16 max(f32x16 a, f32x16 b) { return {_mm512_maskz_max_ps(all, a.v, b.v)}; }
  friend unsigned less(f32x16 a, f32x16 b) { return _mm512_cmp_ps_mask(a.v, b.v, _CMP_LT_OQ); }
};

/// Eight doubles that are calculated together, see simd.hpp.
///
/// The masked forms of what works on all lanes: g++ 12 warns of the others.
struct f64x8 {
  static constexpr std::size_t width = 8;
  static constexpr __mmask8 all = 0xff;
  __m512d v;

  static f64x8 load(const double* p) { return {_mm512_loadu_pd(p)}; }
  static f64x8 convert(const float* p) { return {_mm512_maskz_cvtps_pd(all, _mm256_loadu_ps(p))}; }
  static f64x8 broadcast(double x) { return {_mm512_set1_pd(x)}; }
  void store(double* p) const { _mm512_storeu_pd(p, v); }

  friend f64x8 operator+(f64x8 a, f64x8 b) { return {_mm512_add_pd(a.v, b.v)}; }
  friend f64x8 operator-(f64x8 a, f64x8 b) { return {_mm512_sub_pd(a.v, b.v)}; }
  friend f64x8 operator*(f64x8 a, f64x8 b) { return {_mm512_mul_pd(a.v, b.v)}; }
  friend f64x8 operator/(f64x8 a, f64x8 b) { return {_mm512_div_pd(a.v, b.v)}; }
  friend f64x8 min(f64x8 a, f64x8 b) { return {_mm512_maskz_min_pd(all, a.v, b.v)}; }
  friend f64x8 max(f64x8 a, f64x8 b) { return {_mm512_maskz_max_pd(all, a.v, b.v)}; }
  friend f64x8 choose(f64x8 a, f64x8 b, f64x8 x, f64x8 y) {
    return {_mm512_mask_blend_pd(_mm512_cmp_pd_mask(a.v, b.v, _CMP_LT_OQ), y.v, x.v)};
  }
  friend f64x8 mantissa(f64x8 a) {
    const __m512i fraction =
        _mm512_and_epi64(_mm512_castpd_si512(a.v), _mm512_set1_epi64(detail::fraction_bits));
    return {_mm512_castsi512_pd(_mm512_or_epi64(fraction, _mm512_castpd_si512(_mm512_set1_pd(1))))};
  }
  friend f64x8 exponent(f64x8 a) {
    const __m512i shifted = _mm512_maskz_srli_epi64(all, _mm512_castpd_si512(a.v), 52);
    const __m512i offset = _mm512_castpd_si512(_mm512_set1_pd(0x1p52));
    return {_mm512_sub_pd(_mm512_castsi512_pd(_mm512_or_epi64(shifted, offset)),
                          _mm512_set1_pd(detail::exponent_offset))};
  }
};

#else

using f32x16 = doubled_lanes<f32x8, float>;
using f64x8 = doubled_lanes<f64x4, double>;

#endif

/// Sum of the lanes in a fixed order.
inline double sum(f64x8 a) {
  double lane[8];
  a.store(lane);
  return ((lane[0] + lane[1]) + (lane[2] + lane[3])) + ((lane[4] + lane[5]) + (lane[6] + lane[7]));
}

}  // namespace AIB_ISA

}  // namespace aib
