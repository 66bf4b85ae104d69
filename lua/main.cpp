// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include "shell/shell.hpp"

int main(int argc, char** argv) { return aib::shell::run({argv, argv + argc}); }
