// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "value.hpp"
#include <cstddef>
#include <vector>

namespace aib::bind {

/// A fixed-size vector is a list of its coordinates: {x, y, z}.
template <std::floating_point Scalar, int Size>
requires(Size > 0) struct value<Eigen::Matrix<Scalar, Size, 1>> {
  using vector = Eigen::Matrix<Scalar, Size, 1>;

  static std::string expected() { return message("list of ", Size, " numbers"); }
  static bool is(lua_State* state, int index) {
    return value<std::vector<Scalar>>::is(state, index) && lua_rawlen(state, index) == Size;
  }
  static vector get(lua_State* state, int index) {
    return vector::Map(value<std::vector<Scalar>>::get(state, index).data());
  }
  static void push(lua_State* state, const vector& v) {
    value<std::vector<Scalar>>::push(state, {v.begin(), v.end()});
  }
};

/// A fixed-size matrix is a list of its rows.
template <std::floating_point Scalar, int Rows, int Columns, int Options>
requires(Rows > 0 && Columns > 1) struct value<Eigen::Matrix<Scalar, Rows, Columns, Options>> {
  using matrix = Eigen::Matrix<Scalar, Rows, Columns, Options>;
  using row = Eigen::Matrix<Scalar, Columns, 1>;

  static std::string expected() {
    return message("list of ", Rows, " rows of ", Columns, " numbers");
  }
  static bool is(lua_State* state, int index) {
    return value<std::vector<row>>::is(state, index) && lua_rawlen(state, index) == Rows;
  }
  static matrix get(lua_State* state, int index) {
    const std::vector<row> rows = value<std::vector<row>>::get(state, index);
    matrix m;
    for (int r = 0; r < Rows; ++r) m.row(r) = rows[static_cast<std::size_t>(r)];
    return m;
  }
  static void push(lua_State* state, const matrix& m) {
    std::vector<row> rows;
    for (int r = 0; r < Rows; ++r) rows.push_back(m.row(r));
    value<std::vector<row>>::push(state, rows);
  }
};

}  // namespace aib::bind
