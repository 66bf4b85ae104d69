// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include "module.hpp"

#include "suggest.hpp"
#include <algorithm>

namespace aib::bind {

namespace {

char modules_key;

std::vector<std::string> keys(lua_State* state, int table) {
  std::vector<std::string> names;
  lua_pushnil(state);
  while (lua_next(state, table)) {
    if (lua_type(state, -2) == LUA_TSTRING) names.push_back(value<std::string>::get(state, -2));
    lua_pop(state, 1);
  }
  return names;
}

/// Upvalues: name of the module, names of its lazy members as keys.
[[noreturn]] void throw_unknown(lua_State* state) {
  const std::string module = value<std::string>::get(state, lua_upvalueindex(1));
  if (lua_type(state, 2) != LUA_TSTRING)
    throw argument_error(message(module, " has no member ", describe(state, 2)));
  std::vector<std::string> names = keys(state, 1);
  for (std::string& lazy : keys(state, lua_upvalueindex(2))) names.push_back(std::move(lazy));
  std::sort(names.begin(), names.end());
  const std::string name = value<std::string>::get(state, 2);
  throw argument_error(message(module, " has no member '", name, "'", suggestion(name, names)));
}

/// Upvalues as above. Loads lazy members.
int missing_member(lua_State* state) {
  lua_settop(state, 2);
  lua_pushvalue(state, 2);
  if (lua_rawget(state, lua_upvalueindex(2)) == LUA_TNIL) {
    return guard(state, [&]() -> int { throw_unknown(state); });
  }
  lua_getglobal(state, "require");
  lua_pushvalue(state, lua_upvalueindex(1));
  lua_pushliteral(state, ".");
  lua_pushvalue(state, 2);
  lua_concat(state, 3);
  lua_call(state, 1, 1);
  lua_pushvalue(state, 2);
  lua_pushvalue(state, -2);
  lua_rawset(state, 1);
  return 1;
}

/// Pushes a new module table.
void push_module(lua_State* state, const std::string& full_name) {
  lua_newtable(state);
  lua_createtable(state, 0, 2);
  push(state, full_name);
  lua_setfield(state, -2, "__name");
  push(state, full_name);
  lua_newtable(state);
  lua_pushvalue(state, -1);
  lua_setfield(state, -4, "__lazy");
  lua_pushcclosure(state, missing_member, 2);
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

module& module::lazy(const char* name) {
  table_.push();
  luaL_getmetafield(state_, -1, "__lazy");
  lua_pushboolean(state_, 1);
  lua_setfield(state_, -2, name);
  lua_pop(state_, 2);
  return *this;
}

}  // namespace aib::bind
