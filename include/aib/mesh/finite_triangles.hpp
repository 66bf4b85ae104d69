// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/positions.hpp>
#include <aib/core/error.hpp>
#include <aib/mesh/mesh.hpp>
#include <aib/search/triangle_tree.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace aib::mesh {

/// The triangles of a mesh whose corners are all finite (cloud::is_finite).
struct finite_triangles {
  std::vector<search::corners> corners = {};
  std::vector<std::uint32_t> index = {};  ///< of each in the mesh

  /// Throws undefined_error, in the name of `function`, if there is none.
  finite_triangles(const mesh& surface, std::string_view function) {
    corners.reserve(surface.triangles.size());
    index.reserve(surface.triangles.size());
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
      const auto& [a, b, c] = surface.triangles[t];
      const Eigen::Vector3f& at_a = surface.vertices[a];
      const Eigen::Vector3f& at_b = surface.vertices[b];
      const Eigen::Vector3f& at_c = surface.vertices[c];
      if (!cloud::is_finite(at_a) || !cloud::is_finite(at_b) || !cloud::is_finite(at_c)) continue;
      corners.emplace_back(at_a, at_b, at_c);
      index.push_back(static_cast<std::uint32_t>(t));
    }
    if (corners.empty()) {
      throw undefined_error(
          message(function, ": no finite triangle (", surface.triangles.size(), " triangles)"));
    }
  }
};

}  // namespace aib::mesh
