// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/mesh/mesh.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace aib::mesh {

/// For each triangle the same with corners at one position under one number, so that a mesh whose
/// vertices are repeated (STL, textured OBJ) holds together.
[[nodiscard]] inline std::vector<triangle> welded(const mesh& m) {
  std::vector<std::uint32_t> order(m.vertices.size());
  for (std::size_t v = 0; v < order.size(); ++v) order[v] = static_cast<std::uint32_t>(v);
  const auto coordinates = [&](std::uint32_t v) {
    const Eigen::Vector3f& p = m.vertices[v];
    return std::array{p.x() + 0.0f, p.y() + 0.0f, p.z() + 0.0f};  // -0 as 0
  };
  std::erase_if(order, [&](std::uint32_t v) { return !m.vertices[v].allFinite(); });
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const auto at_a = coordinates(a), at_b = coordinates(b);
    return at_a != at_b ? at_a < at_b : a < b;
  });
  std::vector<std::uint32_t> first(m.vertices.size());
  for (std::size_t v = 0; v < first.size(); ++v) first[v] = static_cast<std::uint32_t>(v);
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (coordinates(order[i]) == coordinates(order[i - 1])) first[order[i]] = first[order[i - 1]];
  }
  std::vector<triangle> triangles;
  triangles.reserve(m.triangles.size());
  for (const auto& [a, b, c] : m.triangles) triangles.push_back({first[a], first[b], first[c]});
  return triangles;
}

/// Directed edges that have no twin: 0 for a watertight mesh, in which every edge is passed as
/// often one way as the other. Triangles with two corners at one place play no part.
[[nodiscard]] inline std::size_t n_open_edges(const mesh& m) {
  std::vector<std::array<std::uint32_t, 3>> edges;  // both ends ascending, then the direction
  for (const triangle& t : welded(m)) {
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), a < b});
    }
  }
  std::sort(edges.begin(), edges.end());
  std::size_t open = 0;
  for (std::size_t first = 0, last = 0; first < edges.size(); first = last) {
    std::ptrdiff_t balance = 0;
    for (; last < edges.size() && edges[last][0] == edges[first][0] &&
           edges[last][1] == edges[first][1];
         ++last) {
      balance += edges[last][2] == 1 ? 1 : -1;
    }
    open += static_cast<std::size_t>(balance < 0 ? -balance : balance);
  }
  return open;
}

/// Whether the mesh encloses a volume: it has triangles, and every edge joins them pairwise with
/// agreeing sides.
[[nodiscard]] inline bool is_watertight(const mesh& m) {
  return !m.empty() && n_open_edges(m) == 0;
}

}  // namespace aib::mesh
