// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include "invocation.hpp"

#include "../bind/kit/suggest.hpp"
#include <charconv>
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
    if (name == "threads") {
      out_.threads =
          number(name, equals == word.npos ? next("--" + name) : word.substr(equals + 1));
      return;
    }
    const std::pair<const char*, bool*> flags[] = {{"help", &out_.help},
                                                   {"list", &out_.list},
                                                   {"quiet", &out_.quiet},
                                                   {"version", &out_.version}};
    std::vector<std::string> known = {"--threads"};
    for (const auto& [flag, value] : flags) {
      if (word == flag) {
        *value = true;
        return;
      }
      known.push_back(std::string("--") + flag);
    }
    throw usage_error(
        message("unknown option '--", word, "'", bind::suggestion("--" + name, known)));
  }

  std::string next(const std::string& option) {
    if (++at_ == out_.words.size()) throw usage_error(option + ": a value expected, found nothing");
    return out_.words[at_];
  }

  static unsigned number(const std::string& option, const std::string& text) {
    unsigned n = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), n);
    if (error != std::errc() || end != text.data() + text.size())
      throw usage_error(
          message("--", option, ": a number of threads expected, found '", text, "'"));
    return n;
  }

  invocation out_;
  std::size_t at_ = 0;
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

Protocols are found in the working folder, the folders of AIB_PATH (separated by colons), and the
installed ones. `aib-lua PROTOCOL --help` tells its inputs.

exit status: 0 ok, 1 script or internal error, 2 usage, 3 an input file is bad, 130 interrupted
)";
}

}  // namespace aib::shell
