// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../bind/kit/session.hpp"

namespace aib::shell {

/// While it lives, Ctrl-C stops what the state does: the library at its next chunk, Lua code at its
/// next instruction. Where neither ends within a second, or Ctrl-C comes again, the process exits
/// with 130. Results are written in one step, so that no file is left half-written.
class interruptible {
 public:
  explicit interruptible(lua_State* state);
  ~interruptible();
  interruptible(const interruptible&) = delete;
  interruptible& operator=(const interruptible&) = delete;

  /// Whether Ctrl-C came.
  [[nodiscard]] bool interrupted() const;
};

}  // namespace aib::shell
