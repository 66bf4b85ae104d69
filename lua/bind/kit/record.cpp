// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include "record.hpp"

#include "guard.hpp"
#include "show.hpp"
#include <cmath>

namespace aib::bind {

namespace {

char record_key;

int print(lua_State* state) {
  return guard(state, [&] {
    push(state, show(state, 1));
    return 1;
  });
}

void push_metatable(lua_State* state) {
  if (lua_rawgetp(state, LUA_REGISTRYINDEX, &record_key) == LUA_TTABLE) return;
  lua_pop(state, 1);
  lua_createtable(state, 0, 2);
  lua_pushcfunction(state, print);
  lua_setfield(state, -2, "__tostring");
  lua_pushboolean(state, 1);
  lua_setfield(state, -2, "__record");
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

std::vector<std::size_t> one_based(std::vector<std::size_t> index) {
  for (std::size_t& i : index) ++i;
  return index;
}

record keyed(lua_State* state, std::span<const double> keys, std::span<const double> values) {
  if (keys.size() != values.size())
    throw argument_error(message("keyed: ", keys.size(), " keys, ", values.size(), " values"));
  for (const double key : keys)
    if (std::isnan(key)) throw argument_error("a threshold is not a number (NaN)");
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
