// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include "value.hpp"
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace aib::bind {

/// A result as a Lua table with named fields, which prints itself: `{auc = 0.83, n_pairs = 190}`.
///
///   return record(state).set("auc", r.auc).set("rra", keyed(state, r.tau, r.rra));
class record {
 public:
  explicit record(lua_State* state);

  template <class T>
  record& set(const char* name, T&& field) {
    table_.push();
    bind::push(state_, std::forward<T>(field));
    lua_setfield(state_, -2, name);
    lua_pop(state_, 1);
    return *this;
  }
  const sol::table& table() const { return table_; }

 private:
  lua_State* state_;
  sol::table table_;
};

template <>
struct value<record> {
  static void push(lua_State* state, const record& r) { r.table().push(state); }
};

/// Indices as Lua counts.
std::vector<std::size_t> one_based(std::vector<std::size_t> index);

/// A table from numbers to values, for results at several thresholds: `rra[5]` and `rra[5.0]` are
/// the same.
record keyed(lua_State* state, std::span<const double> keys, std::span<const double> values);

}  // namespace aib::bind
