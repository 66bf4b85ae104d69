// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/math/camera.hpp>

#include "kit.hpp"
#include <map>
#include <string>
#include <utility>

namespace aib::bind {

/// Cameras by image name: `{ ["000001.png"] = camera, ... }`.
using camera_map = std::map<std::string, math::camera>;

template <>
struct value<camera_map> {
  static std::string expected() { return "table of cameras by image name"; }
  static bool is(lua_State* state, int index) {
    if (!lua_istable(state, index)) return false;
    return visit(state, index, [&] {
      return lua_type(state, -2) == LUA_TSTRING && value<math::camera>::is(state, -1);
    });
  }
  static camera_map get(lua_State* state, int index) {
    camera_map cameras;
    visit(state, index, [&] {
      cameras.emplace(value<std::string>::get(state, -2), value<math::camera>::get(state, -1));
      return true;
    });
    return cameras;
  }
  static void push(lua_State* state, const camera_map& cameras) {
    lua_createtable(state, 0, static_cast<int>(cameras.size()));
    for (const auto& [name, camera] : cameras) {
      value<std::string>::push(state, name);
      value<math::camera>::push(state, camera);
      lua_rawset(state, -3);
    }
  }

 private:
  /// Calls `fits` with key and value on top of the stack until it says no.
  template <class Fits>
  static bool visit(lua_State* state, int index, Fits&& fits) {
    index = lua_absindex(state, index);
    lua_pushnil(state);
    while (lua_next(state, index) != 0) {
      if (!fits()) {
        lua_pop(state, 2);
        return false;
      }
      lua_pop(state, 1);
    }
    return true;
  }
};

}  // namespace aib::bind
