// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include "line_editor.hpp"

#include <csetjmp>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <memory>
#include <system_error>
#include <unistd.h>
#include <utility>

#if defined(AIB_WITH_LIBEDIT)
#include <editline/readline.h>
#endif

namespace aib::shell {

namespace {

std::optional<std::string> read_plain(const std::string& prompt) {
  std::cout << prompt << std::flush;
  std::string line;
  if (!std::getline(std::cin, line)) return std::nullopt;
  return line;
}

#if defined(AIB_WITH_LIBEDIT)

line_editor::completer complete;
sigjmp_buf before_line;

struct freed {
  void operator()(char* text) const { std::free(text); }
};

char** offer(const char* word, int, int end) {
  rl_attempted_completion_over = 1;  // never names of files
  static std::vector<std::string> offers;
  offers = complete(std::string(rl_line_buffer, static_cast<std::size_t>(end)));
  // The library calls for one offer after the other until it is given none.
  return rl_completion_matches(word, [](const char*, int state) -> char* {
    const auto i = static_cast<std::size_t>(state);
    return i < offers.size() ? strdup(offers[i].c_str()) : nullptr;
  });
}

void begin_editing(const std::filesystem::path& history) {
  static char word_ends[] = " \t\n\"'`@$><=;,|&{}()[]+-*/%^#~";
  rl_readline_name = "aib-lua";
  rl_completer_word_break_characters = word_ends;
  rl_attempted_completion_function = offer;
  rl_completion_append_character = '\0';
  using_history();
  if (!history.empty()) read_history(history.c_str());
}

/// Nothing of C++ lives in the frames that the jump leaves.
std::optional<std::string> read_edited(const std::string& prompt, bool& interrupted) {
  const auto handler = std::signal(SIGINT, [](int) { siglongjmp(before_line, 1); });
  char* text = nullptr;
  interrupted = sigsetjmp(before_line, 1) != 0;
  if (!interrupted) text = readline(prompt.c_str());
  std::signal(SIGINT, handler);
  if (interrupted) {
    rl_deprep_terminal();
    std::cout << "^C" << std::endl;
    return "";
  }
  const std::unique_ptr<char, freed> line(text);
  if (!line) return std::nullopt;
  return line.get();
}

#endif

}  // namespace

#if defined(AIB_WITH_LIBEDIT)

line_editor::line_editor(completer c, std::filesystem::path history)
    : history_(std::move(history)), interactive_(isatty(STDIN_FILENO) == 1) {
  complete = std::move(c);
  if (interactive_) begin_editing(history_);
}

line_editor::~line_editor() {
  if (!interactive_ || history_.empty()) return;
  std::error_code ignored;
  std::filesystem::create_directories(history_.parent_path(), ignored);
  stifle_history(1000);
  write_history(history_.c_str());
}

std::optional<std::string> line_editor::read(const std::string& prompt) {
  interrupted_ = false;
  return interactive_ ? read_edited(prompt, interrupted_) : read_plain(prompt);
}

void line_editor::remember(const std::string& line) {
  if (interactive_ && !line.empty()) add_history(line.c_str());
}

#else

line_editor::line_editor(completer, std::filesystem::path history)
    : history_(std::move(history)), interactive_(false) {}
line_editor::~line_editor() = default;
std::optional<std::string> line_editor::read(const std::string& prompt) {
  return read_plain(prompt);
}
void line_editor::remember(const std::string&) {}

#endif

}  // namespace aib::shell
