// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include "interpreter.hpp"

namespace aib::shell {

/// Reads, runs and prints until the end of input. Returns the exit code.
int converse(interpreter& lua);

}  // namespace aib::shell
