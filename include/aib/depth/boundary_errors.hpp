// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/depth/depth_map.hpp>
#include <aib/raster/canny.hpp>
#include <aib/raster/image.hpp>
#include <aib/raster/view.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>

namespace aib::depth {

/// How far the depth edges of an estimate lie from those of the truth, pixels.
struct boundary_errors {
  double accuracy;          ///< mean distance of estimated edges, of those nearer than 10 pixels
  double completeness;      ///< mean distance of both from each other, cut at 10 pixels
  std::size_t n_estimate;   ///< pixels of estimated edges
  std::size_t n_reference;  ///< pixels of true edges
};

/// Depth edges as iBims-1 finds them: Canny (sigma root 2, 0.15, 0.3) of the map scaled to 0..1. A
/// pixel without depth hides the edges near it. Without two different depths there is no edge.
[[nodiscard]] raster::image<std::uint8_t> depth_edges(raster::view<const float> depth);

/// Depth boundary errors (DBE). `edges` are the true ones, not 0: drawn by hand, or depth_edges of
/// the reference. Without an estimated edge near a true one both errors are 10.
///
/// Throws argument_error if the sizes differ, undefined_error if there is no true edge.
/// Source: Koch et al., "Evaluation of CNN-based single-image depth estimation methods", 2018,
/// Eqs. (9), (10), as iBims-1's Python script calculates them.
[[nodiscard]] boundary_errors boundary_error(raster::view<const float> estimate,
                                             raster::view<const std::uint8_t> edges);

namespace detail {

inline constexpr std::size_t edge_reach = 10;

/// Distance to the nearest edge pixel, at most edge_reach.
inline double distance_to(raster::view<const std::uint8_t> edges, std::size_t x, std::size_t y) {
  std::size_t least = edge_reach * edge_reach;
  const auto low = [](std::size_t i) { return i - std::min(i, edge_reach); };
  for (std::size_t v = low(y); v < std::min(y + edge_reach + 1, edges.height); ++v) {
    for (std::size_t u = low(x); u < std::min(x + edge_reach + 1, edges.width); ++u) {
      const std::size_t dx = u > x ? u - x : x - u, dy = v > y ? v - y : y - v;
      if (edges(u, v) && dx * dx + dy * dy < least) least = dx * dx + dy * dy;
    }
  }
  return std::sqrt(static_cast<double>(least));
}

/// Distances of edge pixels to the nearest of other edges.
struct edge_distances {
  std::size_t n = 0;
  double sum = 0;
  std::size_t n_near = 0;  ///< nearer than edge_reach
  double sum_near = 0;
};

inline edge_distances distances_of(raster::view<const std::uint8_t> edges,
                                   raster::view<const std::uint8_t> others) {
  edge_distances d;
  for (std::size_t y = 0; y < edges.height; ++y) {
    for (std::size_t x = 0; x < edges.width; ++x) {
      if (!edges(x, y)) continue;
      const double distance = distance_to(others, x, y);
      ++d.n;
      d.sum += distance;
      if (distance >= edge_reach) continue;
      ++d.n_near;
      d.sum_near += distance;
    }
  }
  return d;
}

}  // namespace detail

inline raster::image<std::uint8_t> depth_edges(raster::view<const float> depth) {
  constexpr float none = std::numeric_limits<float>::quiet_NaN();
  float least = std::numeric_limits<float>::infinity(), most = 0;
  for (std::size_t y = 0; y < depth.height; ++y) {
    for (const float z : depth.row(y)) {
      if (!is_valid(z)) continue;
      least = std::min(least, z);
      most = std::max(most, z);
    }
  }
  raster::image<float> scaled(depth.width, depth.height, none);
  if (!(most > least)) return {depth.width, depth.height};
  for (std::size_t y = 0; y < depth.height; ++y) {
    for (std::size_t x = 0; x < depth.width; ++x) {
      if (is_valid(depth(x, y))) scaled(x, y) = (depth(x, y) - least) / (most - least);
    }
  }
  return raster::canny(scaled, {.sigma = std::numbers::sqrt2, .low = 0.15, .high = 0.3});
}

inline boundary_errors boundary_error(raster::view<const float> estimate,
                                      raster::view<const std::uint8_t> edges) {
  if (estimate.width != edges.width || estimate.height != edges.height) {
    throw argument_error(message("depth::boundary_error: the estimate is ", estimate.width, "x",
                                 estimate.height, ", the edges are ", edges.width, "x",
                                 edges.height));
  }
  const raster::image<std::uint8_t> found = depth_edges(estimate);
  const detail::edge_distances of_estimate = detail::distances_of(found, edges);
  const detail::edge_distances of_reference = detail::distances_of(edges, found);
  if (of_reference.n == 0) throw undefined_error("depth::boundary_error: no true edge");
  boundary_errors out{detail::edge_reach, detail::edge_reach, of_estimate.n, of_reference.n};
  if (of_estimate.n_near == 0) return out;
  out.accuracy = of_estimate.sum_near / static_cast<double>(of_estimate.n_near);
  out.completeness =
      (of_estimate.sum + of_reference.sum) / static_cast<double>(of_estimate.n + of_reference.n);
  return out;
}

}  // namespace aib::depth
