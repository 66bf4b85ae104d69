// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <doctest/doctest.h>

#include <filesystem>
#include <string>

namespace aib::support {

/// Folder of expected numbers and files of other programs, read where it lies and never copied.
inline std::filesystem::path shared() { return AIB_SHARED; }

/// Whether the folder is here. Where it is not, the test says that it is skipped; tests/run.sh
/// counts and lists these lines.
inline bool has_shared(const char* test) {
  if (std::filesystem::exists(shared() / "golden" / "manifest.json")) return true;
  MESSAGE((std::string("SKIPPED: ") + test + ": the shared folder is not here"));
  return false;
}

}  // namespace aib::support
