// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include "aib.hpp"

#include <aib/core/isa.hpp>

#include "kit.hpp"
#include <string>

namespace aib::bind {

// domains.inc is made by lua/meson.build: a line `AIB_DOMAIN(name)` for each file of its list.
#define AIB_DOMAIN(name) void bind_##name(lua_State* state);
#include "domains.inc"
#undef AIB_DOMAIN

namespace {

void bind_core(lua_State* state) {
  module(state, "")
      .set("version", AIB_VERSION)
      .set("instruction_set", instruction_set)
      .function("error_kind", {"message"},
                [](session& s, const sol::object& caught) {
                  return name_of(s.kind_of(read_if<std::string>(caught).value_or("")));
                })
      .function("type", {"value"}, [](lua_State* l, const sol::object& object) {
        const auto popper = sol::stack::push_pop(object);
        return type_name(l, lua_gettop(l));
      });
}

}  // namespace

void bind_all(lua_State* state) {
  bind_core(state);
#define AIB_DOMAIN(name) bind_##name(state);
#include "domains.inc"
#undef AIB_DOMAIN
  sol::state_view(state).registry()[LUA_LOADED_TABLE]["aib"] = module(state, "").table();
}

}  // namespace aib::bind
