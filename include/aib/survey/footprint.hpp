// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/mesh/mesh.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace aib::survey {

/// The ground plan of a building: a simple polygon, anticlockwise from above, and its heights.
struct footprint {
  std::vector<Eigen::Vector2d> corners;
  double low = 0, high = 0;
};

/// Labels of a mesh by their names. Throws argument_error for a name that it has not.
[[nodiscard]] inline std::vector<std::uint32_t> labels_of(const std::vector<std::string>& known,
                                                          const std::vector<std::string>& names) {
  std::vector<std::uint32_t> labels;
  for (const std::string& name : names) {
    const auto found = std::find(known.begin(), known.end(), name);
    if (found == known.end()) {
      std::string list;
      for (const std::string& k : known) list += (list.empty() ? "" : ", ") + k;
      throw argument_error(message("survey: no label '", name, "' in the mesh, which has ", list));
    }
    labels.push_back(static_cast<std::uint32_t>(found - known.begin()));
  }
  return labels;
}

/// Whether a label is one of some; all are where none is named.
[[nodiscard]] inline bool is_among(std::uint32_t label, const std::vector<std::uint32_t>& labels) {
  return labels.empty() || std::find(labels.begin(), labels.end(), label) != labels.end();
}

/// Twice the area of the triangle a, b, c, positive where it turns to the left.
[[nodiscard]] inline double turn_of(const Eigen::Vector2d& a,
                                    const Eigen::Vector2d& b,
                                    const Eigen::Vector2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// The convex hull, anticlockwise. Source: Andrew, "Another efficient algorithm for convex hulls in
/// two dimensions", 1979.
[[nodiscard]] inline std::vector<Eigen::Vector2d> convex_hull(std::vector<Eigen::Vector2d> points) {
  const auto before = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  };
  std::sort(points.begin(), points.end(), before);
  std::vector<Eigen::Vector2d> hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t first = hull.size();
    for (const Eigen::Vector2d& p : points) {
      while (hull.size() > first + 1 && turn_of(hull[hull.size() - 2], hull.back(), p) <= 0)
        hull.pop_back();
      hull.push_back(p);
    }
    if (!hull.empty()) hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

/// Hull and heights of the faces of a mesh with some labels; no label: all faces.
/// Throws undefined_error where nothing is left, or no area.
[[nodiscard]] inline footprint footprint_of(const mesh::mesh& m,
                                            const std::vector<std::uint32_t>& labels = {}) {
  footprint f{{}, HUGE_VAL, -HUGE_VAL};
  std::vector<Eigen::Vector2d> points;
  const bool labelled = m.labels.size() == m.triangles.size();
  for (std::size_t t = 0; t < m.triangles.size(); ++t) {
    if (!labels.empty() && !(labelled && is_among(m.labels[t], labels))) continue;
    for (const std::uint32_t v : m.triangles[t]) {
      const Eigen::Vector3d p = m.position(v);
      if (!p.allFinite()) continue;
      points.push_back(p.head<2>());
      f.low = std::min(f.low, p.z());
      f.high = std::max(f.high, p.z());
    }
  }
  f.corners = convex_hull(std::move(points));
  if (f.corners.size() < 3)
    throw undefined_error("survey::footprint_of: no faces with these labels that cover an area");
  return f;
}

/// Whether the lines from a to b and from c to d have a point in common.
[[nodiscard]] inline bool do_meet(const Eigen::Vector2d& a,
                                  const Eigen::Vector2d& b,
                                  const Eigen::Vector2d& c,
                                  const Eigen::Vector2d& d) {
  const Eigen::Array2d low = a.cwiseMin(b), high = a.cwiseMax(b);
  if ((c.cwiseMin(d).array() > high).any() || (c.cwiseMax(d).array() < low).any()) return false;
  return turn_of(a, b, c) * turn_of(a, b, d) <= 0 && turn_of(c, d, a) * turn_of(c, d, b) <= 0;
}

/// The corners anticlockwise. Throws argument_error unless they are three or more that make a
/// simple polygon: no edge without a length, none that crosses or touches another.
[[nodiscard]] inline std::vector<Eigen::Vector2d> anticlockwise(
    std::vector<Eigen::Vector2d> corners) {
  const std::size_t n = corners.size();
  double area = 0;
  for (std::size_t i = 1; i + 1 < n; ++i) area += turn_of(corners[0], corners[i], corners[i + 1]);
  if (n < 3 || !(std::abs(area) > 0) || !std::isfinite(area))
    throw argument_error("survey: a footprint of three corners or more and an area expected");
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d &a = corners[i], &b = corners[(i + 1) % n], &c = corners[(i + 2) % n];
    const auto refuse = [&](const char* what) {
      throw argument_error(message("survey: the footprint's edge from corner ", i + 1, " (", a.x(),
                                   ", ", a.y(), ") ", what));
    };
    if (a == b) refuse("has no length");
    if (turn_of(a, b, c) == 0 && (b - a).dot(c - b) < 0) refuse("goes back on the next one");
    for (std::size_t k = i + 2; k < n - (i == 0 ? 1 : 0); ++k)
      if (do_meet(a, b, corners[k], corners[(k + 1) % n])) refuse("meets another one");
  }
  if (area < 0) std::reverse(corners.begin(), corners.end());
  return corners;
}

}  // namespace aib::survey
