// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/pose/trajectory.hpp>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace aib::io {

/// The last step of every reader of poses: refuses a file without a pose and adds a warning for
/// each thing to doubt: poses that are not finite, repeated names, stamps that repeat or go back.
[[nodiscard]] inline pose::trajectory checked_trajectory(pose::trajectory t,
                                                         const std::filesystem::path& path,
                                                         std::string_view format) {
  if (t.empty()) throw format_error(path, message(format, ": no pose in the file"));
  const auto warn = [&](std::size_t n, std::string_view what) {
    if (n > 0) t.warnings.push_back(message(n, " of ", t.size(), " poses ", what));
  };
  const auto repeats = [](auto values) {
    std::sort(values.begin(), values.end());
    return static_cast<std::size_t>(values.end() - std::unique(values.begin(), values.end()));
  };
  std::size_t unregistered = 0;
  for (const math::rigid3& pose : t.world_from_camera) unregistered += pose.is_finite() ? 0 : 1;
  warn(unregistered, "are not finite: not registered");
  warn(repeats(t.names), "repeat a name");
  warn(repeats(t.stamps_s), "repeat a stamp");
  std::size_t backward = 0;
  for (std::size_t i = 1; i < t.stamps_s.size(); ++i)
    backward += t.stamps_s[i] < t.stamps_s[i - 1] ? 1 : 0;
  warn(backward, "have an earlier stamp than the pose before");
  return t;
}

}  // namespace aib::io
