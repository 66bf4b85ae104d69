// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

struct lua_State;

namespace aib::bind {

/// Makes the module `aib` with all domains, and `require "aib"` find it. Throws std::exception for
/// a mistake in a binding.
void bind_all(lua_State* state);

}  // namespace aib::bind
