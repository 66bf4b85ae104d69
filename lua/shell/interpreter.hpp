// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include "../bind/kit/session.hpp"
#include "../bind/kit/sol.hpp"
#include "invocation.hpp"
#include <cstddef>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

namespace aib::shell {

/// What a process returns.
enum exit_code {
  exit_ok = 0,
  exit_script = 1,
  exit_usage = 2,
  exit_input = 3,
  exit_interrupted = 130
};

/// Lua with the libraries, the module `aib` and strict globals.
class interpreter {
 public:
  /// memory  bytes that Lua values may take
  explicit interpreter(bool ignore_environment = false,
                       std::size_t memory = std::numeric_limits<std::size_t>::max());

  /// Sets the global `arg` as lua does: the script is arg[0], its arguments follow.
  void set_arguments(const invocation& call);
  /// Makes `aib` a global, for prompts and one-liners.
  void preload();
  /// `-l NAME=MODULE` or `-l MODULE`.
  int require(const std::string& text);
  int execute(const std::string& code);
  /// Runs a script; an aib.protocol or aib.test that it returns is run with the arguments. "-" is
  /// standard input.
  int run_script(const std::filesystem::path& script, const std::vector<std::string>& arguments);

  /// What a protocol's script does, in a line; empty where it returns no protocol.
  std::string title_of(const std::filesystem::path& script);
  /// No progress.
  void silence();
  /// Scripts in bytecode are refused from now on.
  void refuse_bytecode() { text_only_ = true; }

  /// Calls a loaded chunk, the function; prints the error where there is one. `results` are those
  /// of the call.
  struct outcome {
    int code = exit_ok;
    std::vector<sol::object> results = {};
  };
  outcome call(const sol::load_result& chunk, const std::vector<std::string>& arguments = {});

  void set_global(const char* name, const sol::object& value);

  sol::state_view view() { return lua_; }
  lua_State* state() { return lua_.lua_state(); }
  bind::session& session() { return session_; }

 private:
  outcome call(const sol::protected_function& function, const std::vector<sol::object>& arguments);
  outcome load_and_run(const std::filesystem::path& script,
                       const std::vector<std::string>& arguments);

  bool text_only_ = false;
  bool warnings_shown_ = false;
  std::size_t memory_left_;
  bind::session session_;  // outlives the objects that the state collects at its end
  sol::state lua_;
};

/// Prints "aib-lua: text" to standard error.
void print_error(std::string_view text);

}  // namespace aib::shell
