// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/core/message.hpp>

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>

namespace aib::report {

/// Bytes as base64 with padding (RFC 4648), as a page carries them.
[[nodiscard]] std::string base64(std::string_view bytes);

/// Bytes as a zlib stream (RFC 1950), which browsers expand by themselves.
[[nodiscard]] std::string deflated(std::string_view bytes);

/// A closed range of numbers that steps are counted in.
struct range {
  double low = 0;
  double high = 0;
};

/// The range of the finite numbers; 0..0 where there is none.
template <class Number>
[[nodiscard]] range range_of(std::span<const Number> values) {
  range r{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const Number v : values) {
    if (!std::isfinite(v)) continue;
    r.low = std::min(r.low, static_cast<double>(v));
    r.high = std::max(r.high, static_cast<double>(v));
  }
  return r.low <= r.high ? r : range{};
}

/// The step of a number: 0 at the low end to max - 1 at the high end, max for NaN. Numbers outside
/// count as the end next to them.
template <class Step>
[[nodiscard]] Step step_of(double value, const range& r) {
  constexpr Step none = std::numeric_limits<Step>::max();
  if (std::isnan(value)) return none;
  const double width = r.high - r.low;
  const double share = width > 0 ? std::clamp((value - r.low) / width, 0.0, 1.0) : 0;
  return static_cast<Step>(std::lround(share * (none - 1)));
}

/// Appends a number in little-endian order.
template <class Number>
void append_little_endian(std::string& to, Number value) {
  for (std::size_t i = 0; i < sizeof(Number); ++i)
    to += static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i) & 0xff);
}

/// Numbers in 65535 steps of a range, deflated, in base64: little-endian, 65535 for NaN.
[[nodiscard]] inline std::string packed(std::span<const float> values, const range& r) {
  std::string bytes;
  bytes.reserve(2 * values.size());
  for (const float v : values)
    append_little_endian(bytes, step_of<std::uint16_t>(static_cast<double>(v), r));
  return base64(deflated(bytes));
}

inline std::string base64(std::string_view bytes) {
  constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t n = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (k < n ? static_cast<std::uint8_t>(bytes[i + k]) : 0);
    for (std::size_t k = 0; k < 4; ++k) text += k <= n ? digits[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

inline std::string deflated(std::string_view bytes) {
  constexpr int level = 1;  // the fastest, a few percent larger than others
  auto size = compressBound(static_cast<uLong>(bytes.size()));
  std::string out(size, '\0');
  const int status = compress2(reinterpret_cast<Bytef*>(out.data()), &size,
                               reinterpret_cast<const Bytef*>(bytes.data()),
                               static_cast<uLong>(bytes.size()), level);
  if (status != Z_OK) throw error(message("report::deflated: zlib says ", status));
  out.resize(size);
  return out;
}

}  // namespace aib::report
