// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/math/camera.hpp>

#include <Eigen/Core>
#include <Eigen/LU>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <span>

namespace aib::math {

/// Pixel of a point, of every camera model; nothing where the model has none: behind a perspective
/// camera, beyond the range of a division model or of EUCM, at the centre.
///
/// p_in_camera   x right, y down, z forward, any unit
///
/// Throws argument_error if the camera has another number of parameters than its model.
/// Source: COLMAP 4.2, src/colmap/sensor/models.h; FOV: Devernay and Faugeras 2001; division:
/// Fitzgibbon, CVPR 2001; EUCM: Khomutenko, Garcia, Martinet, RA-L 2016.
std::optional<Eigen::Vector2d> project(const camera& camera, const Eigen::Vector3d& p_in_camera);

/// Direction in the camera, unit length, of the points that project to a pixel; nothing where no
/// point does. The inverse of `project` to 1e-9 pixels within the range where the distortion grows.
///
/// Throws argument_error if the camera has another number of parameters than its model.
std::optional<Eigen::Vector3d> unproject(const camera& camera, const Eigen::Vector2d& pixel);

namespace detail {

using point2 = Eigen::Vector2d;

/// Parameters behind focal length and principal point. Throws argument_error if they are too few or
/// too many.
inline std::span<const double> distortion_parameters(const camera& c) {
  const camera_model_info& model = info(c.model);
  if (c.parameters.size() != model.n_parameters) {
    throw argument_error(message("camera: ", model.name, " expects ", model.n_parameters,
                                 " parameters, found ", c.parameters.size()));
  }
  return std::span(c.parameters).subspan(model.n_focal == 0 ? 2 : model.n_focal + 2);
}

/// How a direction becomes a point of the plane that is distorted.
enum class image_plane { perspective, equidistant, other };

constexpr image_plane plane_of(camera_model model) {
  switch (model) {
    case camera_model::simple_pinhole:
    case camera_model::pinhole:
    case camera_model::simple_radial:
    case camera_model::radial:
    case camera_model::opencv:
    case camera_model::full_opencv:
    case camera_model::fov:
      return image_plane::perspective;
    case camera_model::opencv_fisheye:
    case camera_model::simple_radial_fisheye:
    case camera_model::radial_fisheye:
    case camera_model::thin_prism_fisheye:
    case camera_model::rad_tan_thin_prism_fisheye:
    case camera_model::simple_fisheye:
    case camera_model::fisheye:
      return image_plane::equidistant;
    default:
      return image_plane::other;
  }
}

/// 1 + k[0] r2 + k[1] r2^2 + ...
inline double radial(std::span<const double> k, double r2) {
  double sum = 0;
  for (std::size_t i = k.size(); i > 0; --i) sum = (sum + k[i - 1]) * r2;
  return 1 + sum;
}

/// Decentring of Brown: p1 is the weight of the y axis, p2 of the x axis.
inline point2 decentred(const point2& p, double p1, double p2) {
  const double xy = 2 * p.x() * p.y(), r2 = p.squaredNorm();
  return {p1 * xy + p2 * (r2 + 2 * p.x() * p.x()), p2 * xy + p1 * (r2 + 2 * p.y() * p.y())};
}

inline point2 distort_full_opencv(std::span<const double> k, const point2& p) {
  const double numerator[] = {k[0], k[1], k[4]}, r2 = p.squaredNorm();
  return p * (radial(numerator, r2) / radial(k.subspan(5, 3), r2)) + decentred(p, k[2], k[3]);
}

inline point2 distort_fov(double omega, const point2& p) {
  const double r = p.norm();
  if (omega == 0) return p;
  const double slope = 2 * std::tan(omega / 2);
  return p * (r < 1e-12 ? slope / omega : std::atan(r * slope) / (r * omega));
}

inline point2 distort_thin_prism(std::span<const double> k, const point2& p) {
  const double radii[] = {k[0], k[1], k[4], k[5]}, r2 = p.squaredNorm();
  return p * radial(radii, r2) + decentred(p, k[2], k[3]) + r2 * point2(k[6], k[7]);
}

inline point2 distort_rad_tan_thin_prism(std::span<const double> k, const point2& p) {
  const point2 q = p * radial(k.first(6), p.squaredNorm());
  const double r2 = q.squaredNorm();
  return q + decentred(q, k[7], k[6]) +
         point2(k[8] * r2 + k[9] * r2 * r2, k[10] * r2 + k[11] * r2 * r2);
}

/// Distorted point of the image plane of a model that has one.
inline point2 distort(camera_model model, std::span<const double> k, const point2& p) {
  switch (model) {
    case camera_model::simple_radial:
    case camera_model::radial:
    case camera_model::simple_radial_fisheye:
    case camera_model::radial_fisheye:
    case camera_model::opencv_fisheye:
      return p * radial(k, p.squaredNorm());
    case camera_model::opencv:
      return p * radial(k.first(2), p.squaredNorm()) + decentred(p, k[2], k[3]);
    case camera_model::full_opencv:
      return distort_full_opencv(k, p);
    case camera_model::fov:
      return distort_fov(k[0], p);
    case camera_model::thin_prism_fisheye:
      return distort_thin_prism(k, p);
    case camera_model::rad_tan_thin_prism_fisheye:
      return distort_rad_tan_thin_prism(k, p);
    default:
      return p;
  }
}

inline Eigen::Matrix2d distortion_slope(camera_model model,
                                        std::span<const double> k,
                                        const point2& p) {
  constexpr double step = 1e-6;
  Eigen::Matrix2d slope;
  for (int axis = 0; axis < 2; ++axis) {
    const point2 aside = step * point2::Unit(axis);
    slope.col(axis) = (distort(model, k, p + aside) - distort(model, k, p - aside)) / (2 * step);
  }
  return slope;
}

/// The point that `distort` takes to `goal`, by Newton's method from there. Nothing where the steps
/// end beyond the range in which the distortion grows.
inline std::optional<point2> undistort(camera_model model,
                                       std::span<const double> k,
                                       const point2& goal) {
  point2 p = goal;
  for (int round = 0; round < 50; ++round) {
    const point2 miss = distort(model, k, p) - goal;
    if (!miss.allFinite()) return std::nullopt;
    if (miss.norm() <= 1e-15 * (1 + goal.norm())) break;
    p -= distortion_slope(model, k, p).inverse() * miss;
  }
  const bool there = (distort(model, k, p) - goal).norm() <= 1e-13 * (1 + goal.norm());
  const bool this_side = p.dot(goal) > 0 || goal.norm() < 1e-2;
  if (!there || !this_side || !(distortion_slope(model, k, p).determinant() > 0))
    return std::nullopt;
  return p;
}

inline std::optional<point2> on_plane(image_plane plane, const Eigen::Vector3d& p) {
  if (plane == image_plane::perspective) {
    if (!(p.z() > 0)) return std::nullopt;
    return point2(p.head<2>() / p.z());
  }
  const double r = p.head<2>().norm();
  if (r == 0) return p.z() > 0 ? std::optional(point2(0, 0)) : std::nullopt;
  return point2(p.head<2>() * (std::atan2(r, p.z()) / r));
}

inline std::optional<Eigen::Vector3d> off_plane(image_plane plane, const point2& p) {
  if (plane == image_plane::perspective) return Eigen::Vector3d(p.x(), p.y(), 1).normalized();
  const double angle = p.norm();
  if (angle > std::numbers::pi) return std::nullopt;
  const double share = angle == 0 ? 1 : std::sin(angle) / angle;
  return Eigen::Vector3d(share * p.x(), share * p.y(), std::cos(angle));
}

/// The undistorted point of a division model is (x, y, 1 + k r^2).
inline std::optional<point2> project_division(double k, const Eigen::Vector3d& p) {
  const double r2 = p.head<2>().squaredNorm();
  // (x, y) s with s z = 1 + k r2 s^2: the root that is 1 / z without distortion.
  const double root = p.z() * p.z() - 4 * k * r2;
  if (!(root >= 0)) return std::nullopt;
  const double denominator = p.z() + std::sqrt(root);
  if (!(denominator > 0)) return std::nullopt;
  return point2(p.head<2>() * (2 / denominator));
}

inline std::optional<point2> project_eucm(double alpha, double beta, const Eigen::Vector3d& p) {
  const double d = std::sqrt(beta * p.head<2>().squaredNorm() + p.z() * p.z());
  const double w = alpha > 0.5 ? (1 - alpha) / alpha : alpha / (1 - alpha);
  const double denominator = alpha * d + (1 - alpha) * p.z();
  if (!(p.z() > -w * d) || !(denominator > 0)) return std::nullopt;
  return point2(p.head<2>() / denominator);
}

inline std::optional<Eigen::Vector3d> unproject_eucm(double alpha, double beta, const point2& p) {
  const double r2 = p.squaredNorm();
  const double root = 1 - (2 * alpha - 1) * beta * r2;
  if (!(root >= 0)) return std::nullopt;
  const double z = (1 - beta * alpha * alpha * r2) / (alpha * std::sqrt(root) + 1 - alpha);
  return Eigen::Vector3d(p.x(), p.y(), z).normalized();
}

/// Longitude to the right and latitude downwards over the whole image.
inline std::optional<point2> project_sphere(double width, double height, const Eigen::Vector3d& p) {
  if (p.squaredNorm() == 0) return std::nullopt;
  const double longitude = std::atan2(p.x(), p.z());
  const double latitude = std::atan2(p.y(), std::hypot(p.x(), p.z()));
  return point2((longitude / (2 * std::numbers::pi) + 0.5) * width,
                (latitude / std::numbers::pi + 0.5) * height);
}

inline Eigen::Vector3d unproject_sphere(double width, double height, const point2& pixel) {
  const double longitude = 2 * std::numbers::pi * (pixel.x() / width - 0.5);
  const double latitude = std::numbers::pi * (pixel.y() / height - 0.5);
  return {std::cos(latitude) * std::sin(longitude), std::sin(latitude),
          std::cos(latitude) * std::cos(longitude)};
}

}  // namespace detail

inline std::optional<Eigen::Vector2d> project(const camera& camera,
                                              const Eigen::Vector3d& p_in_camera) {
  const std::span<const double> k = detail::distortion_parameters(camera);
  if (!p_in_camera.allFinite()) return std::nullopt;
  std::optional<detail::point2> p;
  switch (camera.model) {
    case camera_model::equirectangular:
      return detail::project_sphere(camera.parameters[0], camera.parameters[1], p_in_camera);
    case camera_model::simple_division:
    case camera_model::division:
      p = detail::project_division(k[0], p_in_camera);
      break;
    case camera_model::eucm:
      p = detail::project_eucm(k[0], k[1], p_in_camera);
      break;
    default:
      p = detail::on_plane(detail::plane_of(camera.model), p_in_camera);
      if (p) p = detail::distort(camera.model, k, *p);
  }
  if (!p) return std::nullopt;
  return Eigen::Vector2d(camera.fx() * p->x() + camera.cx(), camera.fy() * p->y() + camera.cy());
}

inline std::optional<Eigen::Vector3d> unproject(const camera& camera,
                                                const Eigen::Vector2d& pixel) {
  const std::span<const double> k = detail::distortion_parameters(camera);
  if (!pixel.allFinite()) return std::nullopt;
  if (camera.model == camera_model::equirectangular)
    return detail::unproject_sphere(camera.parameters[0], camera.parameters[1], pixel);
  const detail::point2 p((pixel.x() - camera.cx()) / camera.fx(),
                         (pixel.y() - camera.cy()) / camera.fy());
  switch (camera.model) {
    case camera_model::simple_division:
    case camera_model::division:
      return Eigen::Vector3d(p.x(), p.y(), 1 + k[0] * p.squaredNorm()).normalized();
    case camera_model::eucm:
      return detail::unproject_eucm(k[0], k[1], p);
    default: {
      const auto undistorted = detail::undistort(camera.model, k, p);
      if (!undistorted) return std::nullopt;
      return detail::off_plane(detail::plane_of(camera.model), *undistorted);
    }
  }
}

}  // namespace aib::math
