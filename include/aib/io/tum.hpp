// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/io/file.hpp>
#include <aib/io/number_lines.hpp>
#include <aib/io/pose_frame.hpp>
#include <aib/io/trajectory_check.hpp>
#include <aib/pose/trajectory.hpp>

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace aib::io {

/// Where the scalar of a written quaternion stands.
enum class quaternion_order {
  xyzw,  ///< last: TUM
  wxyz,  ///< first: what MonST3R and CUT3R write as pred_traj.txt
};

struct tum_options {
  pose_frame frame = {};
  quaternion_order quaternion = quaternion_order::xyzw;
};

/// Poses of a TUM RGB-D text file: `stamp tx ty tz qx qy qz qw` a line, world_from_camera, parted
/// by blanks or commas. Quaternions are normalised; poses that are not finite stay, unregistered.
///
/// Throws format_error for a line without 8 numbers, a stamp that is not finite, a zero quaternion
/// and a file without a pose.
/// Source: Sturm et al., "A benchmark for the evaluation of RGB-D SLAM systems", IROS 2012.
[[nodiscard]] inline pose::trajectory read_tum(const std::filesystem::path& path,
                                               const tum_options& options = {}) {
  constexpr double normalised = 1e-2;
  const bool w_first = options.quaternion == quaternion_order::wxyz;
  const std::string text = read_file(path);
  number_lines lines(text, path, "tum");
  pose::trajectory t;
  std::size_t not_unit = 0;
  while (lines.next()) {
    lines.expect(8, w_first ? "stamp tx ty tz qw qx qy qz" : "stamp tx ty tz qx qy qz qw");
    const std::vector<double>& n = lines.numbers();
    if (!std::isfinite(n[0])) lines.fail("the stamp is not finite");
    const math::quaternion q = w_first ? math::quaternion{n[4], n[5], n[6], n[7]}
                                       : math::quaternion{n[7], n[4], n[5], n[6]};
    const double norm = std::hypot(std::hypot(q.w, q.x), std::hypot(q.y, q.z));
    not_unit += std::abs(norm - 1) > normalised ? 1 : 0;
    t.stamps_s.push_back(n[0]);
    t.world_from_camera.push_back(lines.checked([&] {
      return pose_from_quaternion(q, {n[1], n[2], n[3]}, options.frame);
    }));
  }
  if (not_unit > 0)
    t.warnings.push_back(message(not_unit, " quaternions are not of length 1: normalised"));
  return checked_trajectory(std::move(t), path, "tum");
}

/// Writes the registered poses as a TUM file, numbers in their shortest exact form. A trajectory
/// without stamps gets its indices. Throws argument_error where no pose is registered.
inline void write_tum(const std::filesystem::path& path,
                      const pose::trajectory& t,
                      const tum_options& options = {}) {
  pose::check(t);
  std::string text;
  for (std::size_t i = 0; i < t.size(); ++i) {
    if (!t.world_from_camera[i].is_finite()) continue;
    const math::rigid3 pose = pose_in_frame(t.world_from_camera[i], options.frame);
    const math::quaternion q = math::quaternion_from(pose.rotation);
    const Eigen::Vector3d& p = pose.translation;
    const double stamp = t.stamps_s.empty() ? static_cast<double>(i) : t.stamps_s[i];
    text += message(stamp, ' ', p.x(), ' ', p.y(), ' ', p.z(), ' ');
    text += options.quaternion == quaternion_order::wxyz
                ? message(q.w, ' ', q.x, ' ', q.y, ' ', q.z, '\n')
                : message(q.x, ' ', q.y, ' ', q.z, ' ', q.w, '\n');
  }
  if (text.empty()) throw argument_error("write_tum: no registered pose to write");
  write_file(path, text);
}

}  // namespace aib::io
