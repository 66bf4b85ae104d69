// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include "interpreter.hpp"

#include "../bind/aib.hpp"
#include "../bind/kit.hpp"
#include "embedded.hpp"
#include "globals.hpp"
#include "interrupt.hpp"
#include <cstdio>
#include <cstdlib>
#include <unistd.h>
#include <utility>

namespace aib::shell {

namespace {

using bind::error_kind;

/// Error handler: mistakes of a script get a trace; a bad file, one that cannot be written and a
/// lack of memory are said in their sentence alone.
int explain(lua_State* state) {
  if (lua_type(state, 1) != LUA_TSTRING) {
    luaL_tolstring(state, 1, nullptr);
    return 1;
  }
  const std::string text = bind::value<std::string>::get(state, 1);
  const error_kind kind = bind::session::of(state).kind_of(text);
  using enum error_kind;
  if (kind == io || kind == output || kind == format || kind == stopped) return 1;
  if (text.ends_with("not enough memory")) return 1;
  luaL_traceback(state, state, lua_tostring(state, 1), 1);
  return 1;
}

int exit_code_of(error_kind kind) {
  switch (kind) {
    case error_kind::io:
    case error_kind::format:
      return exit_input;
    case error_kind::stopped:
      return exit_interrupted;
    default:
      return exit_script;
  }
}

/// "aib.protocol" and "aib.test" are programs: they have a method main(arguments) -> exit code.
bool is_program(const sol::object& value) {
  lua_State* state = value.lua_state();
  const auto popper = sol::stack::push_pop(value);
  if (luaL_getmetafield(state, -1, "__name") != LUA_TSTRING) return false;
  const std::string name = bind::value<std::string>::get(state, -1);
  lua_pop(state, 1);
  return name == "aib.protocol" || name == "aib.test";
}

/// Lua's allocator. `left` is how many bytes there are still to give.
void* allocate(void* left, void* block, std::size_t before, std::size_t after) {
  auto& bytes = *static_cast<std::size_t*>(left);
  if (!block) before = 0;  // then it is a type
  if (after == 0) {
    std::free(block);
    bytes += before;
    return nullptr;
  }
  if (after > before && after - before > bytes) return nullptr;
  void* moved = std::realloc(block, after);
  if (moved) bytes = bytes + before - after;
  return moved;
}

/// warn(), off until "@on", as in lua. `on` is a bool.
void warn(void* on, const char* text, int to_be_continued) {
  static bool begun = false;
  bool& shown = *static_cast<bool*>(on);
  const std::string_view control = begun || to_be_continued ? "" : text;
  if (control == "@on" || control == "@off") {
    shown = control == "@on";
  } else if (shown) {
    std::fprintf(stderr, "%s%s%s", begun ? "" : "Lua warning: ", text, to_be_continued ? "" : "\n");
  }
  begun = to_be_continued != 0;
}

}  // namespace

void print_error(std::string_view text) {
  std::fflush(stdout);
  const std::string line = message("aib-lua: ", text, "\n");
  std::fwrite(line.data(), 1, line.size(), stderr);
}

interpreter::interpreter(bool ignore_environment, std::size_t memory)
    : memory_left_(memory), lua_(sol::default_at_panic, allocate, &memory_left_) {
  lua_setwarnf(state(), warn, &warnings_shown_);
  session_.attach(state());
  if (isatty(STDERR_FILENO)) session_.control.progress = bind::meter();
  if (ignore_environment) lua_.registry()["LUA_NOENV"] = true;
  lua_.open_libraries();
  bind::bind_all(state());
  serve_embedded_modules(state());
  keep_results_plain(state());
  make_globals_strict(state());
}

void interpreter::set_arguments(const invocation& call) {
  const auto script =
      static_cast<std::ptrdiff_t>(call.script_at < call.words.size() ? call.script_at : 0);
  sol::table arg = lua_.create_table();
  for (std::size_t i = 0; i < call.words.size(); ++i)
    arg[static_cast<std::ptrdiff_t>(i) - script] = call.words[i];
  lua_["arg"] = arg;
}

void interpreter::preload() { set_global("aib", bind::module(state(), "").table()); }

void interpreter::set_global(const char* name, const sol::object& value) {
  bind::push(state(), value);
  lua_setglobal(state(), name);
}

int interpreter::require(const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::string name = text.substr(0, equals);
  const std::string module = equals == text.npos ? text : text.substr(equals + 1);
  const auto function = lua_.get<sol::protected_function>("require");
  outcome o = call(function, {sol::make_object(state(), module)});
  if (o.code == exit_ok && !o.results.empty()) lua_[name] = o.results.front();
  return o.code;
}

int interpreter::execute(const std::string& code) {
  preload();
  return call(lua_.load(code, "=(command line)")).code;
}

int interpreter::run_script(const std::filesystem::path& script,
                            const std::vector<std::string>& arguments) {
  const outcome o = load_and_run(script, arguments);
  if (o.code != exit_ok || o.results.empty() || !is_program(o.results.front())) return o.code;
  const sol::table program = o.results.front();
  bind::push(state(), arguments);
  const sol::object list(state(), -1);
  lua_pop(state(), 1);
  const outcome done = call(program.get<sol::protected_function>("main"), {program, list});
  if (done.code != exit_ok || done.results.empty()) return done.code;
  return done.results.front().as<int>();
}

std::string interpreter::title_of(const std::filesystem::path& script) {
  const outcome o = load_and_run(script, {});
  if (o.code != exit_ok || o.results.empty() || !is_program(o.results.front())) return "";
  return o.results.front().as<sol::table>().get_or<std::string>("title", "");
}

void interpreter::silence() {
  const auto require = lua_.get<sol::protected_function>("require");
  require("aib.progress").get<sol::table>().get<sol::protected_function>("silence")();
}

/// `require` finds modules beside the script.
interpreter::outcome interpreter::load_and_run(const std::filesystem::path& script,
                                               const std::vector<std::string>& arguments) {
  const bool from_input = script == "-";
  if (!from_input) {
    const std::string folder = script.has_parent_path() ? script.parent_path().string() : ".";
    const std::string before = lua_["package"]["path"];
    lua_["package"]["path"] = folder + "/?.lua;" + folder + "/?/init.lua;" + before;
  }
  const int status =
      luaL_loadfilex(state(), from_input ? nullptr : script.c_str(), text_only_ ? "t" : nullptr);
  const sol::load_result chunk(state(), lua_gettop(state()), 1, 1,
                               static_cast<sol::load_status>(status));
  return call(chunk, arguments);
}

interpreter::outcome interpreter::call(const sol::load_result& chunk,
                                       const std::vector<std::string>& arguments) {
  if (!chunk.valid()) {
    const sol::error e = chunk;
    print_error(e.what());
    return {exit_script, {}};
  }
  std::vector<sol::object> objects;
  for (const std::string& a : arguments) objects.push_back(sol::make_object(state(), a));
  return call(chunk.get<sol::protected_function>(), objects);
}

interpreter::outcome interpreter::call(const sol::protected_function& function,
                                       const std::vector<sol::object>& arguments) {
  const interruptible scope(state());
  sol::protected_function guarded = function;
  lua_pushcfunction(state(), explain);
  guarded.set_error_handler(sol::function(state(), -1));
  lua_pop(state(), 1);
  const sol::protected_function_result result = guarded(sol::as_args(arguments));
  if (scope.interrupted()) return {exit_interrupted, {}};
  if (!result.valid()) {
    const std::string text = bind::value<std::string>::get(state(), result.stack_index());
    const int code = exit_code_of(session_.kind_of(text));
    print_error(text);
    return {code, {}};
  }
  return {exit_ok, {result.begin(), result.end()}};
}

}  // namespace aib::shell
