// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>

#include "sandbox.hpp"
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace aib::shell {

/// A command line that is not understood.
class usage_error : public error {
 public:
  using error::error;
};

/// What a command line asks for. The flags of `lua`, and ours with two dashes.
struct invocation {
  /// -e, -l and -W act in the order in which they are given.
  struct step {
    enum class kind { execute, require, warnings } what;
    std::string text = {};
  };

  std::vector<std::string> words;  ///< the whole command line, the program first
  std::size_t script_at = 0;       ///< index in `words` of the script; words.size(): none
  std::vector<step> steps = {};
  bool interactive = false;
  bool version = false;
  bool ignore_environment = false;
  bool help = false;
  bool list = false;
  bool quiet = false;
  unsigned threads = 0;
  std::optional<sandbox_options> sandbox = {};

  /// The script: a path, a protocol's name, or "-" for standard input.
  [[nodiscard]] std::optional<std::string> script() const;
  /// What follows the script.
  [[nodiscard]] std::vector<std::string> arguments() const;
};

/// Throws usage_error.
invocation parse(const std::vector<std::string>& words);

/// The text of --help.
std::string_view usage();

}  // namespace aib::shell
