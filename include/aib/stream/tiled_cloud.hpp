// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/origin.hpp>
#include <aib/cloud/positions.hpp>
#include <aib/core/error.hpp>
#include <aib/core/executor.hpp>
#include <aib/io/ply_positions.hpp>
#include <aib/stream/partition.hpp>
#include <aib/stream/spill.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <utility>
#include <vector>

namespace aib::stream {

/// A cloud on disk: how many points it has, and the origin that a reader would give it.
struct cloud_file {
  std::filesystem::path path;
  std::uint64_t size = 0;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
};

/// Looks through a file for its origin, as io::read_ply_cloud finds it.
[[nodiscard]] inline cloud_file open_cloud(const std::filesystem::path& path,
                                           const control& control = {}) {
  io::ply_positions positions(path);
  cloud_file file{.path = path, .size = positions.size()};
  if (positions.is_float()) return file;
  cloud::origin_finder origin(file.size);
  std::vector<Eigen::Vector3d> block;
  while (positions.next(block)) {
    demand_go(control);
    for (const Eigen::Vector3d& p : block) origin.add(p);
  }
  file.origin = origin.result();
  return file;
}

namespace detail {

/// Calls `visit(index, point)` for each point as a cloud in memory has it, counted from `origin`.
template <class Visit>
void for_each_point(const cloud_file& file,
                    const Eigen::Vector3d& origin,
                    const control& control,
                    Visit&& visit) {
  const Eigen::Vector3d shift = file.origin - origin;
  io::ply_positions positions(file.path);
  std::vector<Eigen::Vector3d> block;
  std::vector<Eigen::Vector3f> stored;
  std::uint64_t index = 0;
  while (positions.next(block)) {
    demand_go(control);
    // In two loops: of a float that is not stored between its two conversions, x +
    // double(float(y)), GCC 12 leaves out the rounding from -O2 on.
    stored.clear();
    for (const Eigen::Vector3d& p : block) stored.emplace_back((p - file.origin).cast<float>());
    for (const Eigen::Vector3f& s : stored) {
      const Eigen::Vector3d moved = shift + s.cast<double>();
      const Eigen::Vector3f p = moved.cast<float>();
      visit(index++, point{p.x(), p.y(), p.z()});
    }
  }
}

}  // namespace detail

[[nodiscard]] inline bool is_finite(const point& p) { return cloud::is_finite({p[0], p[1], p[2]}); }

/// A box in float, empty until something is added.
struct float_box {
  point low{HUGE_VALF, HUGE_VALF, HUGE_VALF};
  point high{-HUGE_VALF, -HUGE_VALF, -HUGE_VALF};

  void add(const point& p) {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], p[k]);
      high[k] = std::max(high[k], p[k]);
    }
  }

  /// Not above the squared distance, calculated in float, to any point in the box: each operation
  /// rounds once, and rounding keeps order.
  [[nodiscard]] float squared_distance(const point& p) const {
    float d[3];
    for (std::size_t k = 0; k < 3; ++k) d[k] = std::max({low[k] - p[k], p[k] - high[k], 0.0f});
    return (d[0] * d[0] + d[1] * d[1]) + d[2] * d[2];
  }
};

/// The points of one tile, in the order of their file.
struct tile {
  spill<point> points;
  float_box box;
};

/// A cloud in tiles on disk.
struct tiled_cloud {
  static constexpr std::uint16_t nowhere = 0xffff;  ///< tile of a point that is not finite

  std::vector<tile> tiles;
  spill<std::uint16_t> tile_of;  ///< of each point, in the order of the file
  std::uint64_t n_finite = 0;

  tiled_cloud(const cloud_file& file,
              const Eigen::Vector3d& origin,
              const partition& cuts,
              const std::filesystem::path& folder,
              const control& control)
      : tile_of(folder) {
    for (std::size_t t = 0; t < cuts.size(); ++t) tiles.push_back({spill<point>(folder), {}});
    detail::for_each_point(file, origin, control, [&](std::uint64_t, const point& p) {
      const std::uint16_t t = is_finite(p) ? cuts.tile_of(p) : nowhere;
      tile_of.append(t);
      if (t == nowhere) return;
      tiles[t].points.append(p);
      tiles[t].box.add(p);
      ++n_finite;
    });
  }
};

/// Every k-th finite point, at most about n.
inline void add_sample(const cloud_file& file,
                       const Eigen::Vector3d& origin,
                       std::uint64_t n,
                       const control& control,
                       std::vector<point>& sample) {
  const std::uint64_t step = std::max<std::uint64_t>(1, file.size / n);
  detail::for_each_point(file, origin, control, [&](std::uint64_t i, const point& p) {
    if (i % step == 0 && is_finite(p)) sample.push_back(p);
  });
}

}  // namespace aib::stream
