// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace aib {

inline constexpr std::size_t large_page = std::size_t{2} << 20;

/// Asks the system to lay memory that nobody has touched yet in large pages: the first touch of
/// millions of small ones, and the way to them in random order, would cost as much as the work.
inline void advise_large_pages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t bytes) {
#if defined(__linux__)
  const auto address = reinterpret_cast<std::uintptr_t>(memory);
  const std::uintptr_t skipped = (large_page - address % large_page) % large_page;
  if (bytes < skipped + large_page) return;
  madvise(static_cast<char*>(memory) + skipped, (bytes - skipped) / large_page * large_page,
          MADV_HUGEPAGE);
#endif
}

/// `values.resize(n)` of an empty vector, in large pages where the system has them.
template <class T>
void resize_in_large_pages(std::vector<T>& values, std::size_t n) {
  values.reserve(n);
  advise_large_pages(values.data(), n * sizeof(T));
  values.resize(n);
}

}  // namespace aib
