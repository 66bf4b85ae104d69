// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/align/umeyama.hpp>
#include <aib/core/error.hpp>
#include <aib/math/rigid3.hpp>
#include <aib/math/sim3.hpp>

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace aib::align {

/// What an alignment may change.
enum class align_mode {
  sim3,       ///< rotation, translation, scale
  se3,        ///< rotation, translation
  yaw,        ///< the turn about the vertical, translation: both worlds know where down is
  yaw_scale,  ///< the same and scale
  scale,      ///< scale alone, as evo's --correct_scale without --align
  first,      ///< the rigid motion that lays the first pose of the one on that of the other
};

/// Whether a fit turns about the vertical alone.
[[nodiscard]] constexpr bool is_about_vertical(align_mode mode) {
  return mode == align_mode::yaw || mode == align_mode::yaw_scale;
}

[[nodiscard]] constexpr bool has_scale(align_mode mode) {
  return mode == align_mode::sim3 || mode == align_mode::yaw_scale || mode == align_mode::scale;
}

struct fit_options {
  align_mode mode = align_mode::sim3;
  double rotation_weight = 0;  ///< sim3, se3: > 0: orientations count, a radian as this length
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  ///< yaw, yaw_scale: the vertical of both worlds
  rank_rule convention = rank_rule::relative;
};

/// Paired world_from_camera poses, and fits of ref_from_est to some of them.
class pose_fit {
 public:
  /// estimate, reference   as long, finite
  pose_fit(std::span<const math::rigid3> estimate,
           std::span<const math::rigid3> reference,
           const fit_options& options)
      : estimate_(estimate), reference_(reference), options_(options) {}

  /// Throws undefined_error if the chosen poses do not tell the transform.
  [[nodiscard]] math::sim3 operator()(std::span<const std::size_t> chosen) const;

  /// Distance that a transform leaves between the positions of a pose.
  [[nodiscard]] double residual(const math::sim3& ref_from_est, std::size_t i) const {
    return (ref_from_est * estimate_[i].translation - reference_[i].translation).norm();
  }

  /// Square sum of the residuals of the chosen poses.
  [[nodiscard]] double square_sum(const math::sim3& ref_from_est,
                                  std::span<const std::size_t> chosen) const {
    double sum = 0;
    for (const std::size_t i : chosen) {
      const double r = residual(ref_from_est, i);
      sum += r * r;
    }
    return sum;
  }

  [[nodiscard]] std::vector<Eigen::Vector3d> estimate(std::span<const std::size_t> chosen) const {
    return positions(estimate_, chosen);
  }
  [[nodiscard]] std::vector<Eigen::Vector3d> reference(std::span<const std::size_t> chosen) const {
    return positions(reference_, chosen);
  }

 private:
  static std::vector<Eigen::Vector3d> positions(std::span<const math::rigid3> poses,
                                                std::span<const std::size_t> chosen) {
    std::vector<Eigen::Vector3d> out;
    for (const std::size_t i : chosen) out.push_back(poses[i].translation);
    return out;
  }
  [[nodiscard]] math::sim3 with_rotations(std::span<const std::size_t> chosen) const;
  [[nodiscard]] math::sim3 about_vertical(std::span<const std::size_t> chosen) const;

  std::span<const math::rigid3> estimate_, reference_;
  fit_options options_;
};

inline math::sim3 pose_fit::operator()(std::span<const std::size_t> chosen) const {
  if (chosen.empty()) throw undefined_error("align: no pose");
  if (options_.mode == align_mode::first) {
    const math::rigid3 moved = reference_[chosen.front()] * estimate_[chosen.front()].inverse();
    return {1, moved.rotation, moved.translation};
  }
  if (is_about_vertical(options_.mode)) return about_vertical(chosen);
  const bool turns = options_.mode != align_mode::scale;
  if (turns && options_.rotation_weight > 0) return with_rotations(chosen);
  const math::sim3 fitted =
      umeyama(estimate(chosen), reference(chosen),
              {.scale = options_.mode != align_mode::se3, .convention = options_.convention});
  return turns ? fitted : math::sim3{.scale = fitted.scale};
}

/// Minimises sum |y - (s R x + t)|^2 + w^2 |angle(R Rx, Ry)|^2 (chordal), rotation and scale in
/// turns. Orientations tell what positions on a line leave free.
inline math::sim3 pose_fit::with_rotations(std::span<const std::size_t> chosen) const {
  const std::vector<Eigen::Vector3d> x = estimate(chosen), y = reference(chosen);
  const detail::paired_moments m(x, y);
  Eigen::Matrix3d turned = Eigen::Matrix3d::Zero();
  for (const std::size_t i : chosen)
    turned += reference_[i].rotation * estimate_[i].rotation.transpose();
  const double w = options_.rotation_weight;
  turned *= w * w / (2 * static_cast<double>(chosen.size()));
  if (options_.mode == align_mode::se3)
    return m.centred(1, detail::best_rotation(m.covariance + turned).rotation);
  if (const spread s = spread_of(x); !(s.singular_values[0] > s.rounding))
    throw undefined_error("align: the positions of the estimate are all in one place: no scale");
  double scale = 1;
  Eigen::Matrix3d rotation = detail::best_rotation(turned).rotation;
  for (int round = 0; round < 100; ++round) {
    const double before = scale;
    scale = (rotation.transpose() * m.covariance).trace() / m.estimate_variance;
    rotation = detail::best_rotation(scale * m.covariance + turned).rotation;
    if (std::abs(scale - before) <= 1e-15 * std::abs(scale)) break;
  }
  if (!(scale > 0)) {
    throw undefined_error(
        message("align: positions and orientations contradict each other, scale ", scale));
  }
  return m.centred(scale, rotation);
}

/// Source: Zhang and Scaramuzza, "A tutorial on quantitative trajectory evaluation", IROS 2018,
/// Sec. III-C; the scale as in Umeyama, PAMI 1991, Eq. (42).
inline math::sim3 pose_fit::about_vertical(std::span<const std::size_t> chosen) const {
  const Eigen::Vector3d up = options_.up.normalized();
  if (!up.allFinite()) throw argument_error("align: up has no direction");
  const detail::paired_moments m(estimate(chosen), reference(chosen));
  const Eigen::Matrix3d& c = m.covariance;
  // mean of y . R x = cos a tr((I - up up^T) C) + sin a (up . mean of x cross y) + up . C up
  const Eigen::Vector3d cross(c(2, 1) - c(1, 2), c(0, 2) - c(2, 0), c(1, 0) - c(0, 1));
  const double vertical = up.dot(c * up), cosine = c.trace() - vertical, sine = up.dot(cross);
  if (!(std::hypot(cosine, sine) > refused_ratio * c.norm()))
    throw undefined_error("align: the positions leave the turn about the vertical free");
  const Eigen::Vector3d turn = std::atan2(sine, cosine) * up;
  const double scale = options_.mode == align_mode::yaw
                           ? 1
                           : (vertical + std::hypot(cosine, sine)) / m.estimate_variance;
  if (!(scale > 0)) {
    throw undefined_error(
        message("align: heights and the turn contradict each other, scale ", scale));
  }
  return m.centred(scale, math::rotation_from(turn));
}

}  // namespace aib::align
