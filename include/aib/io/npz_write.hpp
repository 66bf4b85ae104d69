// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/io/bytes.hpp>
#include <aib/io/file.hpp>
#include <aib/io/npy.hpp>
#include <aib/io/npz.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace aib::io {

/// Writes named arrays as an NPZ file, stored, as numpy.savez does; dates are those of the zip
/// format's beginning, so that the same arrays give the same bytes.
/// Throws argument_error where an array, or all of them, take more than 4 GB.
void write_npz(const std::filesystem::path& path,
               const std::vector<std::pair<std::string, array>>& arrays);

namespace detail {

/// Builds a zip file of stored members.
class zip_writer {
 public:
  void add(const std::string& name, const std::string& content) {
    const std::uint64_t offset = file_.size();
    if (offset + content.size() > max_offset)
      throw argument_error("write_npz: more than 4 GB in one file");
    const std::string member = member_fields(name, content);
    store(file_, zip_local);
    file_ += member + name + content;
    store(directory_, zip_central);
    store(directory_, version);
    directory_ += member;
    directory_ += std::string(10, '\0');  // comment, disk, attributes
    store(directory_, static_cast<std::uint32_t>(offset));
    directory_ += name;
    ++members_;
  }

  std::string finish() {
    const auto begin = static_cast<std::uint32_t>(file_.size());
    file_ += directory_;
    store(file_, zip_end);
    store(file_, std::uint32_t{0});
    store(file_, members_);
    store(file_, members_);
    store(file_, static_cast<std::uint32_t>(directory_.size()));
    store(file_, begin);
    store(file_, std::uint16_t{0});
    return std::move(file_);
  }

 private:
  static constexpr std::uint64_t max_offset = 0xfffffffe;
  static constexpr std::uint16_t version = 20;

  /// What the local header and the directory have in common.
  static std::string member_fields(const std::string& name, const std::string& content) {
    constexpr std::uint16_t january_1_1980 = 1 + (1 << 5);
    std::string fields;
    store(fields, version);
    store(fields, std::uint32_t{0});  // flags, method
    store(fields, std::uint16_t{0});  // time
    store(fields, january_1_1980);
    store(fields, crc32_of(content));
    store(fields, static_cast<std::uint32_t>(content.size()));
    store(fields, static_cast<std::uint32_t>(content.size()));
    store(fields, static_cast<std::uint16_t>(name.size()));
    store(fields, std::uint16_t{0});  // extra field
    return fields;
  }

  std::string file_;
  std::string directory_;
  std::uint16_t members_ = 0;
};

}  // namespace detail

inline void write_npz(const std::filesystem::path& path,
                      const std::vector<std::pair<std::string, array>>& arrays) {
  constexpr std::size_t max_members = 65534;
  if (arrays.size() > max_members)
    throw argument_error(
        message("write_npz: at most ", max_members, " arrays, found ", arrays.size()));
  detail::zip_writer zip;
  for (const auto& [name, a] : arrays) zip.add(name + ".npy", npy_bytes(a));
  write_file(path, zip.finish());
}

}  // namespace aib::io
