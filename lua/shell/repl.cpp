// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include "repl.hpp"

#include <iostream>
#include <string>

namespace aib::shell {

namespace {

/// Whether a chunk only lacks its end.
bool is_incomplete(const sol::load_result& chunk) {
  if (chunk.status() != sol::load_status::syntax) return false;
  const sol::error e = chunk;
  return std::string_view(e.what()).ends_with("<eof>");
}

}  // namespace

int converse(interpreter& lua) {
  lua.preload();
  for (std::string line; std::cout << "> " << std::flush, std::getline(std::cin, line);)
    lua.execute(line);
  std::cout << '\n';
  return exit_ok;
}

}  // namespace aib::shell
