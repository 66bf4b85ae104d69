// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

namespace aib::io {

/// The number whose bytes lie at `from` in the given order.
template <class T>
[[nodiscard]] T load(const void* from, std::endian order = std::endian::little) {
  static_assert(std::is_arithmetic_v<T>);
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), from, sizeof(T));
  if (order != std::endian::native) std::reverse(bytes.begin(), bytes.end());
  return std::bit_cast<T>(bytes);
}

/// Appends the bytes of a number in the given order.
template <class T>
void store(std::string& to, T value, std::endian order = std::endian::little) {
  auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if (order != std::endian::native) std::reverse(bytes.begin(), bytes.end());
  to.append(bytes.data(), bytes.size());
}

/// Reads numbers one after another from bytes in memory. Every read is checked against the end, and
/// every error names the file, the byte and what was being read.
class byte_reader {
 public:
  byte_reader(std::string_view bytes,
              std::filesystem::path path,
              std::endian order = std::endian::little)
      : bytes_(bytes), path_(std::move(path)), order_(order) {}

  [[nodiscard]] std::size_t position() const { return position_; }
  [[nodiscard]] std::size_t left() const { return bytes_.size() - position_; }

  template <class T>
  T read(std::string_view what) {
    return load<T>(take(sizeof(T), what).data(), order_);
  }

  /// The next `n` bytes, in place.
  std::string_view take(std::size_t n, std::string_view what) {
    if (n > left()) fail(message(what, ": ", n, " bytes expected, ", left(), " left in the file"));
    return bytes_.substr(std::exchange(position_, position_ + n), n);
  }

  /// A count of records that take at least `record_bytes` each: refused where the file cannot hold
  /// so many.
  template <class T>
  std::size_t read_count(std::size_t record_bytes, std::string_view what) {
    const std::size_t at = position_;
    const auto count = static_cast<std::uint64_t>(read<T>(what));
    if (count > left() / record_bytes) {
      position_ = at;
      fail(message(what, ": ", count, " records of at least ", record_bytes,
                   " bytes do not fit in the ", bytes_.size() - at - sizeof(T), " bytes left"));
    }
    return static_cast<std::size_t>(count);
  }

  /// Text up to a NUL, which is skipped.
  std::string_view read_name(std::string_view what) {
    const std::size_t end = bytes_.find('\0', position_);
    if (end == std::string_view::npos) fail(message(what, ": no end of the name in the file"));
    const std::string_view name = bytes_.substr(position_, end - position_);
    position_ = end + 1;
    return name;
  }

  [[noreturn]] void fail(std::string_view what) const {
    throw format_error(path_, at_byte{position_}, what);
  }

 private:
  std::string_view bytes_;
  std::filesystem::path path_;
  std::endian order_;
  std::size_t position_ = 0;
};

}  // namespace aib::io
