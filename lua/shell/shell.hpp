// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace aib::shell {

/// The program `aib-lua`: does what the command line asks for and returns the exit code.
int run(const std::vector<std::string>& words);

}  // namespace aib::shell
