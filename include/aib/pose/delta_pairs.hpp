// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/math/rigid3.hpp>
#include <aib/math/rotation.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace aib::pose {

enum class delta_unit { frames, m, deg, rad };

struct delta_options {
  double delta = 1;
  delta_unit unit = delta_unit::frames;
  bool all_pairs = false;  ///< every start, not one pair after another
  double tolerance = 0.1;  ///< all pairs by path or angle: share of delta that a pair may miss
};

struct frame_pair {
  std::size_t from;
  std::size_t to;
};

/// Length of the path from the first pose to each.
[[nodiscard]] inline std::vector<double> path_lengths(std::span<const math::rigid3> poses) {
  std::vector<double> out;
  double length = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (i > 0) length += (poses[i].translation - poses[i - 1].translation).norm();
    out.push_back(length);
  }
  return out;
}

namespace detail {

[[nodiscard]] inline double turn(const math::rigid3& a, const math::rigid3& b, delta_unit unit) {
  const double angle = math::rotation_angle(a.rotation.transpose() * b.rotation);
  return unit == delta_unit::deg ? math::degrees(angle) : angle;
}

inline std::vector<frame_pair> pairs_by_frames(std::size_t n, const delta_options& options) {
  if (!(options.delta < static_cast<double>(n))) return {};
  const auto delta = static_cast<std::size_t>(options.delta);
  const std::size_t step = options.all_pairs ? 1 : delta;
  std::vector<frame_pair> out;
  for (std::size_t i = 0; i + delta < n; i += step) out.push_back({i, i + delta});
  return out;
}

/// Of every place on a path but the last the one whose distance is nearest to delta, the earlier of
/// two, where it misses it by at most a share of delta.
inline std::vector<frame_pair> nearest_along_path(std::span<const double> path,
                                                  double delta,
                                                  double tolerance) {
  std::vector<frame_pair> out;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const auto first = path.begin() + static_cast<std::ptrdiff_t>(i) + 1;
    const auto miss = [&](auto at) { return std::abs(*at - path[i] - delta); };
    auto best = std::lower_bound(first, path.end(), path[i] + delta);
    if (best == path.end() || (best != first && miss(best - 1) <= miss(best))) --best;
    best = std::lower_bound(first, best, *best);  // of equal ones the first
    if (miss(best) <= tolerance * delta)
      out.push_back({i, static_cast<std::size_t>(best - path.begin())});
  }
  return out;
}

inline std::vector<frame_pair> pairs_by_path(std::span<const math::rigid3> poses,
                                             const delta_options& options) {
  if (options.all_pairs)
    return nearest_along_path(path_lengths(poses), options.delta, options.tolerance);
  std::vector<frame_pair> out;
  std::vector<std::size_t> stops;  // as evo: the first pair begins at the first stop, not at 0
  double since = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (i > 0) since += (poses[i].translation - poses[i - 1].translation).norm();
    if (since < options.delta) continue;
    stops.push_back(i);
    since = 0;
  }
  for (std::size_t k = 1; k < stops.size(); ++k) out.push_back({stops[k - 1], stops[k]});
  return out;
}

inline std::vector<frame_pair> pairs_by_angle(std::span<const math::rigid3> poses,
                                              const delta_options& options) {
  std::vector<frame_pair> out;
  if (options.all_pairs) {
    const double slack = options.tolerance * options.delta;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      for (std::size_t j = i + 1; j < poses.size(); ++j) {
        const double angle = turn(poses[i], poses[j], options.unit);
        if (options.delta - slack <= angle && angle <= options.delta + slack) out.push_back({i, j});
      }
    }
    return out;
  }
  double since = 0;
  std::size_t from = 0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    since += turn(poses[i - 1], poses[i], options.unit);
    if (since < options.delta) continue;
    out.push_back({from, i});
    from = i;
    since = 0;
  }
  return out;
}

}  // namespace detail

/// Pairs of poses that are delta frames, metres of path, or degrees or radians of turning apart, in
/// evo's way: one after another (turning adds up from pose to pose), or all (by angle: the angle
/// between the two).
///
/// Throws argument_error unless delta > 0, and whole for frames; undefined_error if no pair is that
/// far apart.
/// Source: evo, core/filters.py.
inline std::vector<frame_pair> delta_pairs(std::span<const math::rigid3> poses,
                                           const delta_options& options) {
  const bool whole = options.delta == std::floor(options.delta);
  if (!(options.delta > 0) || (options.unit == delta_unit::frames && !whole))
    throw argument_error(message("delta > 0, whole for frames, expected, found ", options.delta));
  std::vector<frame_pair> pairs =
      options.unit == delta_unit::frames ? detail::pairs_by_frames(poses.size(), options)
      : options.unit == delta_unit::m    ? detail::pairs_by_path(poses, options)
                                         : detail::pairs_by_angle(poses, options);
  if (pairs.empty()) {
    throw undefined_error(
        message("no two of ", poses.size(), " poses are a delta of ", options.delta, " apart"));
  }
  return pairs;
}

}  // namespace aib::pose
