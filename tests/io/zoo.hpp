// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>

#include <filesystem>
#include <functional>
#include <map>
#include <string>

/// Readers that the files of the zoo are held against, see test_zoo.cpp.
namespace aib::zoo {

/// Reads the file or folder, CHECKs what is expected of it, throws aib::error where it is refused.
using reader = std::function<void(const std::filesystem::path& path, const nlohmann::json& expect)>;

/// Format of the manifest -> reader.
inline std::map<std::string, reader>& readers() {
  static std::map<std::string, reader> table;
  return table;
}

/// Adds a reader: `const zoo::entry npy("npy", [](const auto& path, const auto& expect) {...});`
struct entry {
  entry(const char* format, reader read) { readers()[format] = std::move(read); }
};

}  // namespace aib::zoo
