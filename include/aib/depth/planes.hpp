// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/depth/depth_map.hpp>
#include <aib/depth/error_sums.hpp>
#include <aib/depth/normals.hpp>
#include <aib/depth/rays.hpp>
#include <aib/raster/view.hpp>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numbers>
#include <optional>
#include <vector>

namespace aib::depth {

/// How an estimate shows what is a plane in the reference.
struct plane_errors_summary {
  double flatness;     ///< rms distance of the estimate's points from their own best plane
  double orientation;  ///< angle between the best planes of both maps, radians
  double
      offset;  ///< signed distance of the estimate's centroid from the reference's plane, away > 0
  double reference_flatness;  ///< flatness of the reference: not far above it is as good as it gets
  std::uint64_t n_valid;      ///< pixels valid in both maps
};

/// Planarity and orientation errors of walls, decks and panels, one plane a label; 0 is no plane.
/// Both planes are fitted to the pixels valid in both maps, by least squares of distances. A label
/// with fewer than three such pixels, or with all of them in a row of the image, is left out.
///
/// The estimate is taken as it is: iBims-1 scales it by the median of each plane first, for which
/// fit it (alignment::median) with the plane as mask.
/// Throws argument_error if the sizes differ.
/// Source: Koch et al., "Evaluation of CNN-based single-image depth estimation methods", ECCV 2018.
[[nodiscard]] std::map<std::uint16_t, plane_errors_summary> plane_errors(
    raster::view<const float> estimate,
    raster::view<const float> reference,
    const ray_image& rays,
    raster::view<const std::uint16_t> planes);

namespace detail {

struct fitted_plane {
  Eigen::Vector3d centroid;
  Eigen::Vector3d normal;  ///< away from the camera
  double flatness;
};

/// Nothing where the points lie on a line.
inline std::optional<fitted_plane> fit_plane(const std::vector<Eigen::Vector3d>& points) {
  if (points.size() < 3) return std::nullopt;
  const auto n = static_cast<double>(points.size());
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
  for (const auto& p : points) centroid += p / n;
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const auto& p : points) scatter += (p - centroid) * (p - centroid).transpose() / n;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(scatter);
  constexpr double least_share = 1e-12;
  if (!(axes.eigenvalues()[1] > least_share * axes.eigenvalues()[2])) return std::nullopt;
  const Eigen::Vector3d normal = axes.eigenvectors().col(0);
  return fitted_plane{centroid, normal.dot(centroid) < 0 ? Eigen::Vector3d(-normal) : normal,
                      std::sqrt(std::max(0.0, axes.eigenvalues()[0]))};
}

}  // namespace detail

inline std::map<std::uint16_t, plane_errors_summary> plane_errors(
    raster::view<const float> estimate,
    raster::view<const float> reference,
    const ray_image& rays,
    raster::view<const std::uint16_t> planes) {
  check_sizes("depth::plane_errors", estimate, reference);
  check_size("depth::plane_errors", estimate, "rays", rays.view());
  check_size("depth::plane_errors", estimate, "label image", planes);
  struct point_pairs {
    std::vector<Eigen::Vector3d> sight, estimate, reference;
  };
  std::map<std::uint16_t, point_pairs> by_label;
  for (std::size_t y = 0; y < estimate.height; ++y) {
    for (std::size_t x = 0; x < estimate.width; ++x) {
      const bool counts = planes(x, y) != 0 && is_valid(estimate(x, y)) &&
                          is_valid(reference(x, y)) && !std::isnan(rays(x, y).x());
      if (!counts) continue;
      point_pairs& pairs = by_label[planes(x, y)];
      pairs.sight.push_back(point_at(rays(x, y), 1));
      pairs.estimate.push_back(point_at(rays(x, y), static_cast<double>(estimate(x, y))));
      pairs.reference.push_back(point_at(rays(x, y), static_cast<double>(reference(x, y))));
    }
  }
  std::map<std::uint16_t, plane_errors_summary> result;
  for (const auto& [label, pairs] : by_label) {
    // Points of a row span the plane of their sight lines, by the rounding of their depths alone.
    const bool in_a_row = !detail::fit_plane(pairs.sight);
    const auto e = detail::fit_plane(pairs.estimate), r = detail::fit_plane(pairs.reference);
    if (in_a_row || !e || !r) continue;
    const double angle = angle_between(e->normal, r->normal);
    result[label] = {.flatness = e->flatness,
                     .orientation = std::min(angle, std::numbers::pi - angle),
                     .offset = r->normal.dot(e->centroid - r->centroid),
                     .reference_flatness = r->flatness,
                     .n_valid = pairs.estimate.size()};
  }
  return result;
}

}  // namespace aib::depth
