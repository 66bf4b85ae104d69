// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/math/rigid3.hpp>
#include <aib/survey/flight_path.hpp>
#include <aib/survey/footprint.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace aib::survey {

/// A piece of the way round a footprint, at height 0.
struct outline_piece {
  leg way;
  std::size_t source;  ///< 2 i: along edge i, 2 i + 1: round the corner behind it
};

/// The way round a footprint at a stand-off, anticlockwise: along its edges and in arcs round the
/// corners that stick out, nowhere nearer to an edge. Where the footprint turns inwards, pieces end
/// where they meet. An opening narrower than twice the stand-off is passed by.
///
/// corners   of a simple polygon, anticlockwise
/// pitch     of the views, which are along the inward normals, radians, positive looks down
///
/// Throws argument_error where corners lie so near to each other that rounding hides the way.
[[nodiscard]] std::vector<outline_piece> outline(const std::vector<Eigen::Vector2d>& corners,
                                                 double stand_off,
                                                 double pitch = 0);

namespace detail {

/// Unit vector along an edge, level.
inline Eigen::Vector3d along_edge(const std::vector<Eigen::Vector2d>& corners, std::size_t i) {
  const Eigen::Vector2d d = (corners[(i + 1) % corners.size()] - corners[i]).normalized();
  return {d.x(), d.y(), 0};
}

/// The pieces beside all edges and round all corners that stick out, whatever lies in their way.
inline std::vector<outline_piece> pieces_beside(const std::vector<Eigen::Vector2d>& corners,
                                                double stand_off,
                                                double pitch) {
  const std::size_t n = corners.size();
  std::vector<outline_piece> pieces;
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector3d along = along_edge(corners, i);
    const Eigen::Vector3d inwards(-along.y(), along.x(), 0);
    const Eigen::Matrix3d attitude =
        looking(std::cos(pitch) * inwards - std::sin(pitch) * Eigen::Vector3d::UnitZ());
    const auto beside = [&](const Eigen::Vector2d& c) -> Eigen::Vector3d {
      return Eigen::Vector3d(c.x(), c.y(), 0) - stand_off * inwards;
    };
    const Eigen::Vector2d& corner = corners[(i + 1) % n];
    const math::rigid3 end{attitude, beside(corner)};
    pieces.push_back({line({attitude, beside(corners[i])}, end), 2 * i});
    const Eigen::Vector3d next = along_edge(corners, (i + 1) % n);
    const double angle = std::atan2(along.cross(next).z(), along.dot(next));
    if (angle > 1e-12) {
      const Eigen::Vector3d centre(corner.x(), corner.y(), 0);
      pieces.push_back({arc(end, centre, Eigen::Vector3d::UnitZ(), angle), 2 * i + 1});
    }
  }
  return pieces;
}

/// Points of a level line on a circle, none or two.
inline std::vector<Eigen::Vector3d> points_on_circle(const leg& straight, const leg& round) {
  const Eigen::Vector3d along = straight.shift.normalized();
  const Eigen::Vector3d foot = straight.centre + along.dot(round.centre - straight.centre) * along;
  const double left = round.arm.squaredNorm() - (foot - round.centre).squaredNorm();
  if (!(left >= 0)) return {};
  return {foot - std::sqrt(left) * along, foot + std::sqrt(left) * along};
}

/// Points where the lines and circles of two level legs meet; none where they are the same.
inline std::vector<Eigen::Vector3d> meeting_points(const leg& a, const leg& b) {
  const bool a_is_round = a.angle != 0, b_is_round = b.angle != 0;
  if (a_is_round && b_is_round) {
    const Eigen::Vector3d way = b.centre - a.centre;
    const leg between{.centre = (a.centre + b.centre) / 2, .shift = {-way.y(), way.x(), 0}};
    return way.norm() > 0 ? points_on_circle(between, a) : std::vector<Eigen::Vector3d>();
  }
  if (a_is_round) return points_on_circle(b, a);
  if (b_is_round) return points_on_circle(a, b);
  const double sine = a.shift.cross(b.shift).z();
  if (!(std::abs(sine) > 1e-12 * a.shift.norm() * b.shift.norm())) return {};
  const Eigen::Vector3d way = b.centre - a.centre;
  return {a.centre + way.cross(b.shift).z() / sine * a.shift};
}

/// Share of a level leg at a point of its line or circle.
inline double share_at(const leg& l, const Eigen::Vector3d& p) {
  const Eigen::Vector3d way = p - l.centre;
  if (l.angle == 0) return l.shift.dot(way) / l.shift.squaredNorm();
  return std::atan2(l.axis.dot(l.arm.cross(way)), l.arm.dot(way)) / l.angle;
}

/// A piece cut where it meets others, in order.
inline std::vector<outline_piece> cut(const std::vector<outline_piece>& all, std::size_t which) {
  constexpr double least = 1e-9;
  const std::size_t n = all.size();
  const leg& whole = all[which].way;
  std::vector<double> shares;
  for (std::size_t other = 0; other < n; ++other) {
    const bool is_next = (other + 1) % n == which || (which + 1) % n == other;
    const bool goes_over = is_next && (whole.angle != 0) != (all[other].way.angle != 0);
    if (other == which || goes_over) continue;
    for (const Eigen::Vector3d& p : meeting_points(whole, all[other].way)) {
      const double mine = share_at(whole, p), theirs = share_at(all[other].way, p);
      if (mine > least && mine < 1 - least && theirs > -least && theirs < 1 + least)
        shares.push_back(mine);
    }
  }
  if (shares.empty()) return {all[which]};
  shares.insert(shares.end(), {0, 1});
  std::sort(shares.begin(), shares.end());
  std::vector<outline_piece> parts;
  for (std::size_t i = 1; i < shares.size(); ++i)
    parts.push_back({whole.part(shares[i - 1], shares[i]), all[which].source});
  return parts;
}

inline double distance_to_edges(const Eigen::Vector2d& p,
                                const std::vector<Eigen::Vector2d>& corners) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d edge = corners[(i + 1) % corners.size()] - corners[i];
    const Eigen::Vector2d way = p - corners[i];
    const double share = std::clamp(edge.dot(way) / edge.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (way - share * edge).norm());
  }
  return least;
}

/// Pieces one behind the other until they come round, or none where they do not. Pockets behind
/// narrow openings have loops of their own: this one begins at the leftmost piece, since the loop
/// round all reaches farthest.
inline std::vector<outline_piece> outer_loop(std::vector<outline_piece> pieces, double tolerance) {
  const auto begin = [](const outline_piece& p) { return p.way.at(0).translation; };
  auto next = std::min_element(pieces.begin(), pieces.end(), [&](const auto& a, const auto& b) {
    return begin(a).x() < begin(b).x();
  });
  std::vector<outline_piece> loop;
  while (next != pieces.end()) {
    if (!loop.empty() && begin(*next) == begin(loop.front())) return loop;
    loop.push_back(*next);
    if (loop.size() > 1) pieces.erase(next);
    const Eigen::Vector3d end = loop.back().way.at(1).translation;
    next = std::find_if(pieces.begin(), pieces.end(), [&](const outline_piece& p) {
      return (begin(p) - end).norm() <= tolerance;
    });
  }
  return {};
}

}  // namespace detail

inline std::vector<outline_piece> outline(const std::vector<Eigen::Vector2d>& corners,
                                          double stand_off,
                                          double pitch) {
  const auto all = detail::pieces_beside(corners, stand_off, pitch);
  double size = stand_off;
  for (const Eigen::Vector2d& c : corners) size = std::max(size, c.cwiseAbs().maxCoeff());
  const double rounding = 1e-9 * size;
  std::vector<outline_piece> free;
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (const outline_piece& part : detail::cut(all, i)) {
      const Eigen::Vector3d middle = part.way.at(0.5).translation;
      const double distance = detail::distance_to_edges(middle.head<2>(), corners);
      if (part.way.length() > rounding && distance >= stand_off - rounding) free.push_back(part);
    }
  }
  auto loop = detail::outer_loop(free, 100 * rounding);
  if (loop.empty())
    throw argument_error("survey::outline: corners too near to each other to find a way round");
  const auto lowest = std::min_element(
      loop.begin(), loop.end(), [](const auto& a, const auto& b) { return a.source < b.source; });
  std::rotate(loop.begin(), lowest, loop.end());
  return loop;
}

}  // namespace aib::survey
