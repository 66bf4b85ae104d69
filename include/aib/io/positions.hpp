// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/cloud.hpp>
#include <aib/cloud/origin.hpp>
#include <aib/core/message.hpp>
#include <aib/mesh/mesh.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace aib::io {

/// Positions as clouds and meshes keep them: `origin + points[i]`.
struct float_positions {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3f> points = {};
};

/// Double positions as floats, see cloud::origin_finder.
[[nodiscard]] inline float_positions to_floats(std::span<const Eigen::Vector3d> positions) {
  cloud::origin_finder origin(positions.size());
  for (const Eigen::Vector3d& p : positions) origin.add(p);
  float_positions result{.origin = origin.result()};
  result.points.reserve(positions.size());
  for (const Eigen::Vector3d& p : positions)
    result.points.emplace_back((p - result.origin).cast<float>());
  return result;
}

/// How many points have a coordinate that is NaN or infinite.
[[nodiscard]] inline std::size_t count_non_finite(std::span<const Eigen::Vector3f> points) {
  // All exponent bits set: looked for in one flat loop without branches, since most files have
  // none.
  const float* flat = points.empty() ? nullptr : points.front().data();
  std::uint32_t any = 0;
  for (std::size_t i = 0; i < 3 * points.size(); ++i)
    any |= (std::bit_cast<std::uint32_t>(flat[i]) & 0x7f800000u) == 0x7f800000u ? 1u : 0u;
  if (any == 0) return 0;
  return static_cast<std::size_t>(std::count_if(
      points.begin(), points.end(), [](const Eigen::Vector3f& p) { return !p.allFinite(); }));
}

/// The sentence that a reader leaves about non-finite points; nothing where all are finite.
[[nodiscard]] inline std::optional<std::string> non_finite_warning(
    std::span<const Eigen::Vector3f> points, std::string_view name) {
  const std::size_t n = count_non_finite(points);
  if (n == 0) return std::nullopt;
  return message(n, " of ", points.size(), " ", name, " are not finite");
}

/// Gives a cloud the positions and the warnings that its reader owes about them.
inline void set_positions(cloud::cloud& cloud, float_positions positions) {
  cloud.origin = positions.origin;
  cloud.points = std::move(positions.points);
  if (cloud.empty()) cloud.warnings.push_back("no points");
  if (auto warning = non_finite_warning(cloud.points, "points"))
    cloud.warnings.push_back(std::move(*warning));
}

/// Gives a mesh, which has its triangles, its vertices and the warnings that its reader owes.
inline void set_vertices(mesh::mesh& mesh, float_positions vertices) {
  mesh.origin = vertices.origin;
  mesh.vertices = std::move(vertices.points);
  if (mesh.triangles.empty()) mesh.warnings.push_back("no triangles");
  if (auto warning = non_finite_warning(mesh.vertices, "vertices"))
    mesh.warnings.push_back(std::move(*warning));
}

/// The label that a number stands for: 0 where it is none.
[[nodiscard]] inline std::uint32_t label_of(double number) {
  return number >= 0 && number < 4294967296.0 ? static_cast<std::uint32_t>(number) : 0;
}

/// The channel of a colour, a number of 0 to 255; what is beyond, or NaN, becomes its nearest end.
[[nodiscard]] inline std::uint8_t channel_of(double number) {
  return number > 0 ? static_cast<std::uint8_t>(std::min(number, 255.0)) : std::uint8_t{0};
}

}  // namespace aib::io
