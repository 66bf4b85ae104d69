// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include "function.hpp"
#include "type.hpp"
#include <string>
#include <utility>
#include <vector>

namespace aib::bind {

/// A Lua module under construction: `aib` or `aib.pose`. Reading a name that it does not have is an
/// error with a suggestion.
class module {
 public:
  /// Opens `aib.name`, made if need be; the module of the name "" is `aib` itself.
  module(lua_State* state, const std::string& name);

  /// `aib.module.name(...)`; see push_function for the lambda.
  template <class F>
  module& function(const char* name, std::vector<std::string> arguments, F f) {
    table_.push();
    push_function(state_, name_ + "." + name, std::move(arguments), f);
    lua_setfield(state_, -2, name);
    lua_pop(state_, 1);
    return *this;
  }

  /// A constant.
  template <class T>
  module& set(const char* name, T&& constant) {
    table_.push();
    push(state_, std::forward<T>(constant));
    lua_setfield(state_, -2, name);
    lua_pop(state_, 1);
    return *this;
  }

  /// A member that is `require "aib.module.name"`, loaded when it is first asked for.
  module& lazy(const char* name);

  /// Takes a member out again.
  module& forget(const char* name) {
    table_.raw_set(name, sol::lua_nil);
    return *this;
  }

  const sol::table& table() const { return table_; }

 private:
  lua_State* state_;
  std::string name_;
  sol::table table_;
};

}  // namespace aib::bind
