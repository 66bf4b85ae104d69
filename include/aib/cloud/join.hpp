// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/cloud.hpp>
#include <aib/cloud/positions.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace aib::cloud {

namespace detail {

template <class T>
void extend(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

/// Drops what not every point has.
template <class T>
void clear_unless_all(std::vector<T>& values, std::size_t n) {
  if (values.size() != n) values.clear();
}

}  // namespace detail

/// The points of several clouds in one, in their order. They keep the origin of clouds that share
/// one; others are counted from a new one, see origin_finder. Normals, colors and labels stay where
/// every cloud with points has them.
[[nodiscard]] inline cloud joined(std::span<const cloud* const> clouds) {
  cloud all;
  std::vector<const cloud*> parts;
  std::vector<std::size_t> begins;
  for (const cloud* c : clouds) {
    detail::extend(all.warnings, c->warnings);
    if (c->empty()) continue;
    parts.push_back(c);
    begins.push_back(all.size());
    detail::extend(all.points, c->points);
    detail::extend(all.normals, c->normals);
    detail::extend(all.colors, c->colors);
    detail::extend(all.labels, c->labels);
  }
  if (parts.empty()) return all;
  all.origin = parts.front()->origin;
  const auto elsewhere = [&](const cloud* c) { return c->origin != all.origin; };
  if (std::any_of(parts.begin(), parts.end(), elsewhere)) {
    placed_points placed = place(all.size(), [&](std::size_t i) {
      const auto part = std::upper_bound(begins.begin(), begins.end(), i) - begins.begin() - 1;
      return Eigen::Vector3d(parts[static_cast<std::size_t>(part)]->origin +
                             all.points[i].cast<double>());
    });
    all.origin = placed.origin;
    all.points = std::move(placed.points);
  }
  detail::clear_unless_all(all.normals, all.size());
  detail::clear_unless_all(all.colors, all.size());
  detail::clear_unless_all(all.labels, all.size());
  return all;
}

}  // namespace aib::cloud
