// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/io/file.hpp>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>

namespace aib::support {

/// An empty folder of the test's own, removed at the end.
class scratch {
 public:
  scratch() {
    std::string name = (std::filesystem::temp_directory_path() / "aib_test.XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw io_error(name, "cannot create");
    folder_ = name;
  }
  scratch(const scratch&) = delete;
  scratch& operator=(const scratch&) = delete;
  ~scratch() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

  /// Writes a file into the folder, with the folders it needs, and returns its path.
  std::filesystem::path file(const std::filesystem::path& name, std::string_view content) const {
    const std::filesystem::path path = folder_ / name;
    std::filesystem::create_directories(path.parent_path());
    io::write_file(path, content);
    return path;
  }

 private:
  std::filesystem::path folder_;
};

}  // namespace aib::support
