// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include "options.hpp"

#include "suggest.hpp"
#include <algorithm>

namespace aib::bind {

options::options(lua_State* state, int index, const std::string& function, const place& at)
    : state_(state), index_(lua_absindex(state, index)), function_(function) {
  if (!lua_isnoneornil(state, index) && !lua_istable(state, index))
    mismatch(at, "table of options", state, index);
}

options::field::field(options& o, const char* name)
    : state_(o.state_), function_(o.function_), name_(name) {
  if (std::find(o.known_.begin(), o.known_.end(), name_) == o.known_.end())
    o.known_.push_back(name_);
  if (lua_isnoneornil(state_, o.index_)) {
    lua_pushnil(state_);
  } else {
    lua_pushstring(state_, name);
    lua_rawget(state_, o.index_);
  }
}

std::vector<double> options::numbers(const char* name, std::vector<double> fallback) {
  const field f(*this, name);
  if (lua_isnil(state_, -1)) return fallback;
  if (value<double>::is(state_, -1)) return {value<double>::get(state_, -1)};
  return checked<std::vector<double>>(state_, lua_gettop(state_), f.at());
}

bool options::has(const char* name) {
  const field f(*this, name);
  return !lua_isnil(state_, -1);
}

void options::reject(const char* name, std::string_view what) const {
  throw argument_error(message(function_, ": option '", name, "': ", what));
}

void options::unknown_choice(const char* name,
                             const std::string& found,
                             const std::vector<std::string>& names) const {
  std::string list;
  for (const std::string& n : names) list += (list.empty() ? "'" : ", '") + n + "'";
  const std::string hint = suggestion(found, names);
  const bool is_near = hint.starts_with(", did you mean");
  reject(name, message("one of ", list, " expected, found '", found, "'", is_near ? hint : ""));
}

void options::done() {
  done_ = true;
  if (lua_isnoneornil(state_, index_)) return;
  lua_pushnil(state_);
  while (lua_next(state_, index_)) {
    if (lua_type(state_, -2) != LUA_TSTRING) {
      throw argument_error(message(function_, ": options are named, found one with the key ",
                                   describe(state_, -2), suggestion("", known_)));
    }
    const std::string name = value<std::string>::get(state_, -2);
    if (std::find(known_.begin(), known_.end(), name) == known_.end())
      throw argument_error(
          message(function_, ": unknown option '", name, "'", suggestion(name, known_)));
    lua_pop(state_, 1);
  }
}

}  // namespace aib::bind
