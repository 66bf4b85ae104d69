// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/math/camera.hpp>
#include <aib/math/projection.hpp>
#include <aib/pose/focal.hpp>
#include <aib/stats/moments.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace aib::pose {

/// Differences of two cameras, in pixels of the reference's image.
struct reprojection_difference_result {
  double mean;  ///< over the image plane
  double max;
  std::uint64_t n;       ///< pixels of the grid that both cameras see
  std::uint64_t n_lost;  ///< pixels whose ray one of them does not have
};

/// How far apart two cameras show the same direction: rays through a grid of the reference's image,
/// projected by the estimate, whose pixels are rescaled to the reference's size. Compares any two
/// models.
///
/// cells   of the grid along the longer side; their centres are taken
///
/// Throws argument_error if a size is unknown, undefined_error if no ray is seen by both.
inline reprojection_difference_result reprojection_difference(const math::camera& estimate,
                                                              const math::camera& reference,
                                                              std::size_t cells = 32) {
  if (std::min({estimate.width, estimate.height, reference.width, reference.height}) == 0 ||
      cells == 0)
    throw argument_error("reprojection_difference: image sizes and a grid expected");
  const auto width = static_cast<double>(reference.width);
  const auto height = static_cast<double>(reference.height);
  const Eigen::Array2d rescale(width / static_cast<double>(estimate.width),
                               height / static_cast<double>(estimate.height));
  const double cell = std::max(width, height) / static_cast<double>(cells);
  const auto columns = static_cast<std::size_t>(std::max(1.0, std::round(width / cell)));
  const auto rows = static_cast<std::size_t>(std::max(1.0, std::round(height / cell)));
  stats::moments differences;
  std::uint64_t lost = 0;
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t column = 0; column < columns; ++column) {
      const Eigen::Vector2d pixel(
          (static_cast<double>(column) + 0.5) * width / static_cast<double>(columns),
          (static_cast<double>(row) + 0.5) * height / static_cast<double>(rows));
      const auto ray = unproject(reference, pixel);
      const auto seen = ray ? project(estimate, *ray) : std::nullopt;
      if (seen)
        differences.add((seen->array() * rescale - pixel.array()).matrix().norm());
      else
        ++lost;
    }
  }
  if (differences.count() == 0) {
    throw undefined_error(
        message("reprojection_difference: none of ", lost, " rays is seen by both cameras"));
  }
  return {differences.mean(), differences.max(), differences.count(), lost};
}

struct intrinsics_error_result {
  focal_error_result focal;
  double principal_point_px;  ///< mean distance of the principal points, at the reference's size
  double focal_spread;        ///< standard deviation of the estimated focal length over its mean
  double reprojection_px;     ///< mean reprojection_difference
  double reprojection_max_px;
};

/// Intrinsics of views against those of the reference, all at the reference's image size.
/// Throws undefined_error if there is no view, argument_error where a model has no focal length or
/// an image no size.
inline intrinsics_error_result intrinsics_error(std::span<const camera_pair> views) {
  intrinsics_error_result out{focal_error(views), 0, 0, 0, 0};
  stats::moments point, focal, reprojection;
  reprojection_difference_result d{};
  const camera_pair* before = nullptr;
  for (const camera_pair& view : views) {
    const math::camera &e = view.estimate, &r = view.reference;
    if (!before || !same_camera(before->estimate, e) || !same_camera(before->reference, r))
      d = reprojection_difference(e, r);
    before = &view;
    const double sx = static_cast<double>(r.width) / static_cast<double>(e.width);
    const double sy = static_cast<double>(r.height) / static_cast<double>(e.height);
    point.add(std::hypot(e.cx() * sx - r.cx(), e.cy() * sy - r.cy()));
    focal.add(focal_at_size(e, r.width, r.height));
    reprojection.add(d.mean);
    out.reprojection_max_px = std::max(out.reprojection_max_px, d.max);
  }
  out.principal_point_px = point.mean();
  out.focal_spread = focal.deviation() / focal.mean();
  out.reprojection_px = reprojection.mean();
  return out;
}

}  // namespace aib::pose
