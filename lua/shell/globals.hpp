// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

struct lua_State;

namespace aib::shell {

/// From now on, reading a global that nobody defined, and defining one inside of a function, are
/// errors on that line, with a suggestion.
void make_globals_strict(lua_State* state);

/// Numbers have a decimal point, and texts the order of their bytes, whatever locale a script asks
/// for: os.setlocale leaves the categories "numeric" and "collate" alone.
void keep_results_plain(lua_State* state);

}  // namespace aib::shell
