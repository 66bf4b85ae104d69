// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include "sol.hpp"
#include <cstddef>
#include <string>

namespace aib::bind {

/// A Lua value as text for people: strings in quotes, objects as they print themselves, tables with
/// their list first and then their names in order, over several lines where one of `width` is too
/// short. Long lists and deep tables are cut, which is said.
std::string show(lua_State* state, int index, std::size_t width = 100);

}  // namespace aib::bind
