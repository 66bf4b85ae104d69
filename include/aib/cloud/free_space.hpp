// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/cloud.hpp>
#include <aib/cloud/neighbours.hpp>
#include <aib/cloud/positions.hpp>
#include <aib/cloud/voxel_shares.hpp>
#include <aib/core/error.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>
#include <utility>

namespace aib::cloud {

/// Points that a laser scanner saw from one place.
struct laser_scan {
  cloud points;             ///< in the world
  Eigen::Vector3d scanner;  ///< where it stood in the world
};

/// The cone of a laser beam.
struct laser_beam {
  double start_radius = 0.001125;                        ///< at the scanner, unit of the clouds
  double half_angle = 0.011 * std::numbers::pi / 180.0;  ///< radians

  [[nodiscard]] double radius_at(double distance) const {
    return start_radius + distance * std::tan(half_angle);
  }
};

/// The beams of one scan, to be asked what they say of a point: a beam that passes it on the way to
/// a surface behind it has seen that there is nothing.
class scanned_space {
 public:
  /// Throws undefined_error if no scan point is finite and away from the scanner.
  scanned_space(const laser_scan& scan, const laser_beam& beam)
      : scan_(scan), beam_(beam), directions_(directions_of(scan)), index_(directions_) {}

  /// The verdict of the beams that p lies in: good from the first tolerance on within which their
  /// scan points lie, observed where p is before one of them.
  ///
  /// tolerances   ascending; a distance of exactly a tolerance is within it
  [[nodiscard]] verdict of(const Eigen::Vector3d& p, std::span<const double> tolerances) const {
    const Eigen::Vector3d to_point = p - scan_.scanner;
    const double range = to_point.norm();
    const double beam_radius = beam_.radius_at(range);
    verdict v{static_cast<std::uint32_t>(tolerances.size()), false};
    index_.for_each_within(
        to_point / std::max(range, 1e-300), reach(beam_radius, range), [&](std::size_t i) {
          const Eigen::Vector3d to_scan = scan_.points.position(i) - scan_.scanner;
          const double scan_range = to_scan.norm();
          const double along = to_scan.dot(to_point) / scan_range;
          const Eigen::Vector3d beside = to_point - along / scan_range * to_scan;
          if (along < 0 || beside.norm() > beam_radius) return;
          const double distance = (to_scan - to_point).norm();
          const auto within = std::lower_bound(tolerances.begin(), tolerances.end(), distance);
          v.first_good =
              std::min(v.first_good, static_cast<std::uint32_t>(within - tolerances.begin()));
          v.observed = v.observed || along < scan_range;
        });
    return v;
  }

 private:
  /// The directions of the scan points as points on the unit sphere; NaN where there is none.
  static cloud directions_of(const laser_scan& scan) {
    cloud directions;
    std::size_t n = 0;
    for (std::size_t i = 0; i < scan.points.size(); ++i) {
      const Eigen::Vector3d to_scan = scan.points.position(i) - scan.scanner;
      const Eigen::Vector3d direction = to_scan / to_scan.norm();
      directions.points.push_back(direction.cast<float>());
      n += direction.allFinite();
    }
    if (n == 0) {
      throw undefined_error(
          message("cloud::scanned_space: no beam in a scan of ", scan.points.size(), " points"));
    }
    return directions;
  }

  /// How far, on the unit sphere, the direction of a beam around a point can be from the point's,
  /// and a little more for the rounding of directions.
  static double reach(double beam_radius, double range) {
    constexpr double rounding = 1e-6;
    if (beam_radius >= range) return 2 + rounding;
    return 2 * std::sin(std::asin(beam_radius / range) / 2) + rounding;
  }

  const laser_scan& scan_;
  laser_beam beam_;
  cloud directions_;
  neighbours index_;
};

}  // namespace aib::cloud
