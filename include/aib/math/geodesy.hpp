// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/math/rotation.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cmath>

namespace aib::math {

/// A place on the WGS84 ellipsoid.
struct geodetic {
  double latitude = 0;   ///< radians, north
  double longitude = 0;  ///< radians, east
  double altitude = 0;   ///< m above the ellipsoid
};

/// Axes and origin of WGS84. Source: NIMA TR8350.2, 2000.
struct wgs84 {
  static constexpr double major = 6378137.0;
  static constexpr double flattening = 1 / 298.257223563;
  static constexpr double eccentricity2 = flattening * (2 - flattening);
};

/// Earth-centred coordinates in metres.
[[nodiscard]] inline Eigen::Vector3d earth_from(const geodetic& g) {
  const double sine = std::sin(g.latitude), cosine = std::cos(g.latitude);
  const double n = wgs84::major / std::sqrt(1 - wgs84::eccentricity2 * sine * sine);
  return {(n + g.altitude) * cosine * std::cos(g.longitude),
          (n + g.altitude) * cosine * std::sin(g.longitude),
          (n * (1 - wgs84::eccentricity2) + g.altitude) * sine};
}

/// The place of earth-centred coordinates, to a nanometre within 100 km of the surface.
[[nodiscard]] inline geodetic geodetic_from(const Eigen::Vector3d& p) {
  constexpr double e2 = wgs84::eccentricity2;
  const double across = std::hypot(p.x(), p.y());
  double latitude = std::atan2(p.z(), across * (1 - e2)), n = wgs84::major;
  for (int round = 0; round < 8; ++round) {
    const double sine = std::sin(latitude);
    n = wgs84::major / std::sqrt(1 - e2 * sine * sine);
    latitude = std::atan2(p.z() + e2 * n * sine, across);
  }
  const double sine = std::sin(latitude), cosine = std::cos(latitude);
  const double altitude = across * cosine + p.z() * sine - wgs84::major * wgs84::major / n;
  return {latitude, std::atan2(p.y(), p.x()), altitude};
}

/// The place of a point in the tangent frame of an origin: x east, y north, z up, metres.
[[nodiscard]] inline geodetic geodetic_from_local(const Eigen::Vector3d& east_north_up,
                                                  const geodetic& origin) {
  const double sin_lat = std::sin(origin.latitude), cos_lat = std::cos(origin.latitude);
  const double sin_lon = std::sin(origin.longitude), cos_lon = std::cos(origin.longitude);
  Eigen::Matrix3d earth_from_local;
  earth_from_local << -sin_lon, -sin_lat * cos_lon, cos_lat * cos_lon,  //
      cos_lon, -sin_lat * sin_lon, cos_lat * sin_lon,                   //
      0, cos_lat, sin_lat;
  return geodetic_from(earth_from(origin) + earth_from_local * east_north_up);
}

}  // namespace aib::math
