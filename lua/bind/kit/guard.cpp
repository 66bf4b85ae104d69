// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include "guard.hpp"

#include <string_view>

namespace aib::bind {

std::string caller(lua_State* state) {
  lua_Debug at;
  for (int level = 0; lua_getstack(state, level, &at); ++level) {
    lua_getinfo(state, "Sl", &at);
    const bool embedded = std::string_view(at.source).substr(0, 4) == "=aib";
    if (at.currentline > 0 && !embedded) return message(at.short_src, ":", at.currentline, ": ");
  }
  return "";
}

void push_error(lua_State* state, error_kind kind, const char* what) {
  std::string text = caller(state) + what;
  lua_pushlstring(state, text.data(), text.size());
  session::of(state).remember(kind, std::move(text));
}

}  // namespace aib::bind
