// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/core/random.hpp>
#include <aib/math/camera.hpp>
#include <aib/math/rigid3.hpp>
#include <aib/math/rotation.hpp>
#include <aib/pose/trajectory.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

namespace aib::survey {

/// What telemetry gets wrong. Lengths in the unit of the poses (metres), angles in radians. Nothing
/// by default. Vectors are x, y, z.
struct perturb_options {
  std::uint64_t seed = 1;
  Eigen::Vector3d position_noise = Eigen::Vector3d::Zero();  ///< white, standard deviations
  double position_walk = 0;  ///< a coordinate's standard deviation after a second (or a frame)
  Eigen::Vector3d position_bias = Eigen::Vector3d::Zero();
  double yaw_bias = 0;   ///< about z of the world, of the attitude
  double yaw_noise = 0;  ///< white, standard deviation
  /// About the camera's own axes: pitch (x, right), yaw (y, down), roll (z, forward).
  Eigen::Vector3d gimbal_bias = Eigen::Vector3d::Zero();
  Eigen::Vector3d gimbal_noise = Eigen::Vector3d::Zero();
  Eigen::Vector3d lever_arm = Eigen::Vector3d::Zero();  ///< of the antenna, in the camera
  double time_offset = 0;     ///< s (frames without stamps): the pose of that much later is told
  double dropout = 0;         ///< share of the poses that are missing: not registered
  double dropout_length = 1;  ///< mean number of frames of a gap
};

/// Intrinsics that drift. Shares of the focal length, pixels of the principal point.
struct intrinsics_drift {
  std::uint64_t seed = 1;
  double focal_bias = 0;   ///< of all frames
  double focal_noise = 0;  ///< white, standard deviation
  double focal_walk = 0;   ///< standard deviation after a frame
  double centre_noise = 0;
  double centre_walk = 0;
};

namespace detail {

/// Random numbers of one kind of error, by frame: they are the same whatever other errors there
/// are.
class error_source {
 public:
  error_source(std::uint64_t seed, std::uint64_t kind) : seed_(random_bits(seed, kind)) {}

  [[nodiscard]] random_engine at(std::size_t frame) const {
    return random_engine(random_bits(seed_, frame));
  }
  [[nodiscard]] double normal(std::size_t frame) const { return at(frame).normal(); }
  [[nodiscard]] Eigen::Vector3d normals(std::size_t frame) const {
    random_engine random = at(frame);
    const double x = random.normal(), y = random.normal(), z = random.normal();
    return {x, y, z};
  }

 private:
  std::uint64_t seed_;
};

/// The pose at a time between those of a trajectory; that of the nearest end outside.
inline math::rigid3 pose_at(const pose::trajectory& t,
                            const std::vector<double>& times,
                            double time) {
  const auto behind = std::upper_bound(times.begin(), times.end(), time);
  if (behind == times.begin()) return t.world_from_camera.front();
  if (behind == times.end()) return t.world_from_camera.back();
  const auto i = static_cast<std::size_t>(behind - times.begin());
  const math::rigid3 &a = t.world_from_camera[i - 1], &b = t.world_from_camera[i];
  const double share = (time - times[i - 1]) / (times[i] - times[i - 1]);
  const Eigen::Vector3d turn = math::axis_angle_from(b.rotation * a.rotation.transpose());
  const Eigen::Vector3d part = share * turn;
  return {math::rotation_from(part) * a.rotation,
          a.translation + share * (b.translation - a.translation)};
}

/// Which frames a two-state chain drops: gaps of a mean length, a share in all.
inline std::vector<bool> dropped(std::size_t n, const perturb_options& o) {
  const error_source source(o.seed, 5);
  const double end = 1 / std::max(1.0, o.dropout_length);
  const double begin = o.dropout < 1 ? end * o.dropout / (1 - o.dropout) : 1;
  std::vector<bool> is_dropped(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double chance = i == 0 ? o.dropout : is_dropped[i - 1] ? 1 - end : std::min(begin, 1.0);
    is_dropped[i] = o.dropout > 0 && source.at(i).uniform() < chance;
  }
  return is_dropped;
}

}  // namespace detail

/// A trajectory as telemetry would tell it. Names and stamps stay; a pose that drops out is not
/// registered. The same seed gives the same errors of a kind, whatever the others are.
///
/// Throws argument_error where a deviation is negative, the dropout no share, or stamps do not
/// grow.
[[nodiscard]] inline pose::trajectory perturb(const pose::trajectory& truth,
                                              const perturb_options& o) {
  pose::check(truth);
  const bool sane = (o.position_noise.array() >= 0).all() && (o.gimbal_noise.array() >= 0).all() &&
                    o.position_walk >= 0 && o.yaw_noise >= 0 && o.dropout >= 0 && o.dropout <= 1 &&
                    std::isfinite(o.time_offset);
  if (!sane) {
    throw argument_error(
        "survey::perturb: standard deviations from 0, a dropout of 0..1 and a "
        "finite time offset expected");
  }
  const std::size_t n = truth.size();
  std::vector<double> times = truth.stamps_s;
  for (std::size_t i = times.size(); i < n; ++i) times.push_back(static_cast<double>(i));
  if (std::adjacent_find(times.begin(), times.end(), std::greater_equal<>()) != times.end() &&
      o.time_offset != 0)
    throw argument_error("survey::perturb: stamps that grow expected, for a time offset");
  const detail::error_source white(o.seed, 0), walk(o.seed, 1), yaw(o.seed, 2), gimbal(o.seed, 3);
  const std::vector<bool> missing = detail::dropped(n, o);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  pose::trajectory told = truth;
  Eigen::Vector3d walked = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < n; ++i) {
    math::rigid3 p = o.time_offset == 0 ? truth.world_from_camera[i]
                                        : detail::pose_at(truth, times, times[i] + o.time_offset);
    const double since = i == 0 ? 0 : std::abs(times[i] - times[i - 1]);
    walked += o.position_walk * std::sqrt(since) * walk.normals(i);
    const Eigen::Vector3d noise = o.position_noise.cwiseProduct(white.normals(i));
    p.translation += p.rotation * o.lever_arm + o.position_bias + walked + noise;
    const Eigen::Vector3d about_z(0, 0, o.yaw_bias + o.yaw_noise * yaw.normal(i));
    const Eigen::Vector3d own = o.gimbal_bias + o.gimbal_noise.cwiseProduct(gimbal.normals(i));
    p.rotation = math::rotation_from(about_z) * p.rotation * math::rotation_from(own);
    if (missing[i]) p.translation.setConstant(nan);
    told.world_from_camera[i] = p;
  }
  return told;
}

/// Cameras of n frames whose intrinsics drift away from one. Throws argument_error for a camera
/// without focal length, or where a deviation is negative.
[[nodiscard]] inline std::vector<math::camera> perturb_camera(const math::camera& truth,
                                                              std::size_t n,
                                                              const intrinsics_drift& o) {
  if (!(o.focal_noise >= 0 && o.focal_walk >= 0 && o.centre_noise >= 0 && o.centre_walk >= 0))
    throw argument_error("survey::perturb_camera: standard deviations from 0 expected");
  static_cast<void>(truth.cy());  // throws where there is no focal length
  const detail::error_source white(o.seed, 6), walk(o.seed, 7);
  const std::size_t n_focal = math::info(truth.model).n_focal;
  std::vector<math::camera> cameras;
  Eigen::Vector3d walked = Eigen::Vector3d::Zero();
  const Eigen::Vector3d step(o.focal_walk, o.centre_walk, o.centre_walk);
  const Eigen::Vector3d spread(o.focal_noise, o.centre_noise, o.centre_noise);
  for (std::size_t i = 0; i < n; ++i) {
    if (i > 0) walked += step.cwiseProduct(walk.normals(i));
    const Eigen::Vector3d error = walked + spread.cwiseProduct(white.normals(i));
    math::camera c = truth;
    for (std::size_t k = 0; k < n_focal; ++k) c.parameters[k] *= 1 + o.focal_bias + error.x();
    c.parameters[n_focal] += error.y();
    c.parameters[n_focal + 1] += error.z();
    cameras.push_back(c);
  }
  return cameras;
}

}  // namespace aib::survey
