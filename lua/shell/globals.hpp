// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

struct lua_State;

namespace aib::shell {

/// From now on, reading a global that nobody defined, and defining one inside of a function, are
/// errors on that line, with a suggestion.
void make_globals_strict(lua_State* state);

}  // namespace aib::shell
