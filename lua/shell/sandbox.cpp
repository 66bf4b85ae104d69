// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include "sandbox.hpp"

#include "../bind/kit.hpp"
#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <initializer_list>
#include <linux/landlock.h>
#include <string>
#include <string_view>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace aib::shell {

namespace {

// The process ------------------------------------------------------------------------------------

constexpr std::uint64_t read_rights = LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_READ_DIR;
constexpr std::uint64_t file_rights =
    LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_WRITE_FILE | LANDLOCK_ACCESS_FS_EXECUTE;
constexpr std::uint64_t write_rights = read_rights | LANDLOCK_ACCESS_FS_WRITE_FILE |
                                       LANDLOCK_ACCESS_FS_REMOVE_FILE |
                                       LANDLOCK_ACCESS_FS_MAKE_REG | LANDLOCK_ACCESS_FS_MAKE_DIR;
constexpr std::uint64_t all_rights = write_rights | LANDLOCK_ACCESS_FS_EXECUTE |
                                     LANDLOCK_ACCESS_FS_REMOVE_DIR | LANDLOCK_ACCESS_FS_MAKE_CHAR |
                                     LANDLOCK_ACCESS_FS_MAKE_SOCK | LANDLOCK_ACCESS_FS_MAKE_FIFO |
                                     LANDLOCK_ACCESS_FS_MAKE_BLOCK | LANDLOCK_ACCESS_FS_MAKE_SYM;

/// A file descriptor that is closed at the end.
struct descriptor {
  int number;
  explicit descriptor(long n) : number(static_cast<int>(n)) {}
  ~descriptor() {
    if (number >= 0) close(number);
  }
  descriptor(const descriptor&) = delete;
  descriptor& operator=(const descriptor&) = delete;
};

/// A rule set of the kernel's Landlock: what it does not allow is refused.
class landlock {
 public:
  landlock() : set_(create()) {
    if (set_.number < 0) {
      throw error(message("--sandbox: this kernel has no Landlock (Linux 5.13 or later expected): ",
                          std::strerror(errno)));
    }
  }

  void allow(const std::filesystem::path& root, std::uint64_t rights) {
    const descriptor at(open(root.c_str(), O_PATH | O_CLOEXEC));
    if (at.number < 0) throw io_error(root, message("cannot open: ", std::strerror(errno)));
    if (!std::filesystem::is_directory(root)) rights &= file_rights;
    const landlock_path_beneath_attr rule = {.allowed_access = rights, .parent_fd = at.number};
    if (syscall(SYS_landlock_add_rule, set_.number, LANDLOCK_RULE_PATH_BENEATH, &rule, 0) != 0)
      throw io_error(root, message("--sandbox: ", std::strerror(errno)));
  }

  void enforce() const {
    if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 ||
        syscall(SYS_landlock_restrict_self, set_.number, 0) != 0)
      throw error(message("--sandbox: ", std::strerror(errno)));
  }

 private:
  static std::uint64_t known_rights() {
    const long version =
        syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION);
    constexpr std::uint64_t truncate = 1u << 14;  // of version 3, newer than some headers
    return version >= 3 ? all_rights | truncate : all_rights;
  }

  static long create() {
    const landlock_ruleset_attr attributes = {.handled_access_fs = known_rights()};
    return syscall(SYS_landlock_create_ruleset, &attributes, sizeof attributes, 0);
  }

  descriptor set_;
};

void limit(int resource, rlim_t amount) {
  const rlimit both = {amount, amount};
  if (setrlimit(static_cast<__rlimit_resource>(resource), &both) != 0)
    throw error(message("--sandbox: cannot set a limit: ", std::strerror(errno)));
}

/// Ends the process at once; files are written in one step, so that none is left half-written.
[[noreturn]] void give_up(std::string_view why) {
  constexpr std::string_view name = "aib-lua: sandbox: ";
  for (const std::string_view part : {name, why, std::string_view("\n")})
    if (write(STDERR_FILENO, part.data(), part.size()) < 0) break;
  _exit(1);
}

void out_of_time(int) { give_up("the processor time is used up"); }

// Lua --------------------------------------------------------------------------------------------

constexpr int instructions_at_once = 1000;
std::uint64_t instructions_left = 0;

void count_instructions(lua_State*, lua_Debug*) {
  if (instructions_left <= instructions_at_once) give_up("the budget of instructions is used up");
  instructions_left -= instructions_at_once;
}

/// Calls the first upvalue with the arguments on the stack.
int call_original(lua_State* state) {
  lua_pushvalue(state, lua_upvalueindex(1));
  lua_insert(state, 1);
  lua_call(state, lua_gettop(state) - 1, LUA_MULTRET);
  return lua_gettop(state);
}

/// load, with text alone. Upvalue: the original.
int load_text(lua_State* state) {
  lua_settop(state, std::max(lua_gettop(state), 3));
  lua_pushliteral(state, "t");
  lua_replace(state, 3);
  return call_original(state);
}

/// loadfile, with text alone. Upvalue: the original.
int load_text_file(lua_State* state) {
  lua_settop(state, std::max(lua_gettop(state), 2));
  lua_pushliteral(state, "t");
  lua_replace(state, 2);
  return call_original(state);
}

/// dofile, with text alone. Upvalue: loadfile.
int do_text_file(lua_State* state) {
  luaL_checkstring(state, 1);
  lua_settop(state, 1);
  lua_pushvalue(state, lua_upvalueindex(1));
  lua_insert(state, 1);
  lua_pushliteral(state, "t");
  lua_call(state, 2, 2);
  if (lua_isnil(state, 1)) {
    lua_settop(state, 2);
    return lua_error(state);
  }
  lua_settop(state, 1);
  lua_call(state, 0, LUA_MULTRET);
  return lua_gettop(state);
}

/// setmetatable without finalizers: they run where no hook counts. Upvalue: the original.
int set_metatable(lua_State* state) {
  if (lua_istable(state, 2)) {
    lua_pushliteral(state, "__gc");
    lua_rawget(state, 2);
    if (!lua_isnil(state, -1))
      return luaL_error(state, "sandbox: a metatable without __gc expected");
    lua_pop(state, 1);
  }
  return call_original(state);
}

/// collectgarbage that can neither stop nor tune the collector. Upvalue: the original.
int collect(lua_State* state) {
  const std::string_view what = luaL_optstring(state, 1, "collect");
  if (what != "collect" && what != "count")
    return luaL_error(state, "sandbox: collectgarbage 'collect' or 'count' expected");
  return call_original(state);
}

/// What concerns the terminal alone. Upvalue: the original.
int get_environment(lua_State* state) {
  const std::string_view name = luaL_checkstring(state, 1);
  const bool harmless = name == "COLUMNS" || name == "NO_COLOR" || name == "TERM" || name == "LANG";
  if (!harmless) return 0;
  lua_pushstring(state, std::getenv(name.data()));
  return 1;
}

/// debug, for messages alone.
void keep_traceback(lua_State* state) {
  lua_getglobal(state, "debug");
  lua_createtable(state, 0, 1);
  lua_getfield(state, -2, "traceback");
  lua_setfield(state, -2, "traceback");
  lua_setglobal(state, "debug");
  lua_pop(state, 1);
}

/// Replaces table.name by a function that has the original as its upvalue.
void wrap(lua_State* state, const char* table, const char* name, lua_CFunction wrapper) {
  lua_getglobal(state, table);
  lua_getfield(state, -1, name);
  lua_pushcclosure(state, wrapper, 1);
  lua_setfield(state, -2, name);
  lua_pop(state, 1);
}

void remove(lua_State* state, const char* table, std::initializer_list<const char*> names) {
  lua_getglobal(state, table);
  for (const char* name : names) {
    lua_pushnil(state);
    lua_setfield(state, -2, name);
  }
  lua_pop(state, 1);
}

/// The methods of strings serve everybody; the script gets a copy of their table, and a metatable
/// that it cannot open.
void protect_strings(lua_State* state) {
  lua_getglobal(state, "string");
  lua_newtable(state);
  lua_pushnil(state);
  while (lua_next(state, -3)) {
    lua_pushvalue(state, -2);
    lua_insert(state, -2);
    lua_rawset(state, -4);
  }
  lua_pushvalue(state, -1);
  lua_setglobal(state, "string");
  luaL_getsubtable(state, LUA_REGISTRYINDEX, LUA_LOADED_TABLE);
  lua_insert(state, -2);
  lua_setfield(state, -2, "string");
  lua_pop(state, 2);
  lua_pushliteral(state, "");
  lua_getmetatable(state, -1);
  lua_pushliteral(state, "string");
  lua_setfield(state, -2, "__metatable");
  lua_pop(state, 2);
}

/// `require` finds text files and the modules in the binary, no native ones.
void remove_native_modules(lua_State* state) {
  remove(state, "package", {"loadlib", "searchpath"});
  lua_getglobal(state, "package");
  lua_pushliteral(state, "");
  lua_setfield(state, -2, "cpath");
  lua_getfield(state, -1, "searchers");
  for (auto i = static_cast<lua_Integer>(lua_rawlen(state, -1)); i > 3; --i) {
    lua_pushnil(state);
    lua_rawseti(state, -2, i);
  }
  lua_pop(state, 1);
  lua_getfield(state, -1, "loaded");
  lua_pushnil(state);
  lua_setfield(state, -2, "debug");
  lua_pop(state, 2);
}

}  // namespace

void confine_process(const sandbox_options& options) {
  landlock rules;
  for (const auto& root : options.readable) rules.allow(root, read_rights);
  for (const auto& root : options.writable) rules.allow(root, write_rights);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_AS, 4 * options.memory + (rlim_t{4} << 30));  // clouds, images, stacks of threads
  std::signal(SIGXCPU, out_of_time);
  const rlimit time = {options.seconds, options.seconds + 5};
  if (setrlimit(RLIMIT_CPU, &time) != 0)
    throw error(message("--sandbox: cannot set a limit: ", std::strerror(errno)));
  rules.enforce();
}

void confine_lua(lua_State* state, const sandbox_options& options) {
  wrap(state, "_G", "load", load_text);
  lua_getglobal(state, "loadfile");
  lua_pushcclosure(state, do_text_file, 1);
  lua_setglobal(state, "dofile");
  wrap(state, "_G", "loadfile", load_text_file);
  wrap(state, "_G", "setmetatable", set_metatable);
  wrap(state, "_G", "collectgarbage", collect);
  wrap(state, "os", "getenv", get_environment);
  remove(state, "os", {"execute", "remove", "rename", "setlocale", "tmpname"});
  remove(state, "io", {"popen", "tmpfile"});
  remove(state, "string", {"dump"});
  keep_traceback(state);
  remove_native_modules(state);
  protect_strings(state);
  if (options.instructions == 0) return;
  instructions_left = options.instructions;
  lua_sethook(state, count_instructions, LUA_MASKCOUNT, instructions_at_once);
}

}  // namespace aib::shell
