// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>
#include <vector>

struct lua_State;

namespace aib::shell {

/// A file that the binary carries.
struct embedded_file {
  std::string_view path;  ///< below lua/: "aib/protocol.lua", "meta/aib/pose.d.lua"
  std::string_view text;
};

/// The Lua modules and the stubs, by path. Written by embed.py.
const std::vector<embedded_file>& embedded_files();

/// The text of an embedded file, empty where there is none.
std::string_view embedded(std::string_view path);

/// Lets `require "aib.x.y"` find the embedded aib/x/y.lua, and `aib.x` load the public ones of
/// them.
void serve_embedded_modules(lua_State* state);

}  // namespace aib::shell
