// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#if defined(AIB_WITH_LIBDEFLATE)
#include <libdeflate.h>
#else
#include <zlib.h>
#endif

#include <cstddef>
#include <memory>
#include <new>

namespace aib::io {

/// Expands zlib streams whose size is known. Uses libdeflate where AIB_WITH_LIBDEFLATE is defined
/// (twice as fast), else zlib. Not to be shared between threads.
class inflater {
 public:
#if defined(AIB_WITH_LIBDEFLATE)
  inflater() : state_(libdeflate_alloc_decompressor()) {
    if (!state_) throw std::bad_alloc();
  }

  /// Whether the stream is sound and holds exactly `n_to` bytes, which are then at `to`.
  [[nodiscard]] bool expand(const void* from, std::size_t n_from, void* to, std::size_t n_to) {
    return libdeflate_zlib_decompress(state_.get(), from, n_from, to, n_to, nullptr) ==
           LIBDEFLATE_SUCCESS;
  }

 private:
  struct free_state {
    void operator()(libdeflate_decompressor* d) const { libdeflate_free_decompressor(d); }
  };
  std::unique_ptr<libdeflate_decompressor, free_state> state_;
#else
  /// Whether the stream is sound and holds exactly `n_to` bytes, which are then at `to`.
  [[nodiscard]] bool expand(const void* from, std::size_t n_from, void* to, std::size_t n_to) {
    auto expanded = static_cast<uLongf>(n_to);
    return uncompress(static_cast<Bytef*>(to), &expanded, static_cast<const Bytef*>(from),
                      static_cast<uLong>(n_from)) == Z_OK &&
           expanded == n_to;
  }
#endif
};

}  // namespace aib::io
