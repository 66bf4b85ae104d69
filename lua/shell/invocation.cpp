// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include "invocation.hpp"

#include "../bind/kit/suggest.hpp"
#include <algorithm>
#include <charconv>
#include <cstdint>
#include <utility>

namespace aib::shell {

namespace {

/// Reads the words one after another.
class reader {
 public:
  explicit reader(const std::vector<std::string>& words) : out_{.words = words} {}

  invocation read() && {
    for (at_ = 1; at_ < out_.words.size() && is_option(out_.words[at_]); ++at_) {
      const std::string& word = out_.words[at_];
      if (word == "--") {
        ++at_;
        break;
      }
      word.starts_with("--") ? long_option(word.substr(2)) : short_option(word);
    }
    out_.script_at = at_;
    check_sandbox();
    return std::move(out_);
  }

 private:
  static bool is_option(const std::string& word) { return word.size() > 1 && word[0] == '-'; }

  void short_option(const std::string& word) {
    using enum invocation::step::kind;
    if (word[1] == 'e' || word[1] == 'l') {
      const std::string text = word.size() > 2 ? word.substr(2) : next(word);
      out_.steps.push_back({word[1] == 'e' ? execute : require, text});
    } else if (word == "-W") {
      out_.steps.push_back({warnings});
    } else if (word == "-i") {
      out_.interactive = true;
    } else if (word == "-v") {
      out_.version = true;
    } else if (word == "-E") {
      out_.ignore_environment = true;
    } else if (word == "-h") {
      out_.help = true;
    } else {
      throw usage_error("unknown option '" + word + "'");
    }
  }

  void long_option(const std::string& word) {
    const std::size_t equals = word.find('=');
    const std::string name = word.substr(0, equals);
    if (set_flag(word)) return;
    if (std::ranges::find(options_with_value, name) == std::ranges::end(options_with_value))
      throw usage_error(message("unknown option '--", name, "'", near("--" + name)));
    set_value(name, equals == word.npos ? next("--" + name) : word.substr(equals + 1));
  }

  static constexpr std::string_view options_with_value[] = {"instructions", "memory",  "read",
                                                            "seconds",      "threads", "write"};

  std::vector<std::pair<const char*, bool*>> flags() {
    return {{"help", &out_.help},
            {"list", &out_.list},
            {"quiet", &out_.quiet},
            {"sandbox", &sandboxed_},
            {"version", &out_.version}};
  }

  bool set_flag(const std::string& word) {
    for (const auto& [flag, value] : flags())
      if (word == flag) return *value = true;
    return false;
  }

  void set_value(const std::string& name, const std::string& text) {
    if (name == "threads") {
      out_.threads = static_cast<unsigned>(number(name, "a number of threads", text, 1u << 16));
    } else {
      limits_given_ = "--" + name;
      set_limit(name, text);
    }
  }

  void set_limit(const std::string& name, const std::string& text) {
    constexpr std::uint64_t most = std::uint64_t{1} << 62;
    if (name == "read") limits_.readable.emplace_back(text);
    if (name == "write") limits_.writable.emplace_back(text);
    if (name == "memory") limits_.memory = number(name, "a number of MB", text, 1u << 30) << 20;
    if (name == "instructions")
      limits_.instructions = number(name, "a number of instructions", text, most);
    if (name == "seconds")
      limits_.seconds = static_cast<unsigned>(number(name, "a number of seconds", text, 1u << 30));
  }

  std::string near(const std::string& name) {
    std::vector<std::string> known;
    for (const auto& [flag, value] : flags()) known.push_back(std::string("--") + flag);
    for (const std::string_view option : options_with_value)
      known.push_back("--" + std::string(option));
    return bind::suggestion(name, known);
  }

  std::string next(const std::string& option) {
    if (++at_ == out_.words.size()) throw usage_error(option + ": a value expected, found nothing");
    return out_.words[at_];
  }

  static std::uint64_t number(const std::string& option,
                              const char* what,
                              const std::string& text,
                              std::uint64_t most) {
    std::uint64_t n = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), n);
    if (error != std::errc() || end != text.data() + text.size() || n > most)
      throw usage_error(message("--", option, ": ", what, " expected, found '", text, "'"));
    return n;
  }

  /// The limits are nothing without the sandbox, and the sandbox nothing without a script.
  void check_sandbox() {
    if (!sandboxed_ && !limits_given_.empty())
      throw usage_error(limits_given_ + " is for --sandbox, which is not given");
    if (!sandboxed_) return;
    if (!out_.script() || !out_.steps.empty() || out_.interactive)
      throw usage_error("--sandbox: a script expected, without -e, -l, -W and -i");
    out_.sandbox = std::move(limits_);
  }

  invocation out_;
  std::size_t at_ = 0;
  bool sandboxed_ = false;
  sandbox_options limits_;
  std::string limits_given_;
};

}  // namespace

std::optional<std::string> invocation::script() const {
  if (script_at >= words.size()) return std::nullopt;
  return words[script_at];
}

std::vector<std::string> invocation::arguments() const {
  if (script_at >= words.size()) return {};
  return {words.begin() + static_cast<std::ptrdiff_t>(script_at) + 1, words.end()};
}

invocation parse(const std::vector<std::string>& words) { return reader(words).read(); }

std::string_view usage() {
  return R"(usage: aib-lua [options] [script | protocol | -] [arguments]

Runs a Lua script with the module `aib`, a protocol by its name, or an interactive prompt.

  -e CODE        run CODE
  -l MODULE      require MODULE (as a global of that name; -l NAME=MODULE as NAME)
  -i             go interactive after the script
  -v, --version  print the version
  -E             ignore environment variables
  -W             turn warnings on
  -              run standard input
  --             end of options
  --list         list the protocols that are found by name
  --threads N    threads of the library (0, the default: all)
  --quiet        no progress
  -h, --help     print this

For scripts that one did not write (Linux 5.13 or later):
  --sandbox      run the script where the kernel refuses other files, and programs
  --read DIR     it may read below DIR (the script's own folder: always)
  --write DIR    it may read and write below DIR
  --memory MB    of Lua values (2048)
  --seconds N    of processor time (3600)
  --instructions N  of the Lua machine (no limit)

Protocols are found in the working folder, the folders of AIB_PATH (separated by colons), and the
installed ones. `aib-lua PROTOCOL --help` tells its inputs.

exit status: 0 ok, 1 script or internal error, or a file cannot be written, 2 usage,
3 an input file is bad, 130 interrupted
)";
}

}  // namespace aib::shell
