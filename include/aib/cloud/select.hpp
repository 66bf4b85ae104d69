// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/cloud.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace aib::cloud {

namespace detail {

template <class T>
std::vector<T> picked(const std::vector<T>& all, std::span<const std::size_t> index) {
  std::vector<T> some;
  if (all.empty()) return some;
  some.reserve(index.size());
  for (const std::size_t i : index) some.push_back(all[i]);
  return some;
}

}  // namespace detail

/// The points of some indices, in their order, with all that belongs to them.
[[nodiscard]] inline cloud select(const cloud& c, std::span<const std::size_t> index) {
  return {.origin = c.origin,
          .points = detail::picked(c.points, index),
          .normals = detail::picked(c.normals, index),
          .colors = detail::picked(c.colors, index),
          .labels = detail::picked(c.labels, index),
          .warnings = c.warnings};
}

/// The points of whose index `keep(i)` is true.
template <class Keep>
[[nodiscard]] cloud select_where(const cloud& c, Keep&& keep) {
  std::vector<std::size_t> index;
  for (std::size_t i = 0; i < c.size(); ++i) {
    if (keep(i)) index.push_back(i);
  }
  return select(c, index);
}

}  // namespace aib::cloud
