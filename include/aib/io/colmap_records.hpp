// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/cloud.hpp>
#include <aib/core/error.hpp>
#include <aib/io/pose_frame.hpp>
#include <aib/math/camera.hpp>
#include <aib/math/rigid3.hpp>
#include <aib/math/rotation.hpp>

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// What the files of a COLMAP model hold, record by record, as the text and the binary reader find
/// it. `io::read_colmap` makes a model of it.
namespace aib::io::colmap {

/// Kind and number of a sensor: kind 0 is a camera, 1 an IMU.
using sensor = std::pair<std::int32_t, std::uint32_t>;

inline constexpr std::int32_t camera_sensor = 0;
inline constexpr std::int32_t imu_sensor = 1;

struct image {
  std::uint32_t id = 0;
  std::uint32_t camera_id = 0;
  math::rigid3 camera_from_world = {};
  std::string name = {};
};

/// Sensors that move together. The reference sensor is the rig's own frame.
struct rig {
  std::optional<sensor> reference = {};
  std::map<sensor, math::rigid3> sensor_from_rig = {};  ///< those whose pose is known
};

struct frame {
  std::uint32_t rig_id = 0;
  math::rigid3 rig_from_world = {};
  std::vector<std::pair<sensor, std::uint64_t>> data = {};  ///< sensor and image
};

struct points {
  std::vector<Eigen::Vector3d> positions = {};
  std::vector<cloud::color> colors = {};
  std::vector<double> errors_px = {};
  std::vector<std::uint64_t> track_lengths = {};
};

/// The pose of a record: camera_from_world, rig_from_world or sensor_from_rig as it stands in the
/// file. Throws argument_error where a number is not finite or the quaternion is zero.
[[nodiscard]] inline math::rigid3 written_pose(const math::quaternion& q,
                                               const Eigen::Vector3d& translation) {
  math::rigid3 pose = pose_from_quaternion(q, translation);
  if (!pose.is_finite()) throw argument_error("the pose is not finite");
  return pose;
}

/// Adds a camera. Throws argument_error where the id is taken or the parameters are not finite.
inline void add_camera(std::map<std::uint32_t, math::camera>& cameras,
                       std::uint32_t id,
                       math::camera camera) {
  for (const double parameter : camera.parameters) {
    if (!std::isfinite(parameter))
      throw argument_error(message("camera ", id, " has a parameter that is not finite"));
  }
  if (!cameras.emplace(id, std::move(camera)).second)
    throw argument_error(message("camera ", id, " comes twice"));
}

/// Adds a rig. Throws argument_error where the id is taken.
inline void add_rig(std::map<std::uint32_t, rig>& rigs, std::uint32_t id, rig r) {
  if (!rigs.emplace(id, std::move(r)).second)
    throw argument_error(message("rig ", id, " comes twice"));
}

}  // namespace aib::io::colmap
