// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/cloud.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <span>
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

/// The points of several clouds in one, in their order, counted from the origin of the first that
/// has points. Normals, colors and labels stay where every cloud with points has them.
[[nodiscard]] inline cloud joined(std::span<const cloud* const> clouds) {
  cloud all;
  for (const cloud* c : clouds) {
    if (all.empty()) all.origin = c->origin;
    const Eigen::Vector3d shift = c->origin - all.origin;
    if (shift.isZero(0)) {
      detail::extend(all.points, c->points);
    } else {
      for (const Eigen::Vector3f& p : c->points) {
        const Eigen::Vector3d moved = shift + p.cast<double>();
        all.points.push_back(moved.cast<float>());
      }
    }
    detail::extend(all.normals, c->normals);
    detail::extend(all.colors, c->colors);
    detail::extend(all.labels, c->labels);
    detail::extend(all.warnings, c->warnings);
  }
  detail::clear_unless_all(all.normals, all.size());
  detail::clear_unless_all(all.colors, all.size());
  detail::clear_unless_all(all.labels, all.size());
  return all;
}

}  // namespace aib::cloud
