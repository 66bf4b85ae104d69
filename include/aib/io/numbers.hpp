// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <charconv>
#include <cstddef>
#include <optional>
#include <string_view>
#include <system_error>

namespace aib::io {

/// Takes the next number off the front of a line, in no locale; nothing, and the line as it was,
/// where the next field is not a number or the line is at its end. Fields are parted by the
/// characters of `separators`. "nan" and "inf" are numbers, a leading + is allowed, what is too
/// small for the type is 0 and what is too large no number.
template <class Number = double>
[[nodiscard]] inline std::optional<Number> take_number(  // inline: GCC's hint, 5% of a text cloud
    std::string_view& line,
    std::string_view separators = " \t\r\v\f") {
  const auto is_separator = [&](char c) { return separators.find(c) != std::string_view::npos; };
  std::size_t at = 0;
  while (at < line.size() && is_separator(line[at])) ++at;
  if (at + 1 < line.size() && line[at] == '+' && line[at + 1] != '-') ++at;
  Number value{};
  const char* const last = line.data() + line.size();
  const auto [end, code] = std::from_chars(line.data() + at, last, value);
  if (code == std::errc::invalid_argument || (end != last && !is_separator(*end)))
    return std::nullopt;
  if (code == std::errc::result_out_of_range) {
    const std::string_view text(line.data() + at, static_cast<std::size_t>(end - line.data()) - at);
    if (text.find("e-") == std::string_view::npos && text.find("E-") == std::string_view::npos)
      return std::nullopt;
    value = 0;
  }
  line.remove_prefix(static_cast<std::size_t>(end - line.data()));
  return value;
}

}  // namespace aib::io
