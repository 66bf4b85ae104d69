// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/math/rigid3.hpp>
#include <aib/math/rotation.hpp>
#include <aib/mesh/distances.hpp>
#include <aib/mesh/ray_surface.hpp>
#include <aib/pose/trajectory.hpp>
#include <aib/survey/clearance.hpp>
#include <aib/survey/facing.hpp>
#include <aib/survey/flight_path.hpp>
#include <aib/survey/frame_scale.hpp>
#include <aib/survey/lens.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace aib::survey {

/// What happens to poses that are too near to the mesh.
enum class clearance_rule {
  push,    ///< they are moved away
  refuse,  ///< the plan is
};

/// Where the camera looks.
enum class aim_rule {
  path,    ///< as the path says
  normal,  ///< along the normal of the surface that it would see, where it sees one
};

/// What happens where the view would turn faster than the gimbal can.
enum class gimbal_rule {
  slow,  ///< the flight slows down there, so that every frame looks as planned
  lag,   ///< the flight keeps its speed, the view lags behind
};

/// What a flight keeps away from and looks at.
struct flight_space {
  const mesh::surface_index& distance;  ///< for the distance
  const mesh::ray_surface& sight;       ///< for the aim
};

struct fly_options {
  double overlap = 0.8;                    ///< of frames along the path, 0 .. 1
  std::optional<std::size_t> frames = {};  ///< instead: exactly as many
  double min_distance = 0;                 ///< to the mesh; 0: nobody looks
  clearance_rule clearance = clearance_rule::push;
  aim_rule aim = aim_rule::path;
  double speed = 2;                                    ///< m/s, gives the stamps
  double gimbal_rate = 60 / math::degrees_per_radian;  ///< radians/s: largest turn of the view
  gimbal_rule gimbal = gimbal_rule::slow;
  /// Name of the image of a frame, counted from 0.
  std::function<std::string(std::size_t)> name = [](std::size_t i) {
    const std::string digits = std::to_string(i);
    return std::string(digits.size() < 6 ? 6 - digits.size() : 0, '0') + digits + ".png";
  };
};

struct flight_plan {
  pose::trajectory trajectory = {};  ///< with names and stamps
  math::camera camera = {};
  double step = 0;            ///< mean distance between frames along the path
  double overlap = 0;         ///< of neighbouring frames on a wall at the stand-off
  double overlap_across = 1;  ///< of neighbouring rows, likewise
  double length = 0;
  double duration_s = 0;
  double gsd = 0;  ///< at the stand-off
  std::size_t n_pushed = 0;
  double largest_push = 0;
  std::optional<double> min_distance = {};  ///< of frames and of the way between, to the mesh
  std::size_t min_distance_frame = 0;       ///< at or behind which that is
  std::size_t n_gimbal_limited = 0;         ///< frames on whose way the gimbal is the limit
  double gimbal_delay_s = 0;                ///< what slowing down for it takes
  std::vector<double> view_lag = {};        ///< radians, of each frame: from the view as planned
};

namespace detail {

/// `to`, or on the way to it as far as an angle from `from`.
inline Eigen::Matrix3d turned_at_most(const Eigen::Matrix3d& from,
                                      const Eigen::Matrix3d& to,
                                      double angle) {
  const Eigen::Vector3d turn = math::axis_angle_from(to * from.transpose());
  if (turn.norm() <= angle) return to;
  const Eigen::Vector3d part = angle / turn.norm() * turn;
  return math::rotation_from(part) * from;
}

inline void place_frames(flight_plan& plan, const flight_path& path, const fly_options& options) {
  const frame_scale scale(path);
  const double total = scale.total();
  if (!(total > 0)) throw argument_error("survey::fly: a path of some length expected");
  double n_steps = 0;
  if (options.frames) {
    const std::size_t least = path.is_closed ? 1 : 2;
    if (*options.frames < least || *options.frames > 10000000)
      throw argument_error(message("survey::fly: ", least, " to 10 000 000 frames expected"));
    n_steps = static_cast<double>(*options.frames - (path.is_closed ? 0 : 1));
  } else {
    if (!(options.overlap >= 0 && options.overlap < 1))
      throw argument_error("survey::fly: an overlap of 0 to below 1 expected");
    n_steps = std::max(1.0, std::ceil(total / (1 - options.overlap) - 1e-9));
    if (n_steps > 1e7) throw argument_error("survey::fly: more than 10 000 000 frames");
  }
  plan.length = path.length();
  plan.step = plan.length / n_steps;
  plan.overlap = 1 - total / n_steps;
  const auto n = static_cast<std::size_t>(n_steps) + (path.is_closed ? 0 : 1);
  for (std::size_t i = 0; i < n; ++i) {
    plan.trajectory.world_from_camera.push_back(scale.at(static_cast<double>(i) / n_steps * total));
    plan.trajectory.names.push_back(options.name(i));
  }
}

/// Moves the poses that are too near to the mesh.
inline void push_away(flight_plan& plan, const fly_options& options, const clearance& keep) {
  auto& poses = plan.trajectory.world_from_camera;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    Eigen::Vector3d& at = poses[i].translation;
    const double distance = keep.nearest_to(at).distance;
    if (distance >= options.min_distance) continue;
    const auto there = options.clearance == clearance_rule::push ? keep.pushed(at) : std::nullopt;
    if (!there) {
      throw undefined_error(message(
          "survey::fly: ", plan.trajectory.names[i], " at (", at.x(), ", ", at.y(), ", ", at.z(),
          ") is ", distance, " from the mesh, at least ", options.min_distance, " expected",
          options.clearance == clearance_rule::push ? "; there is no way out of it nearby" : ""));
    }
    ++plan.n_pushed;
    plan.largest_push = std::max(plan.largest_push, (*there - at).norm());
    at = *there;
  }
}

/// How near frames and the ways between them come to the mesh.
inline void measure_distance(flight_plan& plan, double tolerated, const clearance& keep) {
  const auto& poses = plan.trajectory.world_from_camera;
  plan.min_distance = HUGE_VAL;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Eigen::Vector3d from = poses[i].translation;
    const Eigen::Vector3d way = poses[std::min(i + 1, poses.size() - 1)].translation - from;
    const double n = std::clamp(std::ceil(2 * way.norm() / tolerated), 1.0, 1000.0);
    for (double k = 0; k < n; ++k) {
      const double distance = keep.nearest_to(from + k / n * way).distance;
      if (distance >= *plan.min_distance) continue;
      plan.min_distance = distance;
      plan.min_distance_frame = i;
    }
  }
}

inline void keep_away(flight_plan& plan, const fly_options& options, const flight_space& space) {
  const clearance keep(space.distance, options.min_distance);
  push_away(plan, options, keep);
  measure_distance(plan, options.min_distance, keep);
  if (options.clearance == clearance_rule::refuse && *plan.min_distance < options.min_distance) {
    throw undefined_error(message("survey::fly: the way from ",
                                  plan.trajectory.names[plan.min_distance_frame],
                                  " to the next frame passes ", *plan.min_distance,
                                  " from the mesh, at least ", options.min_distance, " expected"));
  }
}

inline void aim(flight_plan& plan, const flight_path& path, const flight_space& space) {
  for (math::rigid3& pose : plan.trajectory.world_from_camera) {
    const auto view = facing_direction(pose, path.camera, space.sight, 3 * path.stand_off);
    // A view that would turn by more than 60 degrees belongs to something beside the asset.
    if (view && view->dot(pose.rotation.col(2)) >= 0.5)
      pose.rotation = looking(*view, -pose.rotation.col(1));
  }
}

/// Stamps, and views that turn no faster than the gimbal.
inline void follow(flight_plan& plan, const fly_options& options) {
  auto& poses = plan.trajectory.world_from_camera;
  plan.view_lag.assign(poses.size(), 0);
  plan.trajectory.stamps_s.assign(poses.size(), 0);
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const Eigen::Matrix3d from = poses[i - 1].rotation, wanted = poses[i].rotation;
    double time = (poses[i].translation - poses[i - 1].translation).norm() / options.speed;
    const double needed = math::rotation_angle(wanted * from.transpose()) / options.gimbal_rate;
    if (needed > time + 1e-9) {
      ++plan.n_gimbal_limited;
      if (options.gimbal == gimbal_rule::slow) {
        plan.gimbal_delay_s += needed - time;
        time = needed;
      } else {
        poses[i].rotation = turned_at_most(from, wanted, options.gimbal_rate * time);
        plan.view_lag[i] = math::rotation_angle(wanted * poses[i].rotation.transpose());
      }
    }
    plan.trajectory.stamps_s[i] = plan.trajectory.stamps_s[i - 1] + time;
  }
  plan.duration_s = plan.trajectory.stamps_s.back();
}

}  // namespace detail

/// Places frames on a path, evenly by what the image moves: exactly `frames`, or as few as keep the
/// overlap. The views of the frames turn no faster than the gimbal: where they would, the flight
/// takes longer, or they lag behind and the plan says by how much.
///
/// space   needed for min_distance and for aim_rule::normal
///
/// Throws argument_error where an option is out of its range or the space is missing;
/// undefined_error where a pose is too near to the mesh and cannot or shall not be pushed.
[[nodiscard]] inline flight_plan fly(const flight_path& path,
                                     const fly_options& options = {},
                                     const flight_space* space = nullptr) {
  if (!(options.speed > 0) || !(options.gimbal_rate > 0) || !(options.min_distance >= 0))
    throw argument_error("survey::fly: speed and gimbal rate above 0, a distance from 0 expected");
  if (!space && (options.min_distance > 0 || options.aim == aim_rule::normal))
    throw argument_error("survey::fly: a mesh expected to keep away from, or to aim at");
  flight_plan plan{.camera = path.camera,
                   .overlap_across = path.overlap_across,
                   .gsd = ground_sampling(path.camera, path.stand_off)};
  detail::place_frames(plan, path, options);
  if (options.min_distance > 0) detail::keep_away(plan, options, *space);
  if (options.aim == aim_rule::normal) detail::aim(plan, path, *space);
  detail::follow(plan, options);
  return plan;
}

}  // namespace aib::survey
