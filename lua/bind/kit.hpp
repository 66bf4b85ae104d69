// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

// Everything that a binding needs. stats.cpp is the worked example. The steps for a new domain:
//   1. lua/bind/<domain>.cpp with one function `void bind_<domain>(lua_State* state)`;
//   2. its name in the list of lua/meson.build, which calls it from the shell;
//   3. its stub lua/meta/aib/<domain>.d.lua, which is also what `help()` prints.
//
// A binding checks nothing by hand and catches nothing: the kit reads arguments and options with
// messages that name function, place, expected and found, and turns every exception into a Lua
// error at the caller's line. Degrees, shares 0..1 and one-based indices are made here.

#include "kit/function.hpp"
#include "kit/guard.hpp"
#include "kit/meter.hpp"
#include "kit/module.hpp"
#include "kit/options.hpp"
#include "kit/point.hpp"
#include "kit/record.hpp"
#include "kit/session.hpp"
#include "kit/show.hpp"
#include "kit/suggest.hpp"
#include "kit/type.hpp"
#include "kit/value.hpp"
