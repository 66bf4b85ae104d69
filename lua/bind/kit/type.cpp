// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include "type.hpp"

#include "suggest.hpp"
#include <algorithm>

namespace aib::bind::detail {

namespace {

std::vector<std::string> names_in(lua_State* state, int table) {
  std::vector<std::string> names;
  lua_pushnil(state);
  while (lua_next(state, table)) {
    names.push_back(value<std::string>::get(state, -2));
    lua_pop(state, 1);
  }
  return names;
}

/// Upvalues: methods, fields, name. Elements are tried first by set_elements' own __index.
int member(lua_State* state) {
  lua_settop(state, 2);
  for (const int upvalue : {1, 2}) {
    lua_pushvalue(state, 2);
    if (lua_rawget(state, lua_upvalueindex(upvalue)) == LUA_TNIL) {
      lua_pop(state, 1);
      continue;
    }
    if (upvalue == 1) return 1;
    lua_pushvalue(state, 1);
    lua_call(state, 1, 1);
    return 1;
  }
  return guard(state, [&]() -> int {
    const std::string type = value<std::string>::get(state, lua_upvalueindex(3));
    if (lua_type(state, 2) != LUA_TSTRING)
      throw argument_error(message(type, " has no member ", describe(state, 2)));
    std::vector<std::string> names = names_in(state, lua_upvalueindex(1));
    for (std::string& field : names_in(state, lua_upvalueindex(2)))
      names.push_back(std::move(field));
    std::sort(names.begin(), names.end());
    const std::string name = value<std::string>::get(state, 2);
    throw argument_error(message(type, " has no member '", name, "'", suggestion(name, names)));
  });
}

/// Upvalue: name.
int refuse(lua_State* state) {
  return guard(state, [&]() -> int {
    const std::string type = value<std::string>::get(state, lua_upvalueindex(1));
    throw argument_error(message(type, " is read-only: cannot set ", describe(state, 2)));
  });
}

/// Upvalues: element function, the __index before.
int index(lua_State* state) {
  int exact = 0;
  const lua_Integer i = lua_type(state, 2) == LUA_TNUMBER ? lua_tointegerx(state, 2, &exact) : 0;
  if (!exact) {
    lua_pushvalue(state, lua_upvalueindex(2));
    lua_insert(state, 1);
    lua_call(state, 2, 1);
    return 1;
  }
  if (i < 1 || i > luaL_len(state, 1)) return 0;
  lua_pushvalue(state, lua_upvalueindex(1));
  lua_pushvalue(state, 1);
  lua_pushinteger(state, i - 1);
  lua_call(state, 2, 1);
  return 1;
}

/// Upvalue: element function.
int next(lua_State* state) {
  const lua_Integer i = lua_tointeger(state, 2) + 1;
  if (i > luaL_len(state, 1)) return 0;
  lua_pushinteger(state, i);
  lua_pushvalue(state, lua_upvalueindex(1));
  lua_pushvalue(state, 1);
  lua_pushinteger(state, i - 1);
  lua_call(state, 2, 1);
  return 2;
}

/// Upvalue: element function.
int pairs(lua_State* state) {
  lua_pushvalue(state, lua_upvalueindex(1));
  lua_pushcclosure(state, next, 1);
  lua_pushvalue(state, 1);
  lua_pushinteger(state, 0);
  return 3;
}

/// Upvalue: element function. As string.sub: (first = 1, last = -1), negative from the end.
int to_table(lua_State* state) {
  const lua_Integer n = luaL_len(state, 1);
  const auto bound = [&](int argument, lua_Integer otherwise) {
    const lua_Integer i = luaL_optinteger(state, argument, otherwise);
    return i < 0 ? n + 1 + i : i;
  };
  const lua_Integer first = std::max<lua_Integer>(bound(2, 1), 1);
  const lua_Integer last = std::min(bound(3, -1), n);
  const lua_Integer size = std::max<lua_Integer>(last - first + 1, 0);
  lua_createtable(state, static_cast<int>(std::min<lua_Integer>(size, 1 << 30)), 0);
  for (lua_Integer i = first; i <= last; ++i) {
    lua_pushvalue(state, lua_upvalueindex(1));
    lua_pushvalue(state, 1);
    lua_pushinteger(state, i - 1);
    lua_call(state, 2, 1);
    lua_rawseti(state, -2, i - first + 1);
  }
  return 1;
}

}  // namespace

void begin_type(lua_State* state, const std::string& name) {
  lua_newtable(state);  // metatable, methods, fields
  lua_newtable(state);
  lua_newtable(state);
  const int metatable = lua_gettop(state) - 2;
  for (const char* field : {"__name", "__metatable"}) {
    push(state, name);
    lua_setfield(state, metatable, field);
  }
  lua_pushvalue(state, metatable + 1);
  lua_pushvalue(state, metatable + 2);
  push(state, name);
  lua_pushcclosure(state, member, 3);
  lua_setfield(state, metatable, "__index");
  push(state, name);
  lua_pushcclosure(state, refuse, 1);
  lua_setfield(state, metatable, "__newindex");
  lua_pushvalue(state, metatable + 1);
  lua_setfield(state, metatable, "__methods");
  lua_pushvalue(state, metatable + 2);
  lua_setfield(state, metatable, "__fields");
}

void set_elements(lua_State* state, sol::table& metatable) {
  const int element = lua_gettop(state);
  metatable.push();
  lua_pushvalue(state, element);
  lua_getfield(state, element + 1, "__index");
  lua_pushcclosure(state, index, 2);
  lua_setfield(state, element + 1, "__index");
  lua_pushvalue(state, element);
  lua_pushcclosure(state, pairs, 1);
  lua_setfield(state, element + 1, "__pairs");
  lua_getfield(state, element + 1, "__methods");
  lua_pushvalue(state, element);
  lua_pushcclosure(state, to_table, 1);
  lua_setfield(state, -2, "to_table");
  lua_settop(state, element - 1);
}

}  // namespace aib::bind::detail
