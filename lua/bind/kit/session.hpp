// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/core/executor.hpp>

#include "sol.hpp"
#include <array>
#include <cstddef>
#include <deque>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

namespace aib::bind {

/// Name and arguments of a bound function, as they stand in messages.
struct signature {
  std::string name;
  std::vector<std::string> arguments;
  bool variadic = false;  ///< surplus arguments are ignored, as Lua passes them to metamethods
};

/// What an error was, beside its message. Scripts ask for it with `aib.error_kind(message)`.
enum class error_kind { script, argument, format, io, output, undefined, stopped, internal };

/// "argument", "format", "io", "output", "undefined", "stopped", "internal"; "script" for errors of
/// Lua code.
const char* name_of(error_kind kind);

/// State of one shell: what all calls share. One for a Lua state; lives longer than it.
class session {
 public:
  session() { restart(); }
  session(const session&) = delete;
  session& operator=(const session&) = delete;

  /// Makes this the session of the state, before anything is bound.
  void attach(lua_State* state);
  static session& of(lua_State* state);

  /// After Ctrl-C: what comes next may run.
  void restart();

  unsigned threads = 0;   ///< for the library's options.threads; 0: all
  std::stop_source stop;  ///< requested by Ctrl-C
  aib::control control;   ///< for the library's option of that name; carries the stop token

  const signature& keep(signature s) { return signatures_.emplace_back(std::move(s)); }
  const std::deque<signature>& signatures() const { return signatures_; }

  /// Remembers of which kind the latest messages were.
  void remember(error_kind kind, std::string message);
  /// Kind of the latest message that `text` contains; script where there is none.
  error_kind kind_of(std::string_view text) const;

  /// Tells the collector that values hold `bytes` more outside of Lua. May collect.
  void grew(lua_State* state, std::size_t bytes);
  void shrank(std::size_t bytes) { held_ -= bytes; }
  std::size_t held() const { return held_; }

 private:
  struct remembered {
    error_kind kind = error_kind::script;
    std::string message;
  };
  std::deque<signature> signatures_;
  std::array<remembered, 64> errors_;
  std::size_t next_error_ = 0;
  std::size_t held_ = 0;
  std::size_t collect_at_ = std::size_t{256} << 20;
};

}  // namespace aib::bind
