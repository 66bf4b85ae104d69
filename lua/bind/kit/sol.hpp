// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

// Every check of sol2 is on. Functions are bound through bind::guard, not through sol2's own
// wrappers; these must not catch everything, because Lua's own errors are C++ throws where Lua was
// built as C++.
#define SOL_ALL_SAFETIES_ON 1
#define SOL_EXCEPTIONS_CATCH_ALL 0
#define SOL_PRINT_ERRORS 0

#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#endif
#include <sol/sol.hpp>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif
