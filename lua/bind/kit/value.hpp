// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include "session.hpp"
#include <concepts>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace aib::bind {

/// What a Lua value is, for messages: "nil", "number 3", "string 'abc'", "table", "cloud".
std::string describe(lua_State* state, int index);

/// Name of a Lua value's type: that of a bound type ("cloud"), else Lua's own ("table").
std::string type_name(lua_State* state, int index);

/// Where a value stands, for messages: an argument or an option of a function.
struct place {
  static constexpr int option = -1;
  const std::string& function;
  int argument;  ///< one-based, the object of a method is 0; `option`
  const std::string& name;

  std::string text() const;
};

/// Throws argument_error: "aib.pose.auc: argument 1 (est): trajectory expected, found nil".
[[noreturn]] void mismatch(const place& at,
                           const std::string& expected,
                           lua_State* state,
                           int index);

/// How a C++ type stands in Lua. A specialisation has
///   static std::string expected();                    what messages call it
///   static bool is(lua_State*, int index);            whether `get` may be called
///   static T get(lua_State*, int index);              (T& for types of `bind::type`)
///   static void push(lua_State*, T);
/// The primary template serves the types that `bind::type` registers.
template <class T>
struct value;

/// Value of an argument or option. Throws argument_error where it is something else.
template <class T>
decltype(auto) checked(lua_State* state, int index, const place& at) {
  if (!value<T>::is(state, index)) mismatch(at, value<T>::expected(), state, index);
  return value<T>::get(state, index);
}

/// What the userdata of a registered type holds. Emptied by `close`.
template <class T>
struct handle {
  std::unique_ptr<T> held;
  std::size_t bytes = 0;

  void close(session& s) {
    s.shrank(std::exchange(bytes, 0));
    held.reset();
  }
};

/// What `bind::type` knows of T in this process.
template <class T>
struct registered {
  static inline std::string name = "value of a type that is not bound";
  static inline std::string (*print)(const T&) = nullptr;
  static inline std::size_t (*bytes)(const T&) = nullptr;
  static inline char key = 0;  ///< its address finds the metatable in the registry
};

template <class T>
struct value {
  static std::string expected() { return registered<T>::name; }
  static bool is(lua_State* state, int index) { return handle_at(state, index) != nullptr; }
  static T& get(lua_State* state, int index) {
    handle<T>* h = handle_at(state, index);
    if (!h->held) throw argument_error(registered<T>::name + " is closed");
    return *h->held;
  }
  static void push(lua_State* state, T object) {
    if (!registered<T>::print)
      throw std::logic_error("a binding gives a value of a type that nobody bound");
    auto held = std::make_unique<T>(std::move(object));
    session& s = session::of(state);
    const std::size_t bytes = sizeof(T) + (registered<T>::bytes ? registered<T>::bytes(*held) : 0);
    s.grew(state, bytes);
    void* memory = lua_newuserdatauv(state, sizeof(handle<T>), 0);
    new (memory) handle<T>{std::move(held), bytes};
    lua_rawgetp(state, LUA_REGISTRYINDEX, &registered<T>::key);
    lua_setmetatable(state, -2);
  }

  /// The handle at the index, nullptr where there is something else.
  static handle<T>* handle_at(lua_State* state, int index) {
    void* memory = lua_touserdata(state, index);
    if (!memory || !lua_getmetatable(state, index)) return nullptr;
    lua_rawgetp(state, LUA_REGISTRYINDEX, &registered<T>::key);
    const bool same = !lua_isnil(state, -1) && lua_rawequal(state, -1, -2);
    lua_pop(state, 2);
    return same ? static_cast<handle<T>*>(memory) : nullptr;
  }
};

template <std::floating_point T>
struct value<T> {
  static std::string expected() { return "number"; }
  static bool is(lua_State* state, int index) { return lua_type(state, index) == LUA_TNUMBER; }
  static T get(lua_State* state, int index) { return static_cast<T>(lua_tonumber(state, index)); }
  static void push(lua_State* state, T number) {
    lua_pushnumber(state, static_cast<lua_Number>(number));
  }
};

/// A float of integer value is an integer (10 == 10.0).
template <std::integral T>
struct value<T> {
  static std::string expected() { return std::is_signed_v<T> ? "integer" : "integer >= 0"; }
  static bool is(lua_State* state, int index) {
    int exact = 0;
    const lua_Integer n = lua_tointegerx(state, index, &exact);
    return lua_type(state, index) == LUA_TNUMBER && exact && std::in_range<T>(n);
  }
  static T get(lua_State* state, int index) { return static_cast<T>(lua_tointeger(state, index)); }
  static void push(lua_State* state, T number) {
    if (std::in_range<lua_Integer>(number)) {
      lua_pushinteger(state, static_cast<lua_Integer>(number));
    } else {
      lua_pushnumber(state, static_cast<lua_Number>(number));
    }
  }
};

template <>
struct value<bool> {
  static std::string expected() { return "boolean"; }
  static bool is(lua_State* state, int index) { return lua_isboolean(state, index); }
  static bool get(lua_State* state, int index) { return lua_toboolean(state, index) != 0; }
  static void push(lua_State* state, bool flag) { lua_pushboolean(state, flag); }
};

template <>
struct value<std::string> {
  static std::string expected() { return "string"; }
  static bool is(lua_State* state, int index) { return lua_type(state, index) == LUA_TSTRING; }
  static std::string get(lua_State* state, int index) {
    std::size_t size = 0;
    const char* text = lua_tolstring(state, index, &size);
    return {text, size};
  }
  static void push(lua_State* state, const std::string& text) {
    lua_pushlstring(state, text.data(), text.size());
  }
};

template <>
struct value<const char*> {
  static void push(lua_State* state, const char* text) { lua_pushstring(state, text); }
};

template <>
struct value<std::string_view> {
  static void push(lua_State* state, std::string_view text) {
    lua_pushlstring(state, text.data(), text.size());
  }
};

/// A zero byte would end the name for the system, which would find another file.
template <>
struct value<std::filesystem::path> {
  static std::string expected() { return "path (string)"; }
  static bool is(lua_State* state, int index) {
    return value<std::string>::is(state, index) &&
           value<std::string>::get(state, index).find('\0') == std::string::npos;
  }
  static std::filesystem::path get(lua_State* state, int index) {
    return value<std::string>::get(state, index);
  }
  static void push(lua_State* state, const std::filesystem::path& path) {
    value<std::string>::push(state, path.string());
  }
};

/// "integers >= 0", "lists of 3 numbers", "trajectories": several of what `expected` calls one.
std::string plural(const std::string& one);

/// A table whose elements 1..#t are all T.
template <class T>
struct value<std::vector<T>> {
  static std::string expected() { return "list of " + plural(value<T>::expected()); }
  static bool is(lua_State* state, int index) {
    if (!lua_istable(state, index)) return false;
    index = lua_absindex(state, index);
    const auto n = static_cast<lua_Integer>(lua_rawlen(state, index));
    for (lua_Integer i = 1; i <= n; ++i) {
      lua_rawgeti(state, index, i);
      const bool fits = value<T>::is(state, -1);
      lua_pop(state, 1);
      if (!fits) return false;
    }
    return true;
  }
  static std::vector<T> get(lua_State* state, int index) {
    index = lua_absindex(state, index);
    const auto n = static_cast<lua_Integer>(lua_rawlen(state, index));
    std::vector<T> list;
    list.reserve(static_cast<std::size_t>(n));
    for (lua_Integer i = 1; i <= n; ++i) {
      lua_rawgeti(state, index, i);
      list.push_back(value<T>::get(state, -1));
      lua_pop(state, 1);
    }
    return list;
  }
  static void push(lua_State* state, const std::vector<T>& list) {
    lua_createtable(state, static_cast<int>(list.size()), 0);
    for (std::size_t i = 0; i < list.size(); ++i) {
      value<T>::push(state, list[i]);
      lua_rawseti(state, -2, static_cast<lua_Integer>(i + 1));
    }
  }
};

/// nil is no value.
template <class T>
struct value<std::optional<T>> {
  static std::string expected() { return value<T>::expected() + " or nil"; }
  static bool is(lua_State* state, int index) {
    return lua_isnoneornil(state, index) || value<T>::is(state, index);
  }
  static std::optional<T> get(lua_State* state, int index) {
    if (lua_isnoneornil(state, index)) return std::nullopt;
    return value<T>::get(state, index);
  }
  static void push(lua_State* state, std::optional<T> maybe) {
    if (maybe) {
      value<T>::push(state, *std::move(maybe));
    } else {
      lua_pushnil(state);
    }
  }
};

/// A pointer to a registered type: nullptr where the argument is nil or absent.
template <class T>
struct value<const T*> {
  static std::string expected() { return value<T>::expected() + " or nil"; }
  static bool is(lua_State* state, int index) {
    return lua_isnoneornil(state, index) || value<T>::is(state, index);
  }
  static const T* get(lua_State* state, int index) {
    return lua_isnoneornil(state, index) ? nullptr : &value<T>::get(state, index);
  }
};

/// sol2's views of any Lua value; registry references, so they may outlive the call.
template <class T>
requires std::derived_from<T, sol::reference>
struct value<T> {
  static std::string expected() {
    if constexpr (std::is_base_of_v<sol::table, T>) return "table";
    if constexpr (std::is_same_v<sol::protected_function, T>) return "function";
    return "value";
  }
  static bool is(lua_State* state, int index) {
    if constexpr (std::is_base_of_v<sol::table, T>) return lua_istable(state, index);
    if constexpr (std::is_same_v<sol::protected_function, T>) return lua_isfunction(state, index);
    return true;
  }
  static T get(lua_State* state, int index) {
    if (lua_isnone(state, index)) return T(sol::lua_nil);
    return T(state, index);
  }
  static void push(lua_State* state, const T& object) { object.push(state); }
};

/// Pushes any value of which `value` knows.
template <class T>
void push(lua_State* state, T&& object) {
  value<std::decay_t<T>>::push(state, std::forward<T>(object));
}

/// The registered object behind a Lua value, nullptr where it is something else.
/// For arguments of more than one type: take a sol::object and ask.
template <class T>
T* get_if(const sol::object& object) {
  lua_State* state = object.lua_state();
  const auto popper = sol::stack::push_pop(object);
  return value<T>::is(state, -1) ? &value<T>::get(state, -1) : nullptr;
}

/// The value as a T where it is one.
template <class T>
std::optional<T> read_if(const sol::object& object) {
  lua_State* state = object.lua_state();
  const auto popper = sol::stack::push_pop(object);
  if (!value<T>::is(state, lua_gettop(state))) return std::nullopt;
  return value<T>::get(state, lua_gettop(state));
}

}  // namespace aib::bind
