// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/io/bytes.hpp>
#include <aib/io/file.hpp>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

namespace aib::io {

/// Walks the bytes of a file from front to back in large blocks; only one block is in memory.
/// Every step is checked against the end of the file before memory is asked for, and every error
/// names the byte and what was being read. The file must outlive the stream.
class byte_stream {
 public:
  explicit byte_stream(const input_file& file, std::uint64_t offset = 0)
      : file_(&file), block_offset_(offset) {}

  [[nodiscard]] std::uint64_t offset() const { return block_offset_ + at_; }
  [[nodiscard]] std::uint64_t left() const { return file_->size() - offset(); }

  /// The next `n` bytes, valid until the next call.
  const char* take(std::size_t n, std::string_view what) {
    if (n > filled_ - at_) refill(n, what);
    const char* bytes = block_.data() + at_;
    at_ += n;
    return bytes;
  }

  template <class T>
  T read_number(std::string_view what, std::endian order = std::endian::little) {
    return load<T>(take(sizeof(T), what), order);
  }

  /// A count of records that take at least `record_bytes` each: refused where the file cannot hold
  /// so many.
  template <class T>
  std::size_t read_count(std::size_t record_bytes, std::string_view what) {
    const std::uint64_t at = offset();
    const auto count = static_cast<std::uint64_t>(read_number<T>(what));
    if (count > left() / record_bytes) {
      throw format_error(file_->path(), at_byte{at},
                         message(what, ": ", count, " records of at least ", record_bytes,
                                 " bytes do not fit in the ", left(), " bytes left"));
    }
    return static_cast<std::size_t>(count);
  }

  /// Text up to a NUL, which is skipped; at most 4096 characters.
  std::string take_name(std::string_view what) {
    std::string name;
    for (char c; (c = *take(1, what)) != '\0'; name += c) {
      if (name.size() == 4096) fail(message(what, ": no end within 4096 characters"));
    }
    return name;
  }

  /// Copies the next `n` bytes to `to`; large pieces go there without a detour.
  void read(void* to, std::size_t n, std::string_view what) {
    const std::size_t ready = std::min(n, filled_ - at_);
    if (ready > 0) std::memcpy(to, take(ready, what), ready);
    if (n == ready) return;
    if (n - ready < block_size) {
      std::memcpy(static_cast<char*>(to) + ready, take(n - ready, what), n - ready);
      return;
    }
    demand(n - ready, what);
    file_->read_at(offset(), static_cast<char*>(to) + ready, n - ready);
    move_to(offset() + (n - ready));
  }

  void skip(std::uint64_t n, std::string_view what) {
    demand(n, what);
    if (n <= filled_ - at_) {
      at_ += static_cast<std::size_t>(n);
    } else {
      move_to(offset() + n);
    }
  }

  /// Throws format_error where fewer than `n` bytes are left.
  void demand(std::uint64_t n, std::string_view what) const {
    if (n > left()) fail(message(what, ": ", n, " bytes expected, ", left(), " left in the file"));
  }

  [[noreturn]] void fail(std::string_view what) const {
    throw format_error(file_->path(), at_byte{offset()}, what);
  }

 private:
  static constexpr std::size_t block_size = std::size_t{1} << 20;

  void move_to(std::uint64_t offset) {
    block_offset_ = offset;
    at_ = filled_ = 0;
  }

  void refill(std::size_t n, std::string_view what) {
    demand(n, what);
    const auto wanted = static_cast<std::size_t>(
        std::min<std::uint64_t>(left(), std::max<std::size_t>(n, block_size)));
    const std::size_t kept = filled_ - at_;
    if (kept > 0) std::memmove(block_.data(), block_.data() + at_, kept);
    move_to(offset());
    if (block_.size() < wanted) block_.resize(wanted);
    file_->read_at(block_offset_ + kept, block_.data() + kept, wanted - kept);
    filled_ = wanted;
  }

  const input_file* file_;
  std::vector<char> block_;
  std::uint64_t block_offset_;  ///< place of the block in the file
  std::size_t at_ = 0;          ///< next byte in the block
  std::size_t filled_ = 0;      ///< bytes of the block that were read
};

}  // namespace aib::io
