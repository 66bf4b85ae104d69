// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include "value.hpp"

#include <algorithm>

namespace aib::bind {

namespace {

/// Control characters as Lua writes them: "\\0".
std::string printable(const std::string& text) {
  std::string out;
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    code < 32 || code == 127 ? out += message("\\", int{code}) : out += c;
  }
  return out;
}

}  // namespace

std::string describe(lua_State* state, int index) {
  switch (lua_type(state, index)) {
    case LUA_TNONE:
      return "nothing";
    case LUA_TNUMBER:
      return lua_isinteger(state, index) ? message("number ", lua_tointeger(state, index))
                                         : message("number ", lua_tonumber(state, index));
    case LUA_TSTRING: {
      const std::string text = value<std::string>::get(state, index);
      return message("string '", printable(text.substr(0, 40)), text.size() > 40 ? "..." : "", "'");
    }
    default:
      return type_name(state, index);
  }
}

std::string type_name(lua_State* state, int index) {
  if (lua_type(state, index) != LUA_TUSERDATA) return luaL_typename(state, index);
  const int top = lua_gettop(state);
  std::string name = "userdata";
  if (luaL_getmetafield(state, index, "__name") == LUA_TSTRING)
    name = value<std::string>::get(state, -1);
  lua_settop(state, top);
  return name;
}

std::string plural(const std::string& one) {
  const std::size_t end = std::min(one.find(' '), one.size());
  const bool ends_in_y = end > 0 && one[end - 1] == 'y';
  const std::string word = ends_in_y ? one.substr(0, end - 1) + "ies" : one.substr(0, end) + "s";
  return word + one.substr(end);
}

std::string place::text() const {
  if (argument == option) return message(function, ": option '", name, "'");
  if (argument == 0) return function + ": the object before ':'";
  return message(function, ": argument ", argument, " (", name, ")");
}

void mismatch(const place& at, const std::string& expected, lua_State* state, int index) {
  throw argument_error(
      message(at.text(), ": ", expected, " expected, found ", describe(state, index)));
}

}  // namespace aib::bind
