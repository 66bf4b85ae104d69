// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include "function.hpp"
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace aib::bind {

namespace detail {

/// Fills the metatable on top of the stack: __name, __metatable, __index over the tables of methods
/// and of fields, __newindex, and leaves those two tables above it.
void begin_type(lua_State* state, const std::string& name);

/// Makes a[i], ipairs and pairs of the type, the function on top of the stack gives element i.
void set_elements(lua_State* state, sol::table& metatable);

}  // namespace detail

/// Teaches Lua a C++ type: its objects print themselves, an unknown member is an error with a
/// suggestion, `local x <close>` and `x:close()` free them at once, and the collector knows their
/// size.
///
///   type<cloud::cloud>(state, "cloud", print, bytes)
///       .length([](const cloud::cloud& c) { return c.size(); })
///       .element([](const cloud::cloud& c, std::size_t i) { return c.position(i); })
///       .field("has_normals", [](const cloud::cloud& c) { return !c.normals.empty(); })
///       .method("bounds", {}, [](const cloud::cloud& c) { ... });
///
/// Cross-domain operators meet in methods of agreed names: `transform * thing` calls
/// `thing:transformed(transform)`.
template <class T>
class type {
 public:
  /// print  std::string(const T&), e.g. "cloud(12 points)"
  /// bytes  size_t(const T&): what the object holds outside of itself, for the collector
  type(lua_State* state,
       const std::string& name,
       std::string (*print)(const T&),
       std::size_t (*bytes)(const T&) = nullptr)
      : state_(state), name_(name) {
    registered<T>::name = name;
    registered<T>::print = print;
    registered<T>::bytes = bytes;
    detail::begin_type(state, name);
    fields_ = sol::table(state, -1);
    methods_ = sol::table(state, -2);
    metatable_ = sol::table(state, -3);
    lua_pop(state, 2);
    lua_rawsetp(state, LUA_REGISTRYINDEX, &registered<T>::key);
    raw(metatable_, "__tostring", to_string);
    raw(metatable_, "__gc", close);
    raw(metatable_, "__close", close);
    raw(methods_, "close", close);
  }

  /// `object:name(...)`. The lambda's first parameter is the object; `arguments` names the others.
  template <class F>
  type& method(const char* name, std::vector<std::string> arguments, F f) {
    return set(methods_, name, name_ + ":" + name, std::move(arguments), f);
  }

  /// `object.name`, computed at each access.
  template <class F>
  type& field(const char* name, F f) {
    return set(fields_, name, name_ + "." + name, {}, f);
  }

  /// A metamethod, e.g. "__mul". `arguments` names those after the first.
  template <class F>
  type& meta(const char* name, std::vector<std::string> arguments, F f) {
    return set(metatable_, name, name_ + "." + name, std::move(arguments), f);
  }

  /// `#object`.
  template <class F>
  type& length(F f) {
    return meta("__len", {}, f);
  }

  /// `object[1] .. object[#object]`, ipairs, pairs and `object:to_table([first [, last]])`. The
  /// lambda is given the zero-based index, always below the length; needs `length` first.
  template <class F>
  type& element(F f) {
    push_function(state_, name_ + ".__element", {"self", "index"}, f);
    detail::set_elements(state_, metatable_);
    return *this;
  }

 private:
  static int close(lua_State* state) {
    handle<T>* h = value<T>::handle_at(state, 1);
    if (h) h->close(session::of(state));
    return 0;
  }

  static int to_string(lua_State* state) {
    return guard(state, [&] {
      const handle<T>* h = value<T>::handle_at(state, 1);
      push(state, h && h->held ? registered<T>::print(*h->held) : registered<T>::name + "(closed)");
      return 1;
    });
  }

  static void raw(sol::table& table, const char* name, lua_CFunction f) {
    lua_State* state = table.lua_state();
    table.push();
    lua_pushcfunction(state, f);
    lua_setfield(state, -2, name);
    lua_pop(state, 1);
  }

  template <class F>
  type& set(sol::table& table,
            const char* name,
            std::string full_name,
            std::vector<std::string> arguments,
            F f) {
    arguments.insert(arguments.begin(), "self");
    table.push();
    push_function(state_, std::move(full_name), std::move(arguments), f);
    lua_setfield(state_, -2, name);
    lua_pop(state_, 1);
    return *this;
  }

  lua_State* state_;
  std::string name_;
  sol::table metatable_, methods_, fields_;
};

}  // namespace aib::bind
