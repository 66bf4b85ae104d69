// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace aib::shell {

/// Lines that a person types: with editing, history and the Tab key where standard input is a
/// terminal and libedit was there at build time, plain otherwise. One at a time.
class line_editor {
 public:
  /// What may replace the last word of a text.
  using completer = std::function<std::vector<std::string>(const std::string& before)>;

  /// history  file of the lines of earlier sessions; none where the path is empty
  line_editor(completer complete, std::filesystem::path history);
  ~line_editor();
  line_editor(const line_editor&) = delete;
  line_editor& operator=(const line_editor&) = delete;

  /// A line without its end; nothing at the end of input. Ctrl-C gives up what was typed:
  /// `interrupted` tells.
  std::optional<std::string> read(const std::string& prompt);
  [[nodiscard]] bool interrupted() const { return interrupted_; }
  void remember(const std::string& line);

 private:
  std::filesystem::path history_;
  bool interactive_;
  bool interrupted_ = false;
};

}  // namespace aib::shell
