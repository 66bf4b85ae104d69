// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include "record.hpp"

#include "guard.hpp"
#include <algorithm>

namespace aib::bind {

namespace {

char record_key;

std::string shown(lua_State* state, int index) {
  std::size_t size = 0;
  const char* text = luaL_tolstring(state, index, &size);
  std::string out(text, size);
  lua_pop(state, 1);
  return lua_type(state, index) == LUA_TSTRING ? '"' + out + '"' : out;
}

/// `{a = 1, b = {...}}`, fields in alphabetical order, numbers ascending.
int print(lua_State* state) {
  return guard(state, [&] {
    std::vector<std::pair<double, std::string>> numbers;
    std::vector<std::string> names;
    lua_pushnil(state);
    while (lua_next(state, 1)) {
      const std::string text = shown(state, lua_gettop(state));
      if (lua_type(state, -2) == LUA_TNUMBER) {
        lua_pushvalue(state, -2);
        const std::string key = shown(state, lua_gettop(state));
        lua_pop(state, 1);
        numbers.emplace_back(lua_tonumber(state, -2), "[" + key + "] = " + text);
      } else {
        names.push_back(shown(state, lua_gettop(state) - 1));
        names.back() = names.back().substr(1, names.back().size() - 2) + " = " + text;
      }
      lua_pop(state, 1);
    }
    std::sort(names.begin(), names.end());
    std::sort(numbers.begin(), numbers.end());
    std::string out;
    for (const std::string& n : names) out += (out.empty() ? "" : ", ") + n;
    for (const auto& n : numbers) out += (out.empty() ? "" : ", ") + n.second;
    push(state, "{" + out + "}");
    return 1;
  });
}

void push_metatable(lua_State* state) {
  if (lua_rawgetp(state, LUA_REGISTRYINDEX, &record_key) == LUA_TTABLE) return;
  lua_pop(state, 1);
  lua_createtable(state, 0, 2);
  lua_pushcfunction(state, print);
  lua_setfield(state, -2, "__tostring");
  lua_pushvalue(state, -1);
  lua_rawsetp(state, LUA_REGISTRYINDEX, &record_key);
}

}  // namespace

record::record(lua_State* state) : state_(state) {
  lua_newtable(state);
  push_metatable(state);
  lua_setmetatable(state, -2);
  table_ = sol::table(state, -1);
  lua_pop(state, 1);
}

record keyed(lua_State* state, std::span<const double> keys, std::span<const double> values) {
  if (keys.size() != values.size())
    throw argument_error(message("keyed: ", keys.size(), " keys, ", values.size(), " values"));
  record r(state);
  r.table().push();
  for (std::size_t i = 0; i < keys.size(); ++i) {
    lua_pushnumber(state, keys[i]);
    lua_pushnumber(state, values[i]);
    lua_rawset(state, -3);
  }
  lua_pop(state, 1);
  return r;
}

}  // namespace aib::bind
