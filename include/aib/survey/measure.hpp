// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/cloud.hpp>
#include <aib/core/error.hpp>
#include <aib/core/executor.hpp>
#include <aib/core/isa.hpp>
#include <aib/core/random.hpp>
#include <aib/math/projection.hpp>
#include <aib/math/rotation.hpp>
#include <aib/math/view.hpp>
#include <aib/mesh/mesh.hpp>
#include <aib/mesh/ray_surface.hpp>
#include <aib/mesh/surface.hpp>
#include <aib/survey/facing.hpp>
#include <aib/survey/footprint.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace aib::survey {

struct measure_options {
  std::vector<std::uint32_t> labels = {};                ///< of the faces that count; none: all
  std::size_t samples = 20000;                           ///< points on the surface
  std::size_t columns = 32, rows = 18;                   ///< rays of a frame
  double max_incidence = 75 / math::degrees_per_radian;  ///< radians; a flatter view sees nothing
  double max_distance = std::numeric_limits<double>::infinity();
  double tolerance = 0.001;  ///< what is nearer by a smaller share of the distance does not hide
  std::uint64_t seed = 1;
  unsigned threads = 0;  ///< 0: all
  aib::control control = {};
};

/// A point on a surface and how it is seen.
struct seen_sample {
  Eigen::Vector3d position;
  Eigen::Vector3d normal;
  std::uint32_t n_views = 0;
  double incidence = HUGE_VAL;  ///< radians, of the steepest view; infinite where there is none
};

/// What a flight sees, measured by casting rays.
struct flight_report {
  std::vector<double> overlap;  ///< of each frame but the last: share of the surface in it that the
                                ///< next one sees; NaN where it sees none
  std::vector<float> gsd;       ///< of every ray that counts: depth / focal length
  std::size_t n_rays = 0;
  std::vector<double> off_normal;  ///< radians, of each frame: from its view to the one that faces
                                   ///< the surface in its middle; NaN where it sees none there
  double area = 0;                 ///< of the faces that coverage is about
  std::vector<seen_sample> samples;  ///< evenly by area

  /// Share of the area that at least `n` views see.
  [[nodiscard]] double seen_by(std::uint32_t n) const;
  /// Share of the area that a view sees at no flatter an angle, in radians.
  [[nodiscard]] double seen_within(double incidence) const;
};

inline double flight_report::seen_by(std::uint32_t n) const {
  const auto count = std::count_if(samples.begin(), samples.end(),
                                   [n](const seen_sample& s) { return s.n_views >= n; });
  return static_cast<double>(count) / static_cast<double>(samples.size());
}

inline double flight_report::seen_within(double incidence) const {
  const auto count = std::count_if(samples.begin(), samples.end(),
                                   [&](const seen_sample& s) { return s.incidence <= incidence; });
  return static_cast<double>(count) / static_cast<double>(samples.size());
}

namespace detail {

struct covered_area {
  std::vector<seen_sample> samples;
  double area;
};

/// Points at random, evenly by area, on the faces with some labels.
inline covered_area samples_of(const mesh::mesh& m, const measure_options& options) {
  const bool labelled = m.labels.size() == m.triangles.size();
  std::vector<double> until;  // area up to and with each face
  double area = 0;
  for (std::size_t t = 0; t < m.triangles.size(); ++t) {
    const std::uint32_t label = labelled ? m.labels[t] : 0;
    const bool counts = options.labels.empty() || (labelled && is_among(label, options.labels));
    until.push_back(area += counts ? mesh::area(m, t) : 0);
  }
  if (!(area > 0))
    throw undefined_error("survey::measure: no faces with these labels that have an area");
  random_engine random(options.seed);
  covered_area covered{{}, area};
  for (std::size_t i = 0; i < options.samples; ++i) {
    const auto face = std::upper_bound(until.begin(), until.end(), random.uniform() * area);
    const auto corner = mesh::corners(m, static_cast<std::size_t>(face - until.begin()));
    const double u = random.uniform(), v = random.uniform();
    const Eigen::Vector3d ab = corner[1] - corner[0], ac = corner[2] - corner[0];
    covered.samples.push_back({m.origin + mesh::point_in(corner, u, v), ab.cross(ac).normalized()});
  }
  return covered;
}

struct seen_points {
  std::vector<Eigen::Vector3d> position;
  std::vector<float> gsd;  ///< none where the camera has no focal length
};

/// Points in the middle of the cells of a grid over an image, where they lie on the surface.
inline seen_points points_of(const math::view& v,
                             const mesh::ray_surface& surface,
                             const measure_options& options) {
  seen_points points;
  const auto part = [](std::size_t i, std::size_t n, std::uint64_t pixels) {
    return (static_cast<double>(i) + 0.5) / static_cast<double>(n) * static_cast<double>(pixels);
  };
  for (std::size_t y = 0; y < options.rows; ++y) {
    for (std::size_t x = 0; x < options.columns; ++x) {
      const auto ray = math::unproject(v.camera, {part(x, options.columns, v.camera.width),
                                                  part(y, options.rows, v.camera.height)});
      if (!ray) continue;
      const Eigen::Vector3d direction = v.world_from_camera.rotation * *ray;
      const Eigen::Vector3d& from = v.world_from_camera.translation;
      const auto hit = surface.first_hit(from, direction, options.max_distance);
      if (!hit || !is_among(surface.label_at(hit->place), options.labels)) continue;
      points.position.push_back(from + hit->distance * direction);
      if (v.camera.has_focal())
        points.gsd.push_back(static_cast<float>(hit->distance * ray->z() / v.camera.fx()));
    }
  }
  return points;
}

/// Angle from a view to the one that faces the surface.
inline double off_normal(const math::view& v,
                         const mesh::ray_surface& surface,
                         const measure_options& options) {
  const auto facing = facing_direction(v.world_from_camera, v.camera, surface, options.max_distance,
                                       options.labels);
  if (!facing) return std::numeric_limits<double>::quiet_NaN();
  const Eigen::Vector3d ahead = v.world_from_camera.rotation.col(2);
  return std::atan2(ahead.cross(*facing).norm(), ahead.dot(*facing));
}

/// Whether the surface lets a view see a point that lies in its image.
inline bool sees(const math::view& v,
                 const Eigen::Vector3d& p,
                 const mesh::ray_surface& surface,
                 const measure_options& options) {
  const Eigen::Vector3d& from = v.world_from_camera.translation;
  const double distance = (p - from).norm();
  return distance <= options.max_distance && math::is_in_image(v, p) &&
         surface.sees(from, p, options.tolerance * distance);
}

struct frames_report {
  std::vector<double> overlap;
  std::vector<float> gsd;
  std::vector<double> off_normal;
};

inline frames_report measure_frames(std::span<const math::view> views,
                                    const mesh::ray_surface& surface,
                                    const measure_options& options) {
  std::vector<std::vector<float>> gsd(views.size());
  std::vector<double> overlap(views.size() - 1, std::numeric_limits<double>::quiet_NaN());
  std::vector<double> off(views.size());
  for_each_chunk(views.size(), 4, options.threads, options.control, [&](const chunk& c) {
    for (std::size_t i = c.begin; i < c.end; ++i) {
      off[i] = off_normal(views[i], surface, options);
      seen_points points = points_of(views[i], surface, options);
      gsd[i] = std::move(points.gsd);
      if (i + 1 == views.size() || points.position.empty()) continue;
      const auto seen = std::count_if(
          points.position.begin(), points.position.end(),
          [&](const Eigen::Vector3d& p) { return sees(views[i + 1], p, surface, options); });
      overlap[i] = static_cast<double>(seen) / static_cast<double>(points.position.size());
    }
  });
  frames_report report{std::move(overlap), {}, std::move(off)};
  for (const std::vector<float>& of_view : gsd)
    report.gsd.insert(report.gsd.end(), of_view.begin(), of_view.end());
  return report;
}

/// The samples with what the views see of them.
inline std::vector<seen_sample> seen_from(std::span<const math::view> views,
                                          std::vector<seen_sample> samples,
                                          const mesh::ray_surface& surface,
                                          const measure_options& options) {
  const std::vector<math::view_cone> cones(views.begin(), views.end());
  for_each_chunk(samples.size(), 64, options.threads, options.control, [&](const chunk& c) {
    for (std::size_t i = c.begin; i < c.end; ++i) {
      seen_sample& s = samples[i];
      for (std::size_t k = 0; k < views.size(); ++k) {
        if (!cones[k].may_contain(s.position)) continue;
        const Eigen::Vector3d way = views[k].world_from_camera.translation - s.position;
        const double incidence =
            std::atan2(way.cross(s.normal).norm(), std::abs(way.dot(s.normal)));
        if (incidence > options.max_incidence) continue;
        if (!sees(views[k], s.position, surface, options)) continue;
        ++s.n_views;
        s.incidence = std::min(s.incidence, incidence);
      }
    }
  });
  return samples;
}

}  // namespace detail

inline namespace AIB_ISA {

/// Casts rays at a mesh to find what a flight sees of it: overlap of consecutive frames, ground
/// sampling distances, and by how many views and how steeply its surface is seen.
///
/// views     in the order of flight; poses that are finite
/// surface   of the mesh
///
/// Where labels are given, faces with others hide what is behind them and do not count.
/// Both sides of a face count. The same numbers for any number of threads. Throws undefined_error
/// where there is no view or nothing to cover, argument_error where there is no sample or ray.
[[nodiscard]] inline flight_report measure(std::span<const math::view> views,
                                           const mesh::mesh& m,
                                           const mesh::ray_surface& surface,
                                           const measure_options& options = {}) {
  if (views.empty()) throw undefined_error("survey::measure: no view");
  if (options.samples == 0 || options.columns == 0 || options.rows == 0)
    throw argument_error("survey::measure: a sample and a ray or more expected");
  auto [samples, area] = detail::samples_of(m, options);
  auto frames = detail::measure_frames(views, surface, options);
  return {.overlap = std::move(frames.overlap),
          .gsd = std::move(frames.gsd),
          .n_rays = views.size() * options.columns * options.rows,
          .off_normal = std::move(frames.off_normal),
          .area = area,
          .samples = detail::seen_from(views, std::move(samples), surface, options)};
}

}  // namespace AIB_ISA
}  // namespace aib::survey
