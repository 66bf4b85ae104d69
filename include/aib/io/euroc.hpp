// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/io/file.hpp>
#include <aib/io/number_lines.hpp>
#include <aib/io/pose_frame.hpp>
#include <aib/io/text.hpp>
#include <aib/io/trajectory_check.hpp>
#include <aib/pose/trajectory.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace aib::io {

/// Poses of a EuRoC MAV csv file (state_groundtruth_estimate0/data.csv, vicon0/data.csv, or a
/// pose file of its kind): `stamp [ns], x, y, z, qw, qx, qy, qz` and columns that are not read.
///
/// The poses are those of the body that the file is about (IMU or marker), world_from_body: apply
/// the camera's calibration where cameras are compared. Stamps become seconds.
/// Throws format_error for a line with fewer than 8 numbers, a stamp that is no number of
/// nanoseconds, a zero quaternion and a file without a pose.
/// Source: Burri et al., "The EuRoC micro aerial vehicle datasets", IJRR 2016.
[[nodiscard]] inline pose::trajectory read_euroc(const std::filesystem::path& path,
                                                 const pose_frame& frame = {}) {
  constexpr std::int64_t ns_per_s = 1'000'000'000;
  const std::string text = read_file(path);
  number_lines lines(text, path, "euroc");
  pose::trajectory t;
  while (lines.next()) {
    const std::vector<double>& n = lines.numbers();
    if (n.size() < 8) {
      lines.fail(
          message("at least 8 numbers (stamp x y z qw qx qy qz) expected, found ", n.size()));
    }
    const auto stamp_ns = parse<std::int64_t>(lines.fields().front());
    if (!stamp_ns) {
      lines.fail(
          message("a stamp in whole nanoseconds expected, found '", lines.fields().front(), "'"));
    }
    t.stamps_s.push_back(static_cast<double>(*stamp_ns / ns_per_s) +
                         static_cast<double>(*stamp_ns % ns_per_s) / double{ns_per_s});
    t.world_from_camera.push_back(lines.checked([&] {
      return pose_from_quaternion({n[4], n[5], n[6], n[7]}, {n[1], n[2], n[3]}, frame);
    }));
  }
  return checked_trajectory(std::move(t), path, "euroc");
}

}  // namespace aib::io
