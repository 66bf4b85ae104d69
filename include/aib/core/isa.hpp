// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

/// Names the instruction set that this translation unit is compiled for. Code whose machine form
/// depends on it lives in `inline namespace AIB_ISA`, so that units compiled for different machines
/// can be linked together.
#if defined(AIB_PLAIN)
#define AIB_ISA plain
#elif defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__)
#define AIB_ISA avx512
#elif defined(__AVX2__)
#define AIB_ISA avx2
#elif defined(__SSE2__)
#define AIB_ISA sse2
#else
#define AIB_ISA plain
#endif

namespace aib {

inline namespace AIB_ISA {}

#define AIB_ISA_TEXT_(name) #name
#define AIB_ISA_TEXT(name) AIB_ISA_TEXT_(name)

/// "avx512", "avx2", "sse2" or "plain".
inline constexpr const char* instruction_set = AIB_ISA_TEXT(AIB_ISA);

#undef AIB_ISA_TEXT
#undef AIB_ISA_TEXT_

}  // namespace aib
