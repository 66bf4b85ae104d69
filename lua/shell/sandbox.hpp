// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

struct lua_State;

namespace aib::shell {

/// What a script that one did not write may do.
struct sandbox_options {
  std::vector<std::filesystem::path> readable = {};  ///< folders and files, with all below them
  std::vector<std::filesystem::path> writable = {};  ///< the same, also readable
  std::size_t memory = std::size_t{2} << 30;         ///< bytes of Lua values
  std::uint64_t instructions = 0;                    ///< of the Lua machine; 0: no limit
  unsigned seconds = 3600;                           ///< of processor time, over all threads
};

/// Confines the process for the rest of its life. The kernel refuses files outside of the given
/// roots whatever path leads there (Landlock), programs cannot be started, and memory and processor
/// time are limited. Not confined: what the script learns from timing, and the load that it puts on
/// the machine within its limits.
/// Throws error where the kernel has no Landlock (Linux 5.13), io_error where a root is missing.
void confine_process(const sandbox_options& options);

/// Takes from a state what a confined script does not need: programs, the environment, native
/// modules, bytecode, finalizers, the debug library, the methods of strings. Counts instructions;
/// beyond the budget the process ends with exit code 1, which no pcall can hold.
void confine_lua(lua_State* state, const sandbox_options& options);

}  // namespace aib::shell
