// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <charconv>
#include <cstddef>
#include <optional>
#include <string_view>
#include <system_error>

namespace aib::io {

/// A number at the front of a text and how many characters it takes.
template <class Number>
struct number_at_front {
  Number value;
  std::size_t length;
};

/// The number at the front of a text, in no locale; nothing where there is none. "nan" and "inf"
/// are numbers, a leading + is allowed, what is too small for the type is 0 and what is too large
/// none.
template <class Number>
[[nodiscard]] std::optional<number_at_front<Number>> find_number(std::string_view text) {
  const std::size_t begin = text.starts_with('+') && !text.starts_with("+-") ? 1 : 0;
  Number value{};
  const auto [end, code] = std::from_chars(text.data() + begin, text.data() + text.size(), value);
  if (code == std::errc::invalid_argument) return std::nullopt;
  const auto length = static_cast<std::size_t>(end - text.data());
  if (code == std::errc::result_out_of_range) {
    text = text.substr(0, length);
    if (text.find("e-") == std::string_view::npos && text.find("E-") == std::string_view::npos)
      return std::nullopt;
    value = 0;
  }
  return number_at_front<Number>{value, length};
}

/// Takes the next number off the front of a line (see find_number); nothing, and the line as it
/// was, where the next field is not a number or the line is at its end. Fields are parted by the
/// characters of `separators`.
[[nodiscard]] inline std::optional<double> take_number(std::string_view& line,
                                                       std::string_view separators = " \t\r\v\f") {
  const auto is_separator = [&](char c) { return separators.find(c) != std::string_view::npos; };
  std::size_t at = 0;
  while (at < line.size() && is_separator(line[at])) ++at;
  const auto number = find_number<double>(line.substr(at));
  if (!number) return std::nullopt;
  const std::size_t end = at + number->length;
  if (end < line.size() && !is_separator(line[end])) return std::nullopt;
  line.remove_prefix(end);
  return number->value;
}

}  // namespace aib::io
