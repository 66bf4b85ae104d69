// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/random.hpp>
#include <aib/raster/image.hpp>

#include <cmath>
#include <cstddef>

/// Depth maps made for tests, and what their errors are in long double.
namespace aib::synthetic {

struct frame {
  raster::image<float> estimate;
  raster::image<float> reference;
};

struct frame_options {
  std::size_t width = 320;
  std::size_t height = 200;
  double scale = 0.37;  ///< of the estimate
  double noise = 0.01;  ///< relative, uniform
};

/// A slanted plane, every 7th pixel sky, and its noisy, scaled estimate.
inline frame noisy_frame(const frame_options& o) {
  frame f{raster::image<float>(o.width, o.height), raster::image<float>(o.width, o.height)};
  random_engine random;
  for (std::size_t y = 0; y < o.height; ++y) {
    for (std::size_t x = 0; x < o.width; ++x) {
      const double depth = 2 + 0.01 * static_cast<double>(x) + 0.02 * static_cast<double>(y);
      f.reference(x, y) = (x + y) % 7 ? static_cast<float>(depth) : 0;
      f.estimate(x, y) = static_cast<float>(static_cast<double>(f.reference(x, y)) * o.scale) *
                         static_cast<float>(1 + o.noise * random.uniform(-1, 1));
    }
  }
  return f;
}

struct moments {
  double variance;
  double mean_square;
};

/// Of ln(reference / estimate) over valid pixels: two passes of long double and std::log.
inline moments log_moments(const raster::image<float>& estimate,
                           const raster::image<float>& reference) {
  long double n = 0, sum = 0, squares = 0, spread = 0;
  const auto log_ratio = [&](std::size_t i) {
    return std::log(static_cast<long double>(reference.data()[i])) -
           std::log(static_cast<long double>(estimate.data()[i]));
  };
  const auto valid = [&](std::size_t i) {
    return estimate.data()[i] > 0 && reference.data()[i] > 0;
  };
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    if (!valid(i)) continue;
    ++n;
    sum += log_ratio(i);
    squares += log_ratio(i) * log_ratio(i);
  }
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    if (valid(i)) spread += (log_ratio(i) - sum / n) * (log_ratio(i) - sum / n);
  }
  return {static_cast<double>(spread / n), static_cast<double>(squares / n)};
}

}  // namespace aib::synthetic
