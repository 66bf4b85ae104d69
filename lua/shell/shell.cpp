// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include "shell.hpp"

#include <aib/core/isa.hpp>

#include "../bind/kit/suggest.hpp"
#include "interpreter.hpp"
#include "invocation.hpp"
#include "protocols.hpp"
#include "repl.hpp"
#include "sandbox.hpp"
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <unistd.h>

namespace aib::shell {

namespace {

namespace fs = std::filesystem;

void print(std::string_view text) { std::fwrite(text.data(), 1, text.size(), stdout); }

std::string version() {
  return message("aib ", AIB_VERSION, " (", instruction_set, ")  ", LUA_RELEASE, "\n");
}

/// A script's path, or that of the protocol of this name.
fs::path resolve(const std::string& script, bool ignore_environment) {
  std::error_code ignored;
  if (script == "-" || fs::is_regular_file(script, ignored)) return script;
  std::vector<fs::path> folders = protocol_folders(ignore_environment);
  if (const auto found = find_protocol(script, folders)) return *found;
  folders.erase(folders.begin());  // the working folder's scripts need not be protocols
  throw usage_error(message("no script or protocol '", script, "'",
                            bind::suggestion(script, protocol_names(folders))));
}

/// Runs a script that somebody else wrote.
int run_confined(const invocation& call) {
  const fs::path script = resolve(*call.script(), call.ignore_environment);
  sandbox_options limits = *call.sandbox;
  if (script != "-")
    limits.readable.push_back(script.has_parent_path() ? script.parent_path() : ".");
  interpreter lua(true, limits.memory);
  lua.session().threads = call.threads;
  if (call.quiet) lua.silence();
  lua.set_arguments(call);
  lua.refuse_bytecode();
  confine_lua(lua.state(), limits);
  confine_process(limits);
  return lua.run_script(script, call.arguments());
}

int run_steps(interpreter& lua, const std::vector<invocation::step>& steps) {
  using enum invocation::step::kind;
  for (const invocation::step& step : steps) {
    int code = exit_ok;
    if (step.what == warnings) lua_warning(lua.state(), "@on", 0);
    if (step.what == require) code = lua.require(step.text);
    if (step.what == execute) code = lua.execute(step.text);
    if (code != exit_ok) return code;
  }
  return exit_ok;
}

/// The protocols with their titles. Those of the working folder are not asked: it may hold any
/// script.
int list(const invocation& call) {
  std::vector<fs::path> folders = protocol_folders(call.ignore_environment);
  folders.erase(folders.begin());
  for (const std::string& name : protocol_names(folders)) {
    interpreter lua(call.ignore_environment);
    const std::string title = lua.title_of(*find_protocol(name, folders));
    if (!title.empty())
      print(message(name, std::string(name.size() < 24 ? 24 - name.size() : 1, ' '), "  ", title,
                    "\n"));
  }
  return exit_ok;
}

int run(const invocation& call) {
  if (call.help) return print(usage()), exit_ok;
  if (call.list) return list(call);
  if (call.version) print(version());
  const bool nothing_to_do = !call.script() && call.steps.empty();
  if (call.version && nothing_to_do && !call.interactive) return exit_ok;

  if (call.sandbox) return run_confined(call);
  interpreter lua(call.ignore_environment);
  lua.session().threads = call.threads;
  if (call.quiet) lua.silence();
  lua.set_arguments(call);
  if (const int code = run_steps(lua, call.steps)) return code;
  if (call.script()) {
    const int code =
        lua.run_script(resolve(*call.script(), call.ignore_environment), call.arguments());
    return call.interactive ? converse(lua) : code;
  }
  if (call.interactive) return converse(lua);
  if (!nothing_to_do) return exit_ok;
  if (!isatty(STDIN_FILENO)) return lua.run_script("-", {});
  print(version());
  return converse(lua);
}

/// What was printed is there, or the run has failed.
int checked_output(int code) {
  if (std::fflush(stdout) == 0 && !std::ferror(stdout)) return code;
  std::fprintf(stderr, "aib-lua: standard output: cannot write: %s\n", std::strerror(errno));
  return code == exit_ok ? exit_script : code;
}

}  // namespace

int run(const std::vector<std::string>& words) {
  std::signal(SIGXFSZ, SIG_IGN);  // then a write fails, which is told
  try {
    return checked_output(run(parse(words)));
  } catch (const usage_error& e) {
    print_error(message(e.what(), "\ntry aib-lua --help"));
    return exit_usage;
  } catch (const std::exception& e) {
    print_error(e.what());
    return exit_script;
  }
}

}  // namespace aib::shell
