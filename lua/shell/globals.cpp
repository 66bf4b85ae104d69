// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include "globals.hpp"

#include "../bind/kit.hpp"
#include <algorithm>
#include <clocale>
#include <string>
#include <string_view>
#include <vector>

namespace aib::shell {

namespace {

std::vector<std::string> global_names(lua_State* state) {
  std::vector<std::string> names;
  lua_pushglobaltable(state);
  lua_pushnil(state);
  while (lua_next(state, -2)) {
    if (lua_type(state, -2) == LUA_TSTRING)
      names.push_back(bind::value<std::string>::get(state, -2));
    lua_pop(state, 1);
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// The suggestion alone; a list of all globals helps nobody.
std::string near_global(lua_State* state, const std::string& name) {
  if (name == "aib") return "; begin with: local aib = require \"aib\"";
  std::string hint = bind::suggestion(name, global_names(state));
  return hint.starts_with(',') ? hint : "";
}

/// Upvalue: names that were declared, as keys; a declared global may be nil.
int read_undefined(lua_State* state) {
  lua_settop(state, 2);
  lua_pushvalue(state, 2);
  if (lua_rawget(state, lua_upvalueindex(1)) != LUA_TNIL) return 0;
  return bind::guard(state, [&]() -> int {
    const std::string name = luaL_tolstring(state, 2, nullptr);
    throw argument_error(message("undefined variable '", name, "'", near_global(state, name)));
  });
}

/// Whether the code that assigns is a chunk, not a function in one.
bool at_top_level(lua_State* state) {
  lua_Debug at;
  if (!lua_getstack(state, 1, &at)) return true;
  lua_getinfo(state, "S", &at);
  return std::string_view(at.what) != "Lua";
}

/// Upvalue: as above.
int define(lua_State* state) {
  lua_settop(state, 3);
  lua_pushvalue(state, 2);
  const bool declared = lua_rawget(state, lua_upvalueindex(1)) != LUA_TNIL;
  lua_pop(state, 1);
  if (!declared && !at_top_level(state)) {
    return bind::guard(state, [&]() -> int {
      const std::string name = luaL_tolstring(state, 2, nullptr);
      throw argument_error(message("assignment to undefined variable '", name,
                                   "' inside a function", near_global(state, name),
                                   "; declare it with local, or outside"));
    });
  }
  lua_pushvalue(state, 2);
  lua_pushboolean(state, 1);
  lua_rawset(state, lua_upvalueindex(1));
  lua_rawset(state, 1);
  return 0;
}

/// os.setlocale. Upvalue: the original.
int set_locale(lua_State* state) {
  lua_pushvalue(state, lua_upvalueindex(1));
  lua_insert(state, 1);
  lua_call(state, lua_gettop(state) - 1, 1);
  std::setlocale(LC_NUMERIC, "C");
  std::setlocale(LC_COLLATE, "C");
  return 1;
}

}  // namespace

void keep_results_plain(lua_State* state) {
  lua_getglobal(state, "os");
  lua_getfield(state, -1, "setlocale");
  lua_pushcclosure(state, set_locale, 1);
  lua_setfield(state, -2, "setlocale");
  lua_pop(state, 1);
}

void make_globals_strict(lua_State* state) {
  lua_pushglobaltable(state);
  lua_createtable(state, 0, 2);
  lua_newtable(state);
  lua_pushvalue(state, -1);
  lua_pushcclosure(state, read_undefined, 1);
  lua_setfield(state, -3, "__index");
  lua_pushcclosure(state, define, 1);
  lua_setfield(state, -2, "__newindex");
  lua_setmetatable(state, -2);
  lua_pop(state, 1);
}

}  // namespace aib::shell
