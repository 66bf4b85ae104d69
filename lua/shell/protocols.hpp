// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace aib::shell {

/// Folders in which protocols are found by name, in order: the working folder, those of AIB_PATH,
/// the installed ones.
std::vector<std::filesystem::path> protocol_folders(bool ignore_environment);

/// The script of a protocol: NAME.lua in the first folder that has it.
std::optional<std::filesystem::path> find_protocol(
    const std::string& name, const std::vector<std::filesystem::path>& folders);

/// Names of the scripts in the folders, sorted, each once.
std::vector<std::string> protocol_names(const std::vector<std::filesystem::path>& folders);

}  // namespace aib::shell
