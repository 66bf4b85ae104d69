// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/io/numbers.hpp>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace aib::io {

/// The text without blanks and line ends at both sides.
[[nodiscard]] inline std::string_view trim(std::string_view text) {
  constexpr std::string_view blank = " \t\r\n\v\f";
  const std::size_t first = text.find_first_not_of(blank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blank) - first + 1);
}

/// The text with small letters for the 26 capital ones, in every locale.
[[nodiscard]] inline std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return lower;
}

/// The fields of a line: parted by `separator`, or by runs of blanks where it is 0. Fields are
/// trimmed.
inline void split(std::string_view line,
                  std::vector<std::string_view>& fields,
                  char separator = 0) {
  fields.clear();
  if (separator == 0) {
    constexpr std::string_view blank = " \t\r\n\v\f";
    for (std::size_t at = line.find_first_not_of(blank); at != std::string_view::npos;) {
      const std::size_t end = std::min(line.find_first_of(blank, at), line.size());
      fields.push_back(line.substr(at, end - at));
      at = line.find_first_not_of(blank, end);
    }
    return;
  }
  for (;;) {
    const std::size_t end = line.find(separator);
    fields.push_back(trim(line.substr(0, end)));
    if (end == std::string_view::npos) return;
    line.remove_prefix(end + 1);
  }
}

/// The number that the whole text is, see take_number; nothing where it is not one.
template <class Number>
[[nodiscard]] std::optional<Number> parse(std::string_view text) {
  return take_number<Number>(text, "");
}

/// Walks the lines of a text: LF or CRLF, the last with or without an end; a byte order mark is
/// skipped.
class line_reader {
 public:
  line_reader(std::string_view text, std::filesystem::path path)
      : rest_(text), path_(std::move(path)) {
    if (rest_.starts_with("\xEF\xBB\xBF")) rest_.remove_prefix(3);
  }

  /// Moves to the next line; false after the last.
  bool next() {
    if (rest_.empty()) return false;
    const std::size_t end = rest_.find('\n');
    line_ = rest_.substr(0, end);
    if (line_.ends_with('\r')) line_.remove_suffix(1);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    ++number_;
    return true;
  }

  /// Moves to the next line that is neither blank nor a comment ('#').
  bool next_content() {
    while (next()) {
      const std::string_view content = trim(line_);
      if (!content.empty() && content.front() != '#') return true;
    }
    return false;
  }

  [[nodiscard]] std::string_view line() const { return line_; }
  [[nodiscard]] std::size_t number() const { return number_; }
  [[noreturn]] void fail(std::string_view what) const {
    throw format_error(path_, at_line{number_}, what);
  }

 private:
  std::string_view rest_;
  std::string_view line_;
  std::size_t number_ = 0;
  std::filesystem::path path_;
};

}  // namespace aib::io
