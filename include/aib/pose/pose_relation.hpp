// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/math/rigid3.hpp>
#include <aib/math/rotation.hpp>
#include <aib/stats/summary.hpp>

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <vector>

namespace aib::pose {

/// What of the motion between two poses is the error, as evo names it.
enum class pose_relation {
  translation,           ///< |t|
  rotation_part,         ///< |R - I|, Frobenius
  full,                  ///< |[R t] - [I 0]|, Frobenius
  angle_deg,             ///< angle of R
  angle_rad,             ///< angle of R
  point_distance,        ///< difference of two distances (rpe); the distance itself (ape)
  point_distance_ratio,  ///< rpe: that difference in percent of the reference's distance
};

inline constexpr std::array<std::string_view, 7> pose_relation_names = {
    "translation",    "rotation_part",        "full", "angle_deg", "angle_rad",
    "point_distance", "point_distance_ratio",
};

[[nodiscard]] constexpr std::string_view name(pose_relation r) {
  return pose_relation_names[static_cast<std::size_t>(r)];
}

/// Errors of frames or of pairs of frames, and their statistics.
struct pose_errors {
  stats::summary summary;
  std::vector<double> errors;      ///< one a frame or pair
  std::vector<std::size_t> index;  ///< the frame of each, the later one of a pair
};

/// Size of a motion that should be none.
[[nodiscard]] inline double magnitude(pose_relation relation, const math::rigid3& error) {
  const double rotation = (error.rotation - Eigen::Matrix3d::Identity()).norm();
  switch (relation) {
    case pose_relation::rotation_part:
      return rotation;
    case pose_relation::full:
      return std::hypot(rotation, error.translation.norm());
    case pose_relation::angle_deg:
      return math::degrees(math::rotation_angle(error.rotation));
    case pose_relation::angle_rad:
      return math::rotation_angle(error.rotation);
    default:
      return error.translation.norm();
  }
}

}  // namespace aib::pose
