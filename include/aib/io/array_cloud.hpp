// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/cloud.hpp>
#include <aib/core/error.hpp>
#include <aib/io/npy.hpp>
#include <aib/io/positions.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#if defined(AIB_WITH_NPZ)
#include <aib/io/npz.hpp>
#endif

namespace aib::io {

/// The points of an array whose last axis is x, y, z; the other axes are run through in their
/// order. Throws format_error for another shape.
inline cloud::cloud cloud_of_array(const array& a, const std::filesystem::path& path) {
  if (a.shape.size() < 2 || a.shape.back() != 3)
    throw format_error(path, message("an array of N x 3 expected, found ", text_of_shape(a.shape)));
  float_positions positions;
  const std::size_t n = a.size() / 3;
  if (a.type == dtype::f4 || a.type == dtype::f2) {
    const std::vector<float> values = a.values<float>();
    for (std::size_t i = 0; i < n; ++i)
      positions.points.emplace_back(values[3 * i], values[3 * i + 1], values[3 * i + 2]);
  } else {
    std::vector<Eigen::Vector3d> exact;
    for (std::size_t i = 0; i < n; ++i) exact.emplace_back(a[3 * i], a[3 * i + 1], a[3 * i + 2]);
    positions = to_floats(exact);
  }
  cloud::cloud result;
  set_positions(result, std::move(positions));
  return result;
}

/// Reads a cloud from an NPY file of N x 3 numbers.
inline cloud::cloud read_npy_cloud(const std::filesystem::path& path) {
  return cloud_of_array(read_npy(path), path);
}

#if defined(AIB_WITH_NPZ)

/// Reads a cloud from an NPZ file.
///
/// key   the array; empty: `points`, `xyz`, `pts3d` or `world_points`, else the only one whose last
///       axis is 3
///
/// 8-bit `colors` or `rgb` of the same shape come with it.
/// Throws format_error where there is no such array.
inline cloud::cloud read_npz_cloud(const std::filesystem::path& path,
                                   std::string key = {},
                                   const limits& limits = {}) {
  const npz_file file(path, limits);
  std::vector<std::string> candidates;
  for (const std::string& name : file.names()) {
    if (file.is_unreadable(name)) continue;
    const auto shape = file.read_header(name).shape;
    if (shape.size() >= 2 && shape.back() == 3) candidates.push_back(name);
    const bool usual =
        name == "points" || name == "xyz" || name == "pts3d" || name == "world_points";
    if (key.empty() && usual) key = name;
  }
  if (key.empty() && candidates.size() == 1) key = candidates.front();
  if (key.empty() || !file.contains(key))
    throw format_error(path, message("npz: ",
                                     key.empty() ? "which array holds the points?"
                                                 : message("no array \"", key, "\";"),
                                     " There are ", file.list()));
  const array points = file.read(key);
  cloud::cloud result = cloud_of_array(points, path);
  for (const char* name : {"colors", "rgb"}) {
    if (!file.contains(name) || file.is_unreadable(name)) continue;
    const array colors = file.read(name);
    if (colors.type != dtype::u1 || colors.shape != points.shape) continue;
    for (std::size_t i = 0; i < result.size(); ++i) {
      cloud::color c;
      for (std::size_t k = 0; k < 3; ++k) c[k] = static_cast<std::uint8_t>(colors[3 * i + k]);
      result.colors.push_back(c);
    }
    break;
  }
  return result;
}

#endif

}  // namespace aib::io
