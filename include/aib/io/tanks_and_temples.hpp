// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/io/file.hpp>
#include <aib/io/kitti.hpp>
#include <aib/io/number_lines.hpp>
#include <aib/io/pose_frame.hpp>
#include <aib/io/trajectory_check.hpp>
#include <aib/pose/trajectory.hpp>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace aib::io {

/// Poses of a Tanks and Temples .log file: for each frame a line of three whole numbers and the
/// four rows of a matrix, world_from_camera. Record k is frame k, as the benchmark reads it.
///
/// A frame that the tools did not register is written as identity with -1 as the second number: it
/// stays in its place, unregistered.
/// Throws format_error where a record is cut off or is not a pose, and for a file without a pose.
/// Source: Knapitsch et al., "Tanks and Temples", TOG 2017; TanksAndTemples
/// python_toolbox/convert_to_logfile.py.
[[nodiscard]] inline pose::trajectory read_tanks_and_temples(const std::filesystem::path& path,
                                                             const pose_frame& frame = {}) {
  const std::string text = read_file(path);
  number_lines lines(text, path, "log");
  pose::trajectory t;
  while (lines.next()) {
    lines.expect(3, "frame, frame, 0");
    const bool lost = lines.numbers()[1] == -1;
    std::vector<double> rows;
    for (int r = 0; r < 4; ++r) {
      if (!lines.next()) lines.fail("the file ends within a matrix");
      lines.expect(4, "row of a 4 x 4 matrix");
      rows.insert(rows.end(), lines.numbers().begin(), lines.numbers().end());
    }
    const pose_matrix matrix = matrix_of_rows(rows);
    const bool identity = matrix == pose_matrix::Identity();
    t.world_from_camera.push_back(lost && identity ? unregistered_pose() : lines.checked([&] {
      return pose_from_matrix(matrix, frame);
    }));
  }
  return checked_trajectory(std::move(t), path, "log");
}

}  // namespace aib::io
