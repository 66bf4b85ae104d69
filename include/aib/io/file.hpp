// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace aib::io {

/// A regular file opened for reading, of which any part can be read. Throws io_error where the path
/// is not one: missing, a folder, a pipe, not permitted.
class input_file {
 public:
  explicit input_file(std::filesystem::path path);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::uint64_t size() const { return size_; }
  [[nodiscard]] int descriptor() const { return ::fileno(file_.get()); }

  /// Reads exactly `n` bytes at `offset`. Throws format_error where the file ends before.
  void read_at(std::uint64_t offset, void* to, std::size_t n) const;

  /// The first `n` bytes, or all where there are fewer.
  [[nodiscard]] std::string begin(std::uint64_t n) const;

 private:
  struct closer {
    void operator()(std::FILE* f) const { std::fclose(f); }
  };
  std::filesystem::path path_;
  std::unique_ptr<std::FILE, closer> file_;
  std::uint64_t size_ = 0;
};

/// Whether there is a folder of this name, or anything at all; not where one may not look.
[[nodiscard]] inline bool is_folder(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::is_directory(path, ignored);
}
[[nodiscard]] inline bool is_there(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::exists(path, ignored);
}

/// The whole content of a file.
/// Throws io_error where it cannot be read, format_error where it is larger than `max_bytes`.
std::string read_file(const std::filesystem::path& path,
                      std::uint64_t max_bytes = std::numeric_limits<std::uint64_t>::max());

/// Writes a file under a temporary name beside it; `commit` makes it the file in one step. Where
/// commit is never reached, or fails, the old file stays as it was and the temporary one is
/// removed. Behind a link it is the link's target that is replaced. A device or pipe (and
/// /dev/stdout, whatever that is) is written as it is. Throws io_error where the path is a folder,
/// or a file that may not be written.
class output_file {
 public:
  explicit output_file(std::filesystem::path path);
  output_file(const output_file&) = delete;
  output_file& operator=(const output_file&) = delete;
  ~output_file();

  /// Throws io_error where the disk is full or the file is not writable.
  void write(const void* data, std::size_t n);
  void write(std::string_view text) { write(text.data(), text.size()); }
  /// Writes over what has been written, at an offset; a pipe cannot.
  void write_at(std::uint64_t offset, std::string_view text);
  void commit();

 private:
  void open_beside();
  [[noreturn]] void fail(const char* doing) const;

  std::filesystem::path path_;
  std::filesystem::path target_;     ///< behind links
  std::filesystem::path temporary_;  ///< empty: the target itself is written
  std::FILE* file_ = nullptr;
};

/// Writes a whole file in one step, see output_file.
void write_file(const std::filesystem::path& path, std::string_view content);

namespace detail {

/// A zero byte would end the name for the system, which would find another file.
inline void check_name(const std::filesystem::path& path) {
  if (path.native().find('\0') != std::string::npos)
    throw io_error(path, "a name without zero bytes expected");
}

}  // namespace detail

inline input_file::input_file(std::filesystem::path path) : path_(std::move(path)) {
  detail::check_name(path_);
  // O_NONBLOCK: opening a pipe without a writer must not hang.
  const int descriptor = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) throw io_error(path_, message("cannot open: ", std::strerror(errno)));
  file_.reset(::fdopen(descriptor, "rb"));
  struct stat status = {};
  if (!file_ || ::fstat(descriptor, &status) != 0)
    throw io_error(path_, message("cannot open: ", std::strerror(errno)));
  if (!S_ISREG(status.st_mode)) {
    throw io_error(path_, S_ISDIR(status.st_mode) ? "a file expected, found a folder"
                                                  : "a regular file expected");
  }
  size_ = static_cast<std::uint64_t>(status.st_size);
}

inline void input_file::read_at(std::uint64_t offset, void* to, std::size_t n) const {
  auto* bytes = static_cast<char*>(to);
  while (n > 0) {
    const ssize_t got = ::pread(descriptor(), bytes, n, static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw io_error(path_, message("cannot read: ", std::strerror(errno)));
    if (got == 0)
      throw format_error(path_, at_byte{offset},
                         message("the file ends, ", n, " more bytes expected"));
    bytes += got;
    offset += static_cast<std::uint64_t>(got);
    n -= static_cast<std::size_t>(got);
  }
}

inline std::string input_file::begin(std::uint64_t n) const {
  std::string bytes(static_cast<std::size_t>(std::min(n, size_)), '\0');
  read_at(0, bytes.data(), bytes.size());
  return bytes;
}

inline std::string read_file(const std::filesystem::path& path, std::uint64_t max_bytes) {
  const input_file file(path);
  if (file.size() > max_bytes) {
    throw format_error(path,
                       message("at most ", max_bytes, " bytes expected, found ", file.size()));
  }
  return file.begin(file.size());
}

inline output_file::output_file(std::filesystem::path path)
    : path_(std::move(path)), target_(path_) {
  detail::check_name(path_);
  struct stat status = {};
  if (::stat(path_.c_str(), &status) != 0) {
    open_beside();
    return;
  }
  if (S_ISDIR(status.st_mode)) throw output_error(path_, "a file expected, found a folder");
  if (::access(path_.c_str(), W_OK) != 0) fail("write");
  if (!S_ISREG(status.st_mode) || path_.string().starts_with("/dev/")) {
    file_ = std::fopen(path_.c_str(), "abe");
    if (!file_) fail("write");
    return;
  }
  std::error_code ignored;
  if (auto real = std::filesystem::canonical(path_, ignored); !ignored) target_ = std::move(real);
  open_beside();
}

inline void output_file::open_beside() {
  std::string name = target_.string() + ".XXXXXX";
  const int descriptor = ::mkstemp(name.data());
  if (descriptor < 0) fail("create");
  temporary_ = name;
  const mode_t mask = ::umask(0);
  ::umask(mask);
  ::fchmod(descriptor, 0666 & ~mask);
  file_ = ::fdopen(descriptor, "wb");
  if (!file_) fail("create");
}

inline output_file::~output_file() {
  if (file_) std::fclose(file_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

inline void output_file::fail(const char* doing) const {
  throw output_error(path_, message("cannot ", doing, ": ", std::strerror(errno)));
}

inline void output_file::write(const void* data, std::size_t n) {
  if (n > 0 && std::fwrite(data, 1, n, file_) != n) fail("write");
}

inline void output_file::write_at(std::uint64_t offset, std::string_view text) {
  const auto at = static_cast<off_t>(offset);
  if (std::fflush(file_) != 0) fail("write");
  if (::fseeko(file_, at, SEEK_SET) != 0) fail("write");
  write(text);
  if (::fseeko(file_, 0, SEEK_END) != 0) fail("write");
}

inline void output_file::commit() {
  const bool is_direct = temporary_.empty();
  if (std::fflush(file_) != 0 || (!is_direct && ::fsync(::fileno(file_)) != 0)) fail("write");
  if (std::fclose(std::exchange(file_, nullptr)) != 0) fail("write");
  if (is_direct) return;
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail("replace");
  temporary_.clear();
}

inline void write_file(const std::filesystem::path& path, std::string_view content) {
  output_file file(path);
  file.write(content);
  file.commit();
}

}  // namespace aib::io
