// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <charconv>
#include <string>
#include <string_view>
#include <type_traits>

namespace aib {

namespace detail {

inline void append(std::string& out, std::string_view part) { out += part; }

template <class Number>
requires std::is_arithmetic_v<Number>
void append(std::string& out, Number value) {
  if constexpr (std::is_same_v<Number, bool>) {
    out += value ? "true" : "false";
  } else if constexpr (std::is_same_v<Number, char>) {
    out += value;
  } else {
    char digits[32];
    const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
    out.append(digits, end);
  }
}

}  // namespace detail

/// The parts written one after another; numbers in their shortest exact form, in no locale.
template <class... Parts>
[[nodiscard]] std::string message(const Parts&... parts) {
  std::string out;
  (detail::append(out, parts), ...);
  return out;
}

}  // namespace aib
