// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include "session.hpp"

#include <algorithm>
#include <utility>

namespace aib::bind {

const char* name_of(error_kind kind) {
  switch (kind) {
    case error_kind::script:
      return "script";
    case error_kind::argument:
      return "argument";
    case error_kind::format:
      return "format";
    case error_kind::io:
      return "io";
    case error_kind::output:
      return "output";
    case error_kind::undefined:
      return "undefined";
    case error_kind::stopped:
      return "stopped";
    case error_kind::internal:
      return "internal";
  }
  return "script";
}

// Lua copies the extra space of the main thread into every coroutine.
void session::attach(lua_State* state) { *static_cast<session**>(lua_getextraspace(state)) = this; }

void session::restart() {
  stop = std::stop_source();
  control.stop = stop.get_token();
}

session& session::of(lua_State* state) {
  return **static_cast<session**>(lua_getextraspace(state));
}

void session::remember(error_kind kind, std::string message) {
  errors_[next_error_++ % errors_.size()] = {kind, std::move(message)};
}

error_kind session::kind_of(std::string_view text) const {
  for (std::size_t age = 1; age <= std::min(next_error_, errors_.size()); ++age) {
    const remembered& e = errors_[(next_error_ - age) % errors_.size()];
    if (text.find(e.message) != std::string_view::npos) return e.kind;
  }
  return error_kind::script;
}

void session::grew(lua_State* state, std::size_t bytes) {
  held_ += bytes;
  if (held_ <= collect_at_) return;
  lua_gc(state, LUA_GCCOLLECT);
  collect_at_ = std::max(std::size_t{256} << 20, 2 * held_);
}

}  // namespace aib::bind
