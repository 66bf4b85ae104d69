// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/message.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

namespace aib {

/// Root of every exception that aib throws. The message says where, what was expected, what was
/// found.
class error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A file cannot be opened or read.
class io_error : public error {
 public:
  io_error(const std::filesystem::path& path, std::string_view what)
      : error(message(path.string(), ": ", what)) {}
};

/// A file cannot be written: not the input is at fault.
class output_error : public io_error {
 public:
  using io_error::io_error;
};

/// One-based line of a text file.
struct at_line {
  std::size_t number;
};

/// Zero-based byte of a binary file.
struct at_byte {
  std::uint64_t offset;
};

/// The content of a file is not what its format demands.
class format_error : public error {
 public:
  format_error(const std::filesystem::path& path, std::string_view what)
      : error(message(path.string(), ": ", what)) {}
  format_error(const std::filesystem::path& path, at_line line, std::string_view what)
      : error(message(path.string(), ":", line.number, ": ", what)) {}
  format_error(const std::filesystem::path& path, at_byte byte, std::string_view what)
      : error(message(path.string(), ": byte ", byte.offset, ": ", what)) {}
};

/// The caller passed something that the function does not accept.
class argument_error : public error {
 public:
  using error::error;
};

/// A metric over nothing: no valid pixel, no pair, an empty cloud. Carries the counts in its
/// message.
class undefined_error : public error {
 public:
  using error::error;
};

/// The work was stopped through its stop token; nothing half-done is left behind.
class stopped_error : public error {
 public:
  using error::error;
};

}  // namespace aib
