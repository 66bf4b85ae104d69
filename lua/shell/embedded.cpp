// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include "embedded.hpp"

#include "../bind/kit.hpp"
#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace aib::shell {

namespace {

/// Modules that serve the others; `require "aib.suggest"` finds them, `aib` does not show them.
constexpr std::string_view inner_modules[] = {"command_line", "completion", "failure", "help",
                                              "inputs",       "schema",     "stubs",   "suggest"};

/// "protocol" of "aib/protocol.lua", empty for files that are no member of `aib`.
std::string member_name(std::string_view path) {
  constexpr std::string_view folder = "aib/", suffix = ".lua";
  if (!path.starts_with(folder) || !path.ends_with(suffix)) return "";
  path.remove_prefix(folder.size());
  path.remove_suffix(suffix.size());
  const bool inner = std::ranges::find(inner_modules, path) != std::ranges::end(inner_modules);
  return inner || path.find('/') != path.npos ? "" : std::string(path);
}

/// A package searcher: the loader of an embedded module and its path, or why there is none.
int search(lua_State* state) {
  return bind::guard(state, [&] {
    const std::string name = bind::value<std::string>::get(state, 1);
    std::string path = name;
    std::replace(path.begin(), path.end(), '.', '/');
    path += ".lua";
    const std::string_view text = embedded(path);
    if (text.empty()) {
      bind::push(state, "no module '" + name + "' in the binary");
      return 1;
    }
    const std::string chunk = "=" + name;
    if (luaL_loadbufferx(state, text.data(), text.size(), chunk.c_str(), "t") != LUA_OK)
      throw std::runtime_error(bind::value<std::string>::get(state, -1));
    bind::push(state, path);
    return 2;
  });
}

/// Name of a bound function, nil of any other.
std::optional<std::string> name_of(lua_State* state, int index) {
  if (!lua_iscfunction(state, index) || !lua_getupvalue(state, index, 1)) return std::nullopt;
  const void* upvalue = lua_touserdata(state, -1);
  lua_pop(state, 1);
  for (const bind::signature& s : bind::session::of(state).signatures())
    if (&s == upvalue) return s.name;
  return std::nullopt;
}

/// The module "aib.shell" serves help, completion and the tests of the stubs; no member of `aib`.
void bind_introspection(lua_State* state) {
  bind::module module(state, "shell");
  module
      .function("paths", {},
                [] {
                  std::vector<std::string> paths;
                  for (const embedded_file& file : embedded_files()) paths.emplace_back(file.path);
                  return paths;
                })
      .function("text", {"path"}, [](const std::string& path) { return embedded(path); })
      .function("bound_names", {},
                [](bind::session& s) {
                  std::vector<std::string> names;
                  for (const bind::signature& each : s.signatures()) names.push_back(each.name);
                  return names;
                })
      .function("name_of", {"value"}, [](lua_State* l, const sol::object& value) {
        const auto popper = sol::stack::push_pop(value);
        return name_of(l, lua_gettop(l));
      });
  sol::state_view(state).registry()[LUA_LOADED_TABLE]["aib.shell"] = module.table();
  bind::module(state, "").forget("shell");
}

}  // namespace

std::string_view embedded(std::string_view path) {
  for (const embedded_file& file : embedded_files())
    if (file.path == path) return file.text;
  return {};
}

void serve_embedded_modules(lua_State* state) {
  sol::table searchers = sol::state_view(state)["package"]["searchers"];
  searchers.push();
  for (auto i = static_cast<lua_Integer>(lua_rawlen(state, -1)); i >= 2; --i) {
    lua_rawgeti(state, -1, i);
    lua_rawseti(state, -2, i + 1);
  }
  lua_pushcfunction(state, search);
  lua_rawseti(state, -2, 2);
  lua_pop(state, 1);
  bind_introspection(state);
  bind::module root(state, "");
  for (const embedded_file& file : embedded_files()) {
    const std::string name = member_name(file.path);
    if (!name.empty()) root.lazy(name.c_str());
  }
}

}  // namespace aib::shell
