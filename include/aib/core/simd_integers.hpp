// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/isa.hpp>
#include <aib/core/simd_doubled.hpp>
#include <aib/core/simd_plain.hpp>

#include <cstddef>
#include <cstdint>

#if !defined(AIB_PLAIN) && defined(__SSE2__)
#include <immintrin.h>
#endif

namespace aib {

inline namespace AIB_ISA {

/// Eight unsigned integers that are calculated together, modulo 2^32. `load` and `store` need no
/// alignment; shifts are by less than 32.
#if !defined(AIB_PLAIN) && defined(__AVX2__)

struct u32x8 {
  static constexpr std::size_t width = 8;
  __m256i v;

  static u32x8 load(const std::uint32_t* p) {
    return {_mm256_loadu_si256(reinterpret_cast<const __m256i*>(p))};
  }
  static u32x8 broadcast(std::uint32_t x) { return {_mm256_set1_epi32(static_cast<int>(x))}; }
  void store(std::uint32_t* p) const { _mm256_storeu_si256(reinterpret_cast<__m256i*>(p), v); }

  friend u32x8 operator&(u32x8 a, u32x8 b) { return {_mm256_and_si256(a.v, b.v)}; }
  friend u32x8 operator|(u32x8 a, u32x8 b) { return {_mm256_or_si256(a.v, b.v)}; }
  friend u32x8 operator^(u32x8 a, u32x8 b) { return {_mm256_xor_si256(a.v, b.v)}; }
  friend u32x8 operator-(u32x8 a, u32x8 b) { return {_mm256_sub_epi32(a.v, b.v)}; }
  friend u32x8 operator<<(u32x8 a, int bits) { return {_mm256_slli_epi32(a.v, bits)}; }
  friend u32x8 operator>>(u32x8 a, int bits) { return {_mm256_srli_epi32(a.v, bits)}; }
};

#elif !defined(AIB_PLAIN) && defined(__SSE2__)

struct u32x4 {
  static constexpr std::size_t width = 4;
  __m128i v;

  static u32x4 load(const std::uint32_t* p) {
    return {_mm_loadu_si128(reinterpret_cast<const __m128i*>(p))};
  }
  static u32x4 broadcast(std::uint32_t x) { return {_mm_set1_epi32(static_cast<int>(x))}; }
  void store(std::uint32_t* p) const { _mm_storeu_si128(reinterpret_cast<__m128i*>(p), v); }

  friend u32x4 operator&(u32x4 a, u32x4 b) { return {_mm_and_si128(a.v, b.v)}; }
  friend u32x4 operator|(u32x4 a, u32x4 b) { return {_mm_or_si128(a.v, b.v)}; }
  friend u32x4 operator^(u32x4 a, u32x4 b) { return {_mm_xor_si128(a.v, b.v)}; }
  friend u32x4 operator-(u32x4 a, u32x4 b) { return {_mm_sub_epi32(a.v, b.v)}; }
  friend u32x4 operator<<(u32x4 a, int bits) { return {_mm_slli_epi32(a.v, bits)}; }
  friend u32x4 operator>>(u32x4 a, int bits) { return {_mm_srli_epi32(a.v, bits)}; }
};

using u32x8 = doubled_lanes<u32x4, std::uint32_t>;

#else

using u32x8 = plain_lanes<std::uint32_t, 8>;

#endif

}  // namespace AIB_ISA

}  // namespace aib
