// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/random.hpp>
#include <aib/raster/image.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>

/// Depth as it is rendered of a truss before the sky: bars that occlude each other, flat elsewhere;
/// the estimate is a third as large, one per cent noisy, and has holes.
struct frame_pair {
  aib::raster::image<float> estimate;
  aib::raster::image<float> reference;
};

inline frame_pair made_frame(std::uint64_t seed) {
  constexpr std::size_t width = 1920, height = 1080;
  aib::random_engine random(seed + 1);
  frame_pair f{aib::raster::image<float>(width, height), aib::raster::image<float>(width, height)};
  const double turn = 0.01 * static_cast<double>(seed);
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      const auto u = static_cast<double>(x) / 240, v = static_cast<double>(y) / 240;
      const bool bar = std::sin(3 * u + v + turn) > 0.8 || std::sin(u - 3 * v) > 0.85;
      const bool sky = v < 1.2 + 0.3 * std::sin(u);
      const double depth = bar ? 8 + 0.5 * u : sky ? 0 : 20 + u + 2 * v;
      const double noisy = depth * (0.37 + 0.0037 * random.uniform(-1, 1));
      f.reference(x, y) = static_cast<float>(depth);
      f.estimate(x, y) = x % 97 < 5 && y % 89 < 7 ? 0 : static_cast<float>(noisy);
    }
  }
  return f;
}
