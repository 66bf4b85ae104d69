// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/depth/depth_map.hpp>
#include <aib/depth/error_sums.hpp>
#include <aib/depth/normals.hpp>
#include <aib/depth/rays.hpp>
#include <aib/math/camera.hpp>
#include <aib/raster/view.hpp>
#include <aib/stats/quantiles.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace aib::depth {

/// What a distance between an estimated point and the reference is.
enum class surface_distance {
  normal,  ///< from the plane of the reference's surface: what a gauge would read
  ray,     ///< along the line of sight
};

struct surface_error_options {
  surface_distance distance = surface_distance::normal;
  std::vector<double> tau = {1, 2, 5};  ///< multiples of the ground sampling distance
  double min = 0;                       ///< a reference counts above it, exclusive
  double max = std::numeric_limits<double>::infinity();  ///< and below it, exclusive
  raster::view<const std::uint8_t> mask = {};            ///< none, or 0 where a pixel is left out
  affine transform = {};                                 ///< of the estimate, see fitter
  normal_options normals = {};
};

/// Statistics of non-negative numbers.
struct spread {
  double mean;
  double median;
  double p95;  ///< 95 % are below it
  double rmse;
  double max;
};

/// How far the estimated surface lies from the reference, over the pixels valid in both.
struct surface_error_summary {
  spread distance;                   ///< in the unit of the maps
  spread gsd;                        ///< the same in ground sampling distances of each pixel
  double mean_gsd;                   ///< the mean ground sampling distance, in the unit of the maps
  std::vector<double> within;        ///< share of these pixels strictly below each tau
  std::vector<double> within_total;  ///< share of the reference's pixels: a hole is a miss
  double coverage;                   ///< valid in both / valid in the reference
  std::uint64_t n_valid;
  std::uint64_t n_reference;
  std::uint64_t n_without_normal;  ///< measured along the ray, at edges and borders
};

/// Errors in the units of an inspection: distances at the surface, and multiples of the ground
/// sampling distance depth / f, the size of a photo's pixel on the object.
///
/// estimate, reference   h x w, planar depth in the unit of the reference
/// camera                of the photo: its own focal length counts, whatever the size of the maps
///
/// An error along the ray shrinks by the cosine of the angle of incidence where the surface is seen
/// at a slant: distance = |e - r| * |n . ray|, n the normal of the reference. Throws
/// undefined_error, with the counts, if no pixel is valid in both; argument_error if sizes differ
/// or the camera has no focal length > 0.
[[nodiscard]] surface_error_summary surface_errors(raster::view<const float> estimate,
                                                   raster::view<const float> reference,
                                                   const math::camera& camera,
                                                   const surface_error_options& options = {});

namespace detail {

inline spread spread_of(std::vector<double>& values) {
  double sum = 0, squares = 0;
  for (const double v : values) {
    sum += v;
    squares += v * v;
  }
  const auto n = static_cast<double>(values.size());
  return {.mean = sum / n,
          .median = stats::quantile_in_place<double>(values, 0.5),
          .p95 = stats::quantile_in_place<double>(values, 0.95),
          .rmse = std::sqrt(squares / n),
          .max = *std::max_element(values.begin(), values.end())};
}

/// Distances of the pixels valid in both maps, and their ground sampling distances.
struct surface_distances {
  std::vector<double> distance;
  std::vector<double> gsd;
  std::uint64_t n_reference = 0;
  std::uint64_t n_without_normal = 0;
};

inline surface_distances measure_surface(raster::view<const float> estimate,
                                         raster::view<const float> reference,
                                         const math::camera& camera,
                                         const surface_error_options& o) {
  const ray_image ray = rays(camera, reference.width, reference.height);
  const bool slanted = o.distance == surface_distance::normal;
  const normal_image normal = slanted ? normals(reference, ray, o.normals) : normal_image();
  const double focal = (camera.fx() + camera.fy()) / 2;
  if (!(focal > 0 && std::isfinite(focal))) {
    throw argument_error(
        message("depth::surface_errors: a focal length > 0 expected, found ", focal));
  }
  surface_distances found;
  for (std::size_t y = 0; y < reference.height; ++y) {
    for (std::size_t x = 0; x < reference.width; ++x) {
      const auto r = static_cast<double>(reference(x, y)),
                 raw = static_cast<double>(estimate(x, y));
      if ((o.mask.data && o.mask(x, y) == 0) || !(r > o.min && r < o.max)) continue;
      ++found.n_reference;
      const double e = o.transform.scale * raw + o.transform.shift;
      if (!is_valid(raw) || !is_valid(e)) continue;
      const Eigen::Vector3d direction = point_at(ray(x, y), 1);
      const bool has_normal = slanted && !normal(x, y).isZero(0);
      const double per_depth =
          has_normal ? std::abs(normal(x, y).cast<double>().dot(direction)) : direction.norm();
      if (std::isnan(per_depth)) continue;
      if (slanted && !has_normal) ++found.n_without_normal;
      found.distance.push_back(std::abs(e - r) * per_depth);
      found.gsd.push_back(r / focal);
    }
  }
  return found;
}

}  // namespace detail

inline surface_error_summary surface_errors(raster::view<const float> estimate,
                                            raster::view<const float> reference,
                                            const math::camera& camera,
                                            const surface_error_options& options) {
  check_sizes("depth::surface_errors", estimate, reference, options.mask);
  auto found = detail::measure_surface(estimate, reference, camera, options);
  if (found.distance.empty()) {
    throw undefined_error(message("depth::surface_errors: no pixel is valid in both maps, ",
                                  found.n_reference, " are in the reference"));
  }
  const auto n = static_cast<double>(found.distance.size());
  surface_error_summary result{};
  std::vector<double> multiples(found.distance.size());
  for (std::size_t i = 0; i < multiples.size(); ++i) {
    result.mean_gsd += found.gsd[i] / n;
    multiples[i] = found.distance[i] / found.gsd[i];
  }
  for (const double tau : options.tau) {
    const auto below = static_cast<double>(std::count_if(
        multiples.begin(), multiples.end(), [tau](double multiple) { return multiple < tau; }));
    result.within.push_back(below / n);
    result.within_total.push_back(below / static_cast<double>(found.n_reference));
  }
  result.distance = detail::spread_of(found.distance);
  result.gsd = detail::spread_of(multiples);
  result.coverage = n / static_cast<double>(found.n_reference);
  result.n_valid = multiples.size();
  result.n_reference = found.n_reference;
  result.n_without_normal = found.n_without_normal;
  return result;
}

}  // namespace aib::depth
