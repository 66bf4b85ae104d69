// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <span>
#include <string>
#include <type_traits>
#include <unistd.h>
#include <utility>
#include <vector>

namespace aib::stream {

/// Numbers that wait on disk. The file has no name from the start: it is gone when this object is,
/// and when the program is killed.
template <class T>
requires(std::is_trivially_copyable_v<T>) class spill {
 public:
  /// Throws io_error where the folder is not writable.
  explicit spill(const std::filesystem::path& folder) : folder_(folder) {
    std::string name = (folder / "aib_spill.XXXXXX").string();
    file_ = ::mkostemp(name.data(), O_CLOEXEC);
    if (file_ < 0) fail("cannot create a temporary file");
    ::unlink(name.c_str());
  }
  spill(spill&& other) noexcept
      : folder_(std::move(other.folder_)),
        file_(std::exchange(other.file_, -1)),
        written_(other.written_),
        buffer_(std::move(other.buffer_)) {}
  spill& operator=(spill&&) = delete;
  ~spill() {
    if (file_ >= 0) ::close(file_);
  }

  [[nodiscard]] std::uint64_t size() const { return written_ + buffer_.size(); }

  void append(const T& value) {
    buffer_.push_back(value);
    if (buffer_.size() * sizeof(T) >= buffer_bytes) flush();
  }
  void append(std::span<const T> values) {
    flush();
    write(values);
  }

  /// Values first .. first + to.size().
  void read(std::uint64_t first, std::span<T> to) {
    flush();
    auto* bytes = reinterpret_cast<char*>(to.data());
    std::size_t left = to.size_bytes();
    for (auto offset = static_cast<off_t>(first * sizeof(T)); left > 0;) {
      const ssize_t got = ::pread(file_, bytes, left, offset);
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) fail("cannot read a temporary file");
      bytes += got;
      offset += got;
      left -= static_cast<std::size_t>(got);
    }
  }

 private:
  static constexpr std::size_t buffer_bytes = std::size_t{1} << 16;

  void flush() {
    write(buffer_);
    buffer_.clear();
  }

  void write(std::span<const T> values) {
    const auto* bytes = reinterpret_cast<const char*>(values.data());
    for (std::size_t left = values.size_bytes(); left > 0;) {
      const ssize_t put = ::write(file_, bytes, left);
      if (put < 0 && errno == EINTR) continue;
      if (put < 0) fail("cannot write a temporary file");
      bytes += put;
      left -= static_cast<std::size_t>(put);
    }
    written_ += values.size();
  }

  [[noreturn]] void fail(const char* what) const {
    throw output_error(folder_, message(what, ": ", std::strerror(errno)));
  }

  std::filesystem::path folder_;
  int file_ = -1;
  std::uint64_t written_ = 0;
  std::vector<T> buffer_;
};

}  // namespace aib::stream
