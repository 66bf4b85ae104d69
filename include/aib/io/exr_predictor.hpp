// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/isa.hpp>

#include <cstddef>
#include <cstdint>

#if !defined(AIB_PLAIN) && defined(__SSE2__)
#include <emmintrin.h>
#endif

/// What OpenEXR's RLE and ZIP codecs do to bytes before they compress them: the bytes at even
/// places first, then those at odd places, then differences of neighbours plus 128.
/// Source: OpenEXR, "OpenEXR File Layout" and the reference implementation (ImfZip).
namespace aib::io {
inline namespace AIB_ISA {

/// Differences back to bytes, in place: b[0] = d[0], b[i] = b[i - 1] + d[i] - 128.
inline void sum_differences(std::uint8_t* bytes, std::size_t n) {
  if (n == 0) return;
  bytes[0] = static_cast<std::uint8_t>(bytes[0] + 128);  // the first has no 128 to take off
  std::size_t i = 0;
  std::uint8_t sum = 0;
#if !defined(AIB_PLAIN) && defined(__SSE2__)
  const __m128i bias = _mm_set1_epi8(-128);
  __m128i carry = _mm_setzero_si128();
  for (; i + 16 <= n; i += 16) {
    auto* at = reinterpret_cast<__m128i*>(bytes + i);
    __m128i x = _mm_add_epi8(_mm_loadu_si128(at), bias);
    x = _mm_add_epi8(x, _mm_slli_si128(x, 1));
    x = _mm_add_epi8(x, _mm_slli_si128(x, 2));
    x = _mm_add_epi8(x, _mm_slli_si128(x, 4));
    x = _mm_add_epi8(x, _mm_slli_si128(x, 8));
    _mm_storeu_si128(at, _mm_add_epi8(x, carry));
    // The last byte sixteen times: the only step that the next block waits for is the addition.
    const __m128i last = _mm_shufflehi_epi16(_mm_unpackhi_epi8(x, x), 0xff);
    carry = _mm_add_epi8(carry, _mm_shuffle_epi32(last, 0xff));
  }
  if (i > 0) sum = bytes[i - 1];
#endif
  for (; i < n; ++i) {
    sum = static_cast<std::uint8_t>(sum + bytes[i] - 128);
    bytes[i] = sum;
  }
}

/// Takes n bytes in turn from two halves: even[0], odd[0], even[1], ... ; n is even.
inline void interleave(const std::uint8_t* even,
                       const std::uint8_t* odd,
                       std::uint8_t* to,
                       std::size_t n) {
  std::size_t i = 0;
#if !defined(AIB_PLAIN) && defined(__SSE2__)
  for (; 2 * i + 32 <= n; i += 16) {
    const __m128i a = _mm_loadu_si128(reinterpret_cast<const __m128i*>(even + i));
    const __m128i b = _mm_loadu_si128(reinterpret_cast<const __m128i*>(odd + i));
    auto* at = reinterpret_cast<__m128i*>(to + 2 * i);
    _mm_storeu_si128(at, _mm_unpacklo_epi8(a, b));
    _mm_storeu_si128(at + 1, _mm_unpackhi_epi8(a, b));
  }
#endif
  for (; 2 * i < n; ++i) {
    to[2 * i] = even[i];
    to[2 * i + 1] = odd[i];
  }
}

/// The way there, for writing: halves, then differences. `to` holds n bytes, n is even.
inline void take_differences(const std::uint8_t* bytes, std::uint8_t* to, std::size_t n) {
  for (std::size_t i = 0; 2 * i < n; ++i) {
    to[i] = bytes[2 * i];
    to[n / 2 + i] = bytes[2 * i + 1];
  }
  for (std::size_t i = n; i-- > 1;) to[i] = static_cast<std::uint8_t>(to[i] - to[i - 1] + 128);
}

}  // namespace AIB_ISA
}  // namespace aib::io
