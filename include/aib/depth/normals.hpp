// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/depth/depth_map.hpp>
#include <aib/depth/error_sums.hpp>
#include <aib/depth/rays.hpp>
#include <aib/raster/image.hpp>
#include <aib/raster/view.hpp>
#include <aib/stats/quantiles.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

namespace aib::depth {

/// Unit vectors in the camera that point towards it; 0 where there is none.
using normal_image = raster::image<Eigen::Vector3f>;

struct normal_options {
  double max_jump = 0.05;  ///< neighbours whose depths differ by a larger share lie on two surfaces
};

/// Normals of the surface that a depth map shows: the cross product of the differences between the
/// points left and right, above and below. A pixel has one where it and these four are valid and on
/// one surface.
///
/// depth   h x w, planar
/// rays    h x w, see `rays`
///
/// Throws argument_error if the sizes differ.
[[nodiscard]] normal_image normals(raster::view<const float> depth,
                                   const ray_image& rays,
                                   const normal_options& options = {});

struct normal_error_options {
  normal_options normals = {};
  raster::view<const std::uint8_t> mask = {};  ///< none, or 0 where a pixel is left out
  /// Angles in radians; by default 11.25, 22.5 and 30 degrees.
  std::vector<double> tau = {std::numbers::pi / 16, std::numbers::pi / 8, std::numbers::pi / 6};
};

/// Angles between the normals of estimate and reference, in radians, over the pixels where both
/// have one.
struct normal_errors_summary {
  double mean;
  double median;
  double rmse;
  std::vector<double> below;  ///< share with an angle strictly below each tau
  std::uint64_t n_valid;      ///< pixels with both normals
  std::uint64_t n_reference;  ///< with one in the reference
};

/// Errors of the surface orientation. A scale common to the estimate does not matter.
/// Throws undefined_error if no pixel has both normals, argument_error if sizes differ.
/// Source: Fouhey, Gupta, Hebert, "Data-driven 3D primitives for single image understanding",
/// ICCV 2013 (mean, median, rmse, thresholds).
[[nodiscard]] normal_errors_summary normal_errors(raster::view<const float> estimate,
                                                  raster::view<const float> reference,
                                                  const ray_image& rays,
                                                  const normal_error_options& options = {});

/// The angle between two vectors, in [0, pi]; exact near 0 and pi too.
[[nodiscard]] inline double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

namespace detail {

inline Eigen::Vector3f normal_at(raster::view<const float> depth,
                                 const ray_image& rays,
                                 std::size_t x,
                                 std::size_t y,
                                 double max_jump) {
  const auto here = static_cast<double>(depth(x, y));
  bool complete = is_valid(here);
  const auto point = [&](std::size_t at_x, std::size_t at_y) -> Eigen::Vector3d {
    const auto there = static_cast<double>(depth(at_x, at_y));
    const bool same_surface =
        is_valid(there) && std::max(here, there) <= (1 + max_jump) * std::min(here, there);
    complete = complete && same_surface;
    return point_at(rays(at_x, at_y), there);
  };
  const Eigen::Vector3d across = point(x + 1, y) - point(x - 1, y);
  const Eigen::Vector3d down = point(x, y + 1) - point(x, y - 1);
  const Eigen::Vector3d normal = down.cross(across);
  const double length = normal.norm();
  if (!complete || !(length > 0)) return Eigen::Vector3f::Zero();
  const double towards = normal.dot(point_at(rays(x, y), 1)) < 0 ? 1 : -1;
  return (towards / length * normal).cast<float>();
}

}  // namespace detail

inline normal_image normals(raster::view<const float> depth,
                            const ray_image& rays,
                            const normal_options& options) {
  check_size("depth::normals", depth, "rays", rays.view());
  normal_image image(depth.width, depth.height, Eigen::Vector3f::Zero());
  for (std::size_t y = 1; y + 1 < depth.height; ++y)
    for (std::size_t x = 1; x + 1 < depth.width; ++x)
      image(x, y) = detail::normal_at(depth, rays, x, y, options.max_jump);
  return image;
}

inline normal_errors_summary normal_errors(raster::view<const float> estimate,
                                           raster::view<const float> reference,
                                           const ray_image& rays,
                                           const normal_error_options& options) {
  check_sizes("depth::normal_errors", estimate, reference, options.mask);
  const normal_image of_estimate = normals(estimate, rays, options.normals);
  const normal_image of_reference = normals(reference, rays, options.normals);
  normal_errors_summary result{};
  std::vector<double> angles;
  double sum = 0, squares = 0;
  for (std::size_t y = 0; y < estimate.height; ++y) {
    for (std::size_t x = 0; x < estimate.width; ++x) {
      const bool inside = !options.mask.data || options.mask(x, y) != 0;
      if (!inside || of_reference(x, y).isZero(0)) continue;
      ++result.n_reference;
      if (of_estimate(x, y).isZero(0)) continue;
      const double angle =
          angle_between(of_estimate(x, y).cast<double>(), of_reference(x, y).cast<double>());
      angles.push_back(angle);
      sum += angle;
      squares += angle * angle;
    }
  }
  if (angles.empty()) {
    throw undefined_error(message("depth::normal_errors: no pixel has a normal in both maps, ",
                                  result.n_reference, " have one in the reference"));
  }
  const auto n = static_cast<double>(angles.size());
  result.mean = sum / n;
  result.rmse = std::sqrt(squares / n);
  for (const double tau : options.tau) {
    const auto below =
        std::count_if(angles.begin(), angles.end(), [tau](double angle) { return angle < tau; });
    result.below.push_back(static_cast<double>(below) / n);
  }
  result.median = stats::quantile_in_place<double>(angles, 0.5);
  result.n_valid = angles.size();
  return result;
}

}  // namespace aib::depth
