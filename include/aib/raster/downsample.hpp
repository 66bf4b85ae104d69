// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/raster/image.hpp>
#include <aib/raster/view.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace aib::raster {

/// Which source pixel a target pixel takes.
enum class nearest_rule {
  centre,  ///< under the target's centre: ((2i + 1) N) div 2n
  floor,   ///< floor(i N / n), OpenCV's INTER_NEAREST
};

/// Source index of target index i when N samples become n. Integer arithmetic: ties never depend on
/// rounding.
[[nodiscard]] constexpr std::size_t nearest_index(std::size_t i,
                                                  std::size_t N,
                                                  std::size_t n,
                                                  nearest_rule rule) {
  return rule == nearest_rule::centre ? ((2 * i + 1) * N) / (2 * n) : (i * N) / n;
}

/// The image at another size by nearest neighbour: no value is made up, edges and invalid pixels do
/// not bleed. Throws argument_error if a target size is 0 or the image is empty.
template <class T>
[[nodiscard]] image<T> resample_nearest(view<const T> source,
                                        std::size_t width,
                                        std::size_t height,
                                        nearest_rule rule = nearest_rule::centre) {
  if (width == 0 || height == 0 || source.empty()) {
    throw argument_error(message("raster::resample_nearest: cannot make ", width, "x", height,
                                 " of ", source.width, "x", source.height));
  }
  std::vector<std::size_t> column(width);
  for (std::size_t x = 0; x < width; ++x) column[x] = nearest_index(x, source.width, width, rule);
  image<T> target(width, height);
  for (std::size_t y = 0; y < height; ++y) {
    const auto from = source.row(nearest_index(y, source.height, height, rule));
    for (std::size_t x = 0; x < width; ++x) target(x, y) = from[column[x]];
  }
  return target;
}

}  // namespace aib::raster
