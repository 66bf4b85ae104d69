// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include "module.hpp"

#include "suggest.hpp"
#include <algorithm>

namespace aib::bind {

namespace {

char modules_key;

/// Upvalue: name of the module.
int unknown_member(lua_State* state) {
  return guard(state, [&]() -> int {
    const std::string module = value<std::string>::get(state, lua_upvalueindex(1));
    if (lua_type(state, 2) != LUA_TSTRING)
      throw argument_error(message(module, " has no member ", describe(state, 2)));
    std::vector<std::string> names;
    lua_pushnil(state);
    while (lua_next(state, 1)) {
      if (lua_type(state, -2) == LUA_TSTRING) names.push_back(value<std::string>::get(state, -2));
      lua_pop(state, 1);
    }
    std::sort(names.begin(), names.end());
    const std::string name = value<std::string>::get(state, 2);
    throw argument_error(message(module, " has no member '", name, "'", suggestion(name, names)));
  });
}

/// Pushes a new module table.
void push_module(lua_State* state, const std::string& full_name) {
  lua_newtable(state);
  lua_createtable(state, 0, 2);
  push(state, full_name);
  lua_setfield(state, -2, "__name");
  push(state, full_name);
  lua_pushcclosure(state, unknown_member, 1);
  lua_setfield(state, -2, "__index");
  lua_setmetatable(state, -2);
}

/// Pushes the table `aib`.
void push_root(lua_State* state) {
  if (lua_rawgetp(state, LUA_REGISTRYINDEX, &modules_key) == LUA_TTABLE) return;
  lua_pop(state, 1);
  push_module(state, "aib");
  lua_pushvalue(state, -1);
  lua_rawsetp(state, LUA_REGISTRYINDEX, &modules_key);
}

}  // namespace

module::module(lua_State* state, const std::string& name) :state_(state),
    name_(name.empty() ? "aib" : "aib." + name) {
  const int top = lua_gettop(state);
  push_root(state);
  if (!name.empty()) {
    push(state, name);
    if (lua_rawget(state, -2) == LUA_TNIL) {
      push_module(state, name_);
      lua_pushvalue(state, -1);
      lua_setfield(state, top + 1, name.c_str());
    }
  }
  table_ = sol::table(state, -1);
  lua_settop(state, top);
}

}  // namespace aib::bind
