// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/math/rotation.hpp>
#include <aib/survey/flight_path.hpp>
#include <aib/survey/footprint.hpp>
#include <aib/survey/lens.hpp>
#include <aib/survey/outline.hpp>

#include <Eigen/Core>

#include <algorithm>
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
/// jump. Into an inner corner the camera turns on its way, half of it before, half behind. The
/// frames of the rows cover the footprint's heights.
///
/// No place is nearer to a wall than the stand-off: an opening narrower than twice of it is passed
/// by. Throws argument_error where the footprint is no simple polygon, sides are not to be reached,
/// or an option is out of its range.
[[nodiscard]] flight_path facade(const footprint& plan, const facade_options& options);

namespace detail {

/// The pieces of an outline beside the sides, from the first of them to the last.
inline std::vector<leg> beside(const std::vector<outline_piece>& around,
                               const side_range& sides,
                               std::size_t n) {
  const std::size_t last = 2 * ((sides.last + n - sides.first) % n);
  const bool is_all = last + 2 == 2 * n;
  const auto place = [&](const outline_piece& p) {
    return (p.source + 2 * (n - sides.first)) % (2 * n);
  };
  std::vector<outline_piece> ordered = around;
  const auto first =
      std::min_element(ordered.begin(), ordered.end(),
                       [&](const auto& a, const auto& b) { return place(a) < place(b); });
  std::rotate(ordered.begin(), first, ordered.end());
  while (!is_all && !ordered.empty() && place(ordered.back()) > last) ordered.pop_back();
  std::vector<leg> legs;
  for (const outline_piece& p : ordered) legs.push_back(p.way);
  return legs;
}

/// The leg with other attitudes at its ends, between which the camera turns evenly.
inline leg turning(leg way, const Eigen::Matrix3d& from, const Eigen::Matrix3d& to) {
  way.attitude = from;
  way.turn = math::axis_angle_from(to * from.transpose());
  return way;
}

/// Legs whose views meet: where one ends otherwise than the next begins, both turn to the middle
/// over a reach, at most over half of their length.
inline std::vector<leg> without_jumps(const std::vector<leg>& legs, double reach, bool is_closed) {
  constexpr double least = 1e-6;
  const std::size_t n = legs.size();
  const auto half_jump = [&](std::size_t i) -> Eigen::Vector3d {  // behind leg i
    if (i + 1 == n && !is_closed) return Eigen::Vector3d::Zero();
    const Eigen::Matrix3d end = legs[i].at(1).rotation, begin = legs[(i + 1) % n].attitude;
    return math::axis_angle_from(begin * end.transpose()) / 2;
  };
  std::vector<leg> smooth;
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector3d before = -half_jump((i + n - 1) % n), behind = half_jump(i);
    const double share = std::min(0.5, reach / legs[i].length());
    const double from = before.norm() > least ? share : 0;
    const double to = behind.norm() > least ? 1 - share : 1;
    if (from > 0) {
      const leg part = legs[i].part(0, from);
      smooth.push_back(
          turning(part, math::rotation_from(before) * part.attitude, part.at(1).rotation));
    }
    if (to > from) smooth.push_back(legs[i].part(from, to));
    if (to < 1) {
      const leg part = legs[i].part(to, 1);
      smooth.push_back(
          turning(part, part.attitude, math::rotation_from(behind) * part.at(1).rotation));
    }
  }
  return smooth;
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
  const auto around = outline(corners, row.stand_off, options.path.pitch);
  const auto legs = detail::beside(around, sides, n);
  if (legs.empty())
    throw argument_error("survey::facade: at this stand-off no place beside these sides is free");
  const wall_frame frame = frame_on_wall(row.camera, row.stand_off);
  row.legs = detail::without_jumps(legs, frame.width / 2, row.is_closed);
  return detail::serpentine(
      row, place_rows(plan.low, plan.high, frame.height, options.path.overlap_across),
      row.stand_off * std::tan(options.path.pitch));
}

}  // namespace aib::survey
