// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/survey/flight_path.hpp>
#include <aib/survey/footprint.hpp>
#include <aib/survey/lens.hpp>

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

namespace aib::survey {

/// Edges of a footprint that are flown along, from `first` to `last`; edge i goes from corner i to
/// the next.
struct side_range {
  std::size_t first, last;
};

struct facade_options {
  path_options path = {};
  std::optional<side_range> sides = {};  ///< all of them, closed, where none is told
};

/// Rows round a building, flown to and fro from the lowest up (a serpentine): along the walls at
/// the stand-off, in arcs round the corners, looking along the inward normal, which turns without a
/// jump. The frames of the rows cover the footprint's heights.
///
/// Throws argument_error where the footprint is not convex or an option is out of its range.
[[nodiscard]] flight_path facade(const footprint& plan, const facade_options& options);

namespace detail {

/// Unit vector along an edge, level.
inline Eigen::Vector3d along_edge(const std::vector<Eigen::Vector2d>& corners, std::size_t i) {
  const Eigen::Vector2d d = (corners[(i + 1) % corners.size()] - corners[i]).normalized();
  return {d.x(), d.y(), 0};
}

/// One row at height 0, the way round.
inline std::vector<leg> ring(const std::vector<Eigen::Vector2d>& corners,
                             const side_range& sides,
                             const path_options& options) {
  const std::size_t n = corners.size();
  const std::size_t n_sides = (sides.last + n - sides.first) % n + 1;
  std::vector<leg> legs;
  for (std::size_t k = 0; k < n_sides; ++k) {
    const std::size_t i = (sides.first + k) % n;
    const Eigen::Vector3d along = along_edge(corners, i);
    const Eigen::Vector3d inwards(-along.y(), along.x(), 0);
    const Eigen::Vector3d view =
        std::cos(options.pitch) * inwards - std::sin(options.pitch) * Eigen::Vector3d::UnitZ();
    const auto beside = [&](std::size_t corner) -> Eigen::Vector3d {
      const Eigen::Vector2d& c = corners[corner % n];
      return Eigen::Vector3d(c.x(), c.y(), 0) - options.stand_off * inwards;
    };
    const Eigen::Matrix3d attitude = looking(view);
    legs.push_back(line({attitude, beside(i)}, {attitude, beside(i + 1)}));
    const bool last = k + 1 == n_sides;
    if (last && n_sides < n) continue;
    const Eigen::Vector3d next = along_edge(corners, (i + 1) % n);
    const double angle = std::atan2(along.cross(next).z(), along.dot(next));
    const Eigen::Vector2d& c = corners[(i + 1) % n];
    if (angle > 1e-12)
      legs.push_back(
          arc({attitude, beside(i + 1)}, {c.x(), c.y(), 0}, Eigen::Vector3d::UnitZ(), angle));
  }
  return legs;
}

/// Rows of a flight at heights, each the other way than the one before.
inline flight_path serpentine(flight_path row, const row_places& rows, double rise) {
  flight_path path = row;
  path.legs.clear();
  path.n_rows = rows.offset.size();
  path.overlap_across = rows.overlap;
  path.is_closed = row.is_closed && path.n_rows == 1;
  for (const double z : rows.offset) {
    flight_path at_height = row;
    for (leg& l : at_height.legs) l.centre.z() += z + rise;
    go_to(path, at_height.legs.front().at(0));
    path.legs.insert(path.legs.end(), at_height.legs.begin(), at_height.legs.end());
    row = row.reversed();
  }
  return path;
}

}  // namespace detail

inline flight_path facade(const footprint& plan, const facade_options& options) {
  check(options.path);
  if (!(plan.low <= plan.high)) {
    throw argument_error(message("survey::facade: heights from low to high expected, found ",
                                 plan.low, " to ", plan.high));
  }
  const auto corners = anticlockwise(plan.corners);
  const std::size_t n = corners.size();
  const side_range sides = options.sides.value_or(side_range{0, n - 1});
  if (sides.first >= n || sides.last >= n)
    throw argument_error(message("survey::facade: the footprint has ", n, " sides"));
  flight_path row{.camera = options.path.camera,
                  .stand_off = options.path.stand_off,
                  .is_closed = (sides.last + 1) % n == sides.first};
  row.legs = detail::ring(corners, sides, options.path);
  const double height = frame_on_wall(row.camera, row.stand_off).height;
  return detail::serpentine(row,
                            place_rows(plan.low, plan.high, height, options.path.overlap_across),
                            row.stand_off * std::tan(options.path.pitch));
}

}  // namespace aib::survey
