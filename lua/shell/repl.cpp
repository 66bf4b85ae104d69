// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include "repl.hpp"

#include "../bind/kit/show.hpp"
#include "../bind/kit/value.hpp"
#include "line_editor.hpp"
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <string>
#include <string_view>

namespace aib::shell {

namespace {

namespace fs = std::filesystem;

/// Where the lines of earlier sessions are kept, as the XDG base directories say.
fs::path history_file() {
  if (const char* state = std::getenv("XDG_STATE_HOME"); state && *state)
    return fs::path(state) / "aib" / "history";
  if (const char* home = std::getenv("HOME"); home && *home)
    return fs::path(home) / ".local" / "state" / "aib" / "history";
  return {};
}

/// Prints values and keeps the first one as `_`.
class prompt {
 public:
  explicit prompt(interpreter& lua)
      : lua_(lua),
        complete_(module("aib.completion").get<sol::protected_function>("complete")),
        editor_([this](const std::string& before) { return completions(before); }, history_file()) {
    lua.set_global("help", module("aib.help"));
  }

  int run() {
    while (const auto chunk = read_chunk()) evaluate(*chunk);
    std::cout << std::endl;
    return exit_ok;
  }

 private:
  sol::table module(const char* name) {
    return lua_.view().get<sol::protected_function>("require")(name).get<sol::table>();
  }

  std::vector<std::string> completions(const std::string& before) {
    const sol::protected_function_result result = complete_(before);
    if (!result.valid()) return {};
    return bind::read_if<std::vector<std::string>>(result.get<sol::object>())
        .value_or(std::vector<std::string>());
  }

  /// Lines until they are a whole chunk, or wrong in another way than being too short.
  std::optional<std::string> read_chunk() {
    std::string chunk;
    for (;;) {
      const auto line = editor_.read(chunk.empty() ? "> " : ">> ");
      if (!line) return std::nullopt;
      if (editor_.interrupted()) {
        chunk.clear();
        continue;
      }
      editor_.remember(*line);
      chunk += (chunk.empty() ? "" : "\n") + *line;
      if (!is_incomplete(chunk)) return chunk;
    }
  }

  sol::load_result load(const std::string& chunk) { return lua_.view().load(chunk, "=stdin"); }

  sol::load_result load_expression(const std::string& chunk) { return load("return " + chunk); }

  bool is_incomplete(const std::string& chunk) {
    if (load_expression(chunk).valid()) return false;
    const sol::load_result result = load(chunk);
    if (result.valid()) return false;
    const sol::error e = result;
    return std::string_view(e.what()).ends_with("<eof>");
  }

  void evaluate(const std::string& chunk) {
    const bool is_expression = load_expression(chunk).valid();
    const auto done = lua_.call(is_expression ? load_expression(chunk) : load(chunk));
    if (done.results.empty()) return;
    std::string text;
    for (const sol::object& value : done.results) {
      const auto popper = sol::stack::push_pop(value);
      text += (text.empty() ? "" : "  ") + bind::show(lua_.state(), lua_gettop(lua_.state()));
    }
    std::cout << text << std::endl;
    lua_.set_global("_", done.results.front());
  }

  interpreter& lua_;
  sol::protected_function complete_;
  line_editor editor_;
};

}  // namespace

int converse(interpreter& lua) {
  lua.preload();
  return prompt(lua).run();
}

}  // namespace aib::shell
