// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/io/file.hpp>

#include <cerrno>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <sys/mman.h>

namespace aib::io {

/// A file as bytes in memory, of which only what is looked at is read from the disk. Meant for
/// large files whose greater part is skipped. Throws io_error as input_file does.
///
/// The file must not be shortened by another program meanwhile: reading beyond its new end ends the
/// process.
class mapped_file {
 public:
  explicit mapped_file(const std::filesystem::path& path) : file_(path) {
    size_ = static_cast<std::size_t>(file_.size());
    if (size_ == 0) return;
    data_ = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, file_.descriptor(), 0);
    if (data_ == MAP_FAILED) throw io_error(path, message("cannot map: ", std::strerror(errno)));
    ::posix_madvise(data_, size_, POSIX_MADV_SEQUENTIAL);
  }
  mapped_file(const mapped_file&) = delete;
  mapped_file& operator=(const mapped_file&) = delete;
  ~mapped_file() {
    if (size_ > 0) ::munmap(data_, size_);
  }

  [[nodiscard]] const std::filesystem::path& path() const { return file_.path(); }
  [[nodiscard]] std::string_view bytes() const { return {static_cast<const char*>(data_), size_}; }

 private:
  input_file file_;
  void* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace aib::io
