// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/io/text.hpp>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace aib::io {

/// Fields of a line parted by blanks, by commas, or by both; a comma at the end is allowed. A field
/// between two commas is empty.
inline void split_loosely(std::string_view line, std::vector<std::string_view>& fields) {
  constexpr std::string_view blank = " \t\r\v\f";
  fields.clear();
  for (;;) {
    line.remove_prefix(std::min(line.find_first_not_of(blank), line.size()));
    if (line.empty()) return;
    const std::size_t end = std::min(line.find_first_of(" \t\r\v\f,"), line.size());
    fields.push_back(line.substr(0, end));
    line.remove_prefix(end);
    line.remove_prefix(std::min(line.find_first_not_of(blank), line.size()));
    if (line.starts_with(',')) line.remove_prefix(1);
  }
}

/// Walks the lines of a text that are rows of numbers, parted by blanks or commas. Blank lines and
/// comments ('#') are skipped; every error names the file, the line and the format.
class number_lines {
 public:
  number_lines(std::string_view text, const std::filesystem::path& path, std::string_view format)
      : lines_(text, path), format_(format) {}

  /// Moves to the next row; false after the last. Throws format_error where a field is no number.
  bool next() {
    if (!lines_.next_content()) return false;
    split_loosely(lines_.line(), fields_);
    numbers_.clear();
    for (const std::string_view field : fields_) {
      const auto number = parse<double>(field);
      if (!number) fail(message("a number expected, found '", field, "'"));
      numbers_.push_back(*number);
    }
    return true;
  }

  [[nodiscard]] const std::vector<double>& numbers() const { return numbers_; }
  [[nodiscard]] const std::vector<std::string_view>& fields() const { return fields_; }
  [[nodiscard]] std::size_t line() const { return lines_.number(); }

  /// Refuses a row that has not `n` numbers; `what` names them.
  void expect(std::size_t n, std::string_view what) const {
    if (numbers_.size() == n) return;
    fail(message(n, " numbers (", what, ") expected, found ", numbers_.size()));
  }

  [[noreturn]] void fail(std::string_view what) const { lines_.fail(message(format_, ": ", what)); }

  /// What `make()` returns; the place is put before what it refuses.
  template <class Make>
  auto checked(Make&& make) const {
    try {
      return make();
    } catch (const argument_error& e) {
      fail(e.what());
    }
  }

 private:
  line_reader lines_;
  std::string format_;
  std::vector<std::string_view> fields_;
  std::vector<double> numbers_;
};

}  // namespace aib::io
