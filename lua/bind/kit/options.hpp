// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include "value.hpp"
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace aib::bind {

/// One name of a choice and what it stands for.
template <class E>
struct choice {
  const char* name;
  E value;
};

/// An option table, read once: ask for every option that the function knows, then call `done`,
/// before the work begins. Every reader throws argument_error where the value has another type;
/// `done` throws it where an option is left that nobody asked for.
///
///   auto max_deg = o.number("max_deg", 30);
///   auto convention = o.choice("convention", auc_convention::paper,
///                              {{"paper", auc_convention::paper}, {"vggt",
///                              auc_convention::vggt}});
///   o.done();
class options {
 public:
  /// The table at a stack index, which may be nil. Throws argument_error if it is something else.
  options(lua_State* state, int index, const std::string& function, const place& at);

  double number(const char* name, double fallback) { return get<double>(name).value_or(fallback); }
  std::int64_t integer(const char* name, std::int64_t fallback) {
    return get<std::int64_t>(name).value_or(fallback);
  }
  std::size_t count(const char* name, std::size_t fallback) {
    return get<std::size_t>(name).value_or(fallback);
  }
  bool flag(const char* name, bool fallback) { return get<bool>(name).value_or(fallback); }
  std::string text(const char* name, std::string fallback) {
    return get<std::string>(name).value_or(std::move(fallback));
  }
  /// A list of numbers; one number is a list of one.
  std::vector<double> numbers(const char* name, std::vector<double> fallback);

  /// One of the names.
  template <class E>
  E choice(const char* name, E fallback, std::initializer_list<bind::choice<E>> choices) {
    const auto chosen = get<std::string>(name);
    if (!chosen) return fallback;
    std::vector<std::string> names;
    for (const auto& c : choices) {
      if (*chosen == c.name) return c.value;
      names.emplace_back(c.name);
    }
    unknown_choice(name, *chosen, names);
  }

  /// Any type of which `value` knows (a vector, a sol::table, a function ...); nothing where
  /// absent.
  template <class T>
  std::optional<T> get(const char* name) {
    const field f(*this, name);
    if (lua_isnil(state_, -1)) return std::nullopt;
    return checked<T>(state_, lua_gettop(state_), f.at());
  }

  /// An object of a registered type; nullptr where absent.
  template <class T>
  const T* object(const char* name) {
    const field f(*this, name);
    if (lua_isnil(state_, -1)) return nullptr;
    return &checked<T>(state_, lua_gettop(state_), f.at());
  }

  /// Whether the option is given, whatever its type.
  bool has(const char* name);

  /// Throws argument_error that says what is wrong with an option: "aib.f: option 'tau': " + what.
  [[noreturn]] void reject(const char* name, std::string_view what) const;

  /// To be called after the last reader. Throws argument_error for an option that is not known:
  /// "aib.pose.auc: unknown option 'maxdeg', did you mean 'max_deg'?".
  void done();
  bool is_done() const { return done_; }

 private:
  /// Pushes an option's value, pops it at the end.
  class field {
   public:
    field(options& o, const char* name);
    ~field() { lua_pop(state_, 1); }
    field(const field&) = delete;
    field& operator=(const field&) = delete;
    place at() const { return {function_, place::option, name_}; }

   private:
    lua_State* state_;
    const std::string& function_;
    std::string name_;
  };

  [[noreturn]] void unknown_choice(const char* name,
                                   const std::string& found,
                                   const std::vector<std::string>& names) const;

  lua_State* state_;
  int index_;
  std::string function_;
  std::vector<std::string> known_;
  bool done_ = false;
};

}  // namespace aib::bind
