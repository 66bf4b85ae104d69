// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

namespace aib {

/// Tells the machine that something is read, or written, soon: for loops through memory whose order
/// no machine foresees.
inline void prefetch_read([[maybe_unused]] const void* p) {
#if defined(__GNUC__)
  __builtin_prefetch(p, 0);
#endif
}
inline void prefetch_write([[maybe_unused]] void* p) {
#if defined(__GNUC__)
  __builtin_prefetch(p, 1);
#endif
}

}  // namespace aib
