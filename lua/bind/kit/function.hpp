// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include "guard.hpp"
#include "options.hpp"
#include "record.hpp"
#include "value.hpp"
#include <cstddef>
#include <stdexcept>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace aib::bind {

/// Returned by a method that gives back its own object, so that calls chain.
struct self {};

/// Several results of one call: `return results(est2, ref2, info);`
template <class... T>
std::tuple<std::decay_t<T>...> results(T&&... values) {
  return {std::forward<T>(values)...};
}

namespace detail {

/// Parameters that the shell supplies; they take no Lua argument.
template <class P>
inline constexpr bool is_supplied =
    std::is_same_v<P, lua_State*> || std::is_same_v<std::decay_t<P>, session>;

/// One parameter of a bound function, read from the Lua stack.
template <class P>
struct parameter {
  using type = std::remove_cvref_t<P>;
  decltype(value<type>::get(nullptr, 0)) from_lua;
  static_assert(
      std::is_reference_v<P> || !std::is_reference_v<decltype(from_lua)>,
      "by value it would be moved out of the object that Lua keeps: take it by reference");

  parameter(lua_State* state, const signature& s, int index)
      : from_lua(checked<type>(state, index, at(s, index))) {}
  P get() { return std::forward<P>(from_lua); }
  static place at(const signature& s, int index) {
    const bool method = s.arguments.front() == "self";
    return {s.name, method ? index - 1 : index,
            s.arguments.at(static_cast<std::size_t>(index - 1))};
  }
};

template <>
struct parameter<options&> {
  options from_lua;
  parameter(lua_State* state, const signature& s, int index)
      : from_lua(state, index, s.name, parameter<bool>::at(s, index)) {}
  options& get() { return from_lua; }
};

template <>
struct parameter<lua_State*> {
  lua_State* state;
  parameter(lua_State* l, const signature&, int) : state(l) {}
  lua_State* get() { return state; }
};

template <>
struct parameter<session&> {
  session& from_lua;
  parameter(lua_State* state, const signature&, int) : from_lua(session::of(state)) {}
  session& get() { return from_lua; }
};

template <class P>
void require_done(const parameter<P>&, const signature&) {}
inline void require_done(const parameter<options&>& p, const signature& s) {
  if (!p.from_lua.is_done()) throw std::logic_error(s.name + ": the binding never calls done()");
}

inline int push_results(lua_State* state, self&&) {
  lua_pushvalue(state, 1);
  return 1;
}
template <class T>
int push_results(lua_State* state, T&& result) {
  push(state, std::forward<T>(result));
  return 1;
}
template <class... T>
int push_results(lua_State* state, std::tuple<T...>&& results) {
  luaL_checkstack(state, static_cast<int>(sizeof...(T)), "too many results");
  std::apply([&](auto&... r) { (push(state, std::move(r)), ...); }, results);
  return static_cast<int>(sizeof...(T));
}

template <class F>
struct invoker : invoker<decltype(&F::operator())> {};

template <class F, class R, class... P>
struct invoker<R (F::*)(P...) const> {
  static constexpr int count = (0 + ... + !is_supplied<P>);

  static int invoke(lua_State* state, const signature& s) {
    return invoke(state, s, std::index_sequence_for<P...>{});
  }

 private:
  /// Lua index of parameter number `wanted`.
  static constexpr int lua_index(std::size_t wanted) {
    const bool supplied[] = {is_supplied<P>..., false};
    int index = 1;
    for (std::size_t i = 0; i < wanted; ++i) index += !supplied[i];
    return index;
  }

  template <std::size_t... I>
  static int invoke(lua_State* state, const signature& s, std::index_sequence<I...>) {
    if (!s.variadic && lua_gettop(state) > count) {
      throw argument_error(
          message(s.name, ": at most ", count, " arguments expected, found ", lua_gettop(state)));
    }
    lua_settop(state, count);
    std::tuple<parameter<P>...> parameters{parameter<P>(state, s, lua_index(I))...};
    if constexpr (std::is_void_v<R>) {
      F{}(std::get<I>(parameters).get()...);
      (require_done(std::get<I>(parameters), s), ...);
      return 0;
    } else {
      R result = F{}(std::get<I>(parameters).get()...);
      (require_done(std::get<I>(parameters), s), ...);
      return push_results(state, std::move(result));
    }
  }
};

template <class F>
int entry(lua_State* state) {
  const auto& s = *static_cast<const signature*>(lua_touserdata(state, lua_upvalueindex(1)));
  return guard(state, [&] { return invoker<F>::invoke(state, s); });
}

}  // namespace detail

/// Pushes a captureless lambda as a Lua function. Its parameters may be
///   const T& or T&          a registered type
///   const T*                the same or nil
///   double, std::int64_t, std::size_t, bool, std::string, std::filesystem::path
///   std::vector<T>, std::optional<T>, sol::table, sol::protected_function, sol::object
///   options&                the table of options, or nil
///   session&, lua_State*    supplied by the shell, no argument in Lua
/// and it returns nothing, anything that `value` knows, `self{}`, or `results(...)`.
/// `arguments` names the Lua arguments, for messages.
template <class F>
void push_function(lua_State* state, std::string name, std::vector<std::string> arguments, F) {
  static_assert(std::is_empty_v<F>, "a bound function captures nothing");
  if (arguments.size() != detail::invoker<F>::count)
    throw std::logic_error(name + ": as many argument names as Lua arguments expected");
  const bool variadic = name.find("__") != std::string::npos;
  const signature& kept =
      session::of(state).keep({std::move(name), std::move(arguments), variadic});
  lua_pushlightuserdata(state, const_cast<signature*>(&kept));
  lua_pushcclosure(state, detail::entry<F>, 1);
}

}  // namespace aib::bind
