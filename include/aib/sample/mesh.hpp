// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/cloud.hpp>
#include <aib/cloud/distances.hpp>
#include <aib/core/error.hpp>
#include <aib/core/executor.hpp>
#include <aib/core/random.hpp>
#include <aib/mesh/mesh.hpp>
#include <aib/mesh/surface.hpp>
#include <aib/sample/eliminate.hpp>
#include <aib/sample/thin.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

namespace aib::sample {

/// How points are spread.
enum class spread {
  uniform,  ///< at random
  poisson,  ///< at random but evenly: no two very near, no large hole (Poisson disk)
};

/// How many points; exactly one of the three is given.
struct mesh_options {
  std::optional<std::size_t> n = {};   ///< this many
  std::optional<double> spacing = {};  ///< uniform: one a square of this side; poisson: none nearer
  std::optional<double> per_area = {};  ///< this many a square unit
  spread method = spread::uniform;
  std::uint64_t seed = 1;
  unsigned threads = 0;  ///< 0: all
  aib::control control = {};
};

/// Points on a surface and how densely they lie.
struct mesh_samples {
  cloud::cloud points;  ///< with face normals, and labels where the mesh has them
  double area;          ///< of the mesh, square units
  double density;       ///< points a square unit
  /// Mean distance from a point of the surface to the nearest sample: below it an accuracy against
  /// these samples says nothing. Uniform: 0.5 / sqrt(density). Poisson: measured.
  double floor;
};

/// Mean distance from a point of a surface to the nearest of randomly placed samples.
[[nodiscard]] inline double sampling_floor(double density) { return 0.5 / std::sqrt(density); }

/// Points on a mesh, uniform by area. A triangle of area a gets n a / area points, rounded up or
/// down by one random offset for all; within it they are independent.
///
/// With `poisson` these points are candidates: five times n, of which the most crowded are taken
/// away (sample::eliminate), or, for a spacing, so many that few holes are left, of which none
/// nearer than the spacing to another is kept (sample::thin).
///
/// Points lie in the order of their triangles and have the triangle's normal and label.
/// The same for any number of threads.
/// Throws argument_error unless exactly one of n, spacing, per_area is given and positive,
/// undefined_error if the mesh has no area.
mesh_samples mesh(const aib::mesh::mesh& surface, const mesh_options& options);

namespace detail {

inline std::size_t sample_count(const mesh_options& options, double area) {
  if (options.n.has_value() + options.spacing.has_value() + options.per_area.has_value() != 1) {
    throw argument_error("sample::mesh: exactly one of n, spacing and per_area expected");
  }
  const double n = options.n         ? static_cast<double>(*options.n)
                   : options.spacing ? area / (*options.spacing * *options.spacing)
                                     : area * *options.per_area;
  const bool positive = !options.spacing || *options.spacing > 0;
  if (!(n > 0) || !positive) {
    throw argument_error("sample::mesh: n, spacing or per_area must be positive");
  }
  if (n > std::numeric_limits<std::uint32_t>::max()) {
    throw argument_error(message("sample::mesh: at most 4 294 967 295 points expected, found ", n));
  }
  return std::max<std::size_t>(1, static_cast<std::size_t>(std::llround(n)));
}

/// Index of the first sample of each triangle, and at the end their number.
inline std::vector<std::size_t> sample_starts(const aib::mesh::mesh& surface,
                                              double area,
                                              std::size_t n,
                                              double offset) {
  std::vector<std::size_t> starts;
  starts.reserve(surface.triangles.size() + 1);
  double below = 0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const double place = below / area * static_cast<double>(n) + offset;
    starts.push_back(std::min(n, static_cast<std::size_t>(place)));
    below += aib::mesh::area(surface, t);
  }
  starts.push_back(n);
  return starts;
}

/// Uniform in [0, 1) for a counter.
inline double uniform(std::uint64_t seed, std::uint64_t counter) {
  return static_cast<double>(random_bits(seed, counter) >> 11) * 0x1p-53;
}

inline Eigen::Vector3f unit_normal(const std::array<Eigen::Vector3d, 3>& corner) {
  const Eigen::Vector3d ab = corner[1] - corner[0];
  const Eigen::Vector3d ac = corner[2] - corner[0];
  const Eigen::Vector3d normal = ab.cross(ac).normalized();
  return normal.cast<float>();
}

/// An empty cloud that n points will lie in.
inline cloud::cloud room_for(const aib::mesh::mesh& surface, std::size_t n) {
  cloud::cloud points;
  points.origin = surface.origin;
  points.points.resize(n);
  points.normals.resize(n);
  if (!surface.labels.empty()) points.labels.resize(n);
  return points;
}

/// Points at random, uniform by area.
inline mesh_samples uniform_samples(const aib::mesh::mesh& surface, const mesh_options& options) {
  const double area = aib::mesh::area(surface);
  if (!(area > 0)) {
    throw undefined_error(
        message("sample::mesh: the mesh has no area (", surface.triangles.size(), " triangles)"));
  }
  const std::size_t n = sample_count(options, area);
  const double offset = uniform(options.seed, 0);
  const auto starts = sample_starts(surface, area, n, offset);
  cloud::cloud points = room_for(surface, n);
  for_each_chunk(
      surface.triangles.size(), 64, options.threads, options.control, [&](const chunk& c) {
        for (std::size_t t = c.begin; t < c.end; ++t) {
          if (starts[t] == starts[t + 1]) continue;
          demand_go(options.control);  // a triangle may have a million
          const auto corner = aib::mesh::corners(surface, t);
          const Eigen::Vector3f normal = unit_normal(corner);
          for (std::size_t i = starts[t]; i < starts[t + 1]; ++i) {
            const Eigen::Vector3d p = aib::mesh::point_in(corner, uniform(options.seed, 2 * i + 1),
                                                          uniform(options.seed, 2 * i + 2));
            points.points[i] = p.cast<float>();
            points.normals[i] = normal;
            if (!points.labels.empty()) points.labels[i] = surface.labels[t];
          }
        }
      });
  const double density = static_cast<double>(n) / area;
  return {std::move(points), area, density, sampling_floor(density)};
}

/// Candidates for a Poisson-disk sample: for a spacing, ten a disk of half of it.
inline mesh_samples candidates(const aib::mesh::mesh& surface, mesh_options options) {
  if (options.spacing) {
    options.per_area = 10 / (std::numbers::pi / 4 * *options.spacing * *options.spacing);
    options.spacing.reset();
  } else {
    const double area = aib::mesh::area(surface);
    options.n = 5 * (area > 0 ? sample_count(options, area) : 1);
    options.per_area.reset();
  }
  return uniform_samples(surface, options);
}

inline mesh_samples poisson_samples(const aib::mesh::mesh& surface, const mesh_options& options) {
  if (options.spacing && !(*options.spacing > 0)) {
    throw argument_error("sample::mesh: n, spacing or per_area must be positive");
  }
  mesh_samples samples = candidates(surface, options);
  const cloud::cloud all = std::move(samples.points);
  samples.points =
      options.spacing
          ? thin(all, {*options.spacing, options.seed, options.control})
          : eliminate(all, {all.size() / 5, samples.area, options.threads, options.control});
  samples.density = static_cast<double>(samples.points.size()) / samples.area;
  const cloud::distances apart(all, samples.points,
                               {.threads = options.threads, .control = options.control});
  // The kept points are candidates too, at distance 0.
  samples.floor = apart.mean() * static_cast<double>(all.size()) /
                  static_cast<double>(all.size() - std::min(all.size() - 1, samples.points.size()));
  return samples;
}

}  // namespace detail

inline mesh_samples mesh(const aib::mesh::mesh& surface, const mesh_options& options) {
  return options.method == spread::poisson ? detail::poisson_samples(surface, options)
                                           : detail::uniform_samples(surface, options);
}

}  // namespace aib::sample
