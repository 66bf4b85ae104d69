// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include "protocols.hpp"

#include <cstdlib>
#include <set>
#include <string_view>
#include <system_error>

namespace aib::shell {

namespace fs = std::filesystem;

namespace {

/// The installed folder is found from the program, so that an installation can be moved.
fs::path installed_folder() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const fs::path beside = program.parent_path().parent_path() / "share" / "aib" / "protocols";
  if (!error && fs::is_directory(beside, error)) return beside;
  return AIB_PROTOCOLS;
}

}  // namespace

std::vector<fs::path> protocol_folders(bool ignore_environment) {
  std::vector<fs::path> folders = {"."};
  const char* variable = ignore_environment ? nullptr : std::getenv("AIB_PATH");
  std::string_view rest = variable ? variable : "";
  while (!rest.empty()) {
    const std::size_t colon = rest.find(':');
    if (colon != 0) folders.emplace_back(rest.substr(0, colon));
    rest = colon == rest.npos ? "" : rest.substr(colon + 1);
  }
  folders.push_back(installed_folder());
  return folders;
}

std::optional<fs::path> find_protocol(const std::string& name,
                                      const std::vector<fs::path>& folders) {
  for (const fs::path& folder : folders) {
    std::error_code ignored;
    const fs::path script = folder / (name + ".lua");
    if (fs::is_regular_file(script, ignored)) return script;
  }
  return std::nullopt;
}

std::vector<std::string> protocol_names(const std::vector<fs::path>& folders) {
  std::set<std::string> names;
  for (const fs::path& folder : folders) {
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
      if (entry->path().extension() == ".lua") names.insert(entry->path().stem().string());
    }
  }
  return {names.begin(), names.end()};
}

}  // namespace aib::shell
