// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include "bind/aib.hpp"
#include "bind/kit.hpp"
#include "shell/embedded.hpp"
#include <cstdio>
#include <string>

int main(int argc, char** argv) {
  aib::bind::session session;
  sol::state lua;
  session.attach(lua.lua_state());
  lua.open_libraries();
  aib::bind::bind_all(lua.lua_state());
  aib::shell::serve_embedded_modules(lua.lua_state());
  if (argc < 2) return 2;
  const auto result = std::string(argv[1]) == "-e" && argc > 2
                          ? lua.safe_script(argv[2], sol::script_pass_on_error, "=(command line)")
                          : lua.safe_script_file(argv[1], sol::script_pass_on_error);
  if (result.valid()) return 0;
  const sol::error e = result;
  std::fprintf(stderr, "aib-lua: %s\n", e.what());
  return 1;
}
