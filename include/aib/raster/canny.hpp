// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/raster/image.hpp>
#include <aib/raster/view.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace aib::raster {

struct canny_options {
  double sigma = 1;   ///< of the Gaussian, pixels; cut off at four of them
  double low = 0.1;   ///< Sobel gradients (8 times the slope) from here on continue an edge
  double high = 0.2;  ///< and from here on begin one
};

/// Edges of a picture, one pixel wide: 1, else 0. The outermost pixels are no edges, nor is a pixel
/// whose surroundings hold a NaN. Beyond the picture nothing is weighed. Source: Canny, "A
/// computational approach to edge detection", PAMI 1986, as scikit-image has it.
[[nodiscard]] image<std::uint8_t> canny(view<const float> picture,
                                        const canny_options& options = {});

namespace detail {

inline std::vector<double> gaussian_weights(double sigma) {
  const auto radius = static_cast<std::size_t>(4 * sigma + 0.5);
  std::vector<double> weights(2 * radius + 1);
  double sum = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double x = static_cast<double>(i) - static_cast<double>(radius);
    sum += weights[i] = std::exp(-0.5 * x * x / (sigma * sigma));
  }
  for (double& w : weights) w /= sum;
  return weights;
}

enum class axis { x, y };

/// Sums along an axis, weighted; beyond the picture there is 0.
inline image<float> summed_along(const image<float>& from,
                                 const std::vector<double>& weights,
                                 axis along) {
  const std::size_t radius = weights.size() / 2;
  const bool rows = along == axis::x;
  const std::size_t length = rows ? from.width() : from.height();
  image<float> to(from.width(), from.height());
  for (std::size_t y = 0; y < from.height(); ++y) {
    for (std::size_t x = 0; x < from.width(); ++x) {
      const std::size_t at = rows ? x : y;
      double sum = 0;
      for (std::size_t k = at < radius ? radius - at : 0;
           k < weights.size() && at + k - radius < length; ++k) {
        const std::size_t i = at + k - radius;
        sum += weights[k] * static_cast<double>(rows ? from(i, y) : from(x, i));
      }
      to(x, y) = static_cast<float>(sum);
    }
  }
  return to;
}

/// What of the weights falls inside, for each place of an axis.
inline std::vector<double> weight_inside(const std::vector<double>& weights, std::size_t length) {
  const std::size_t radius = weights.size() / 2;
  std::vector<double> inside(length);
  for (std::size_t at = 0; at < length; ++at) {
    for (std::size_t k = 0; k < weights.size(); ++k)
      if (at + k >= radius && at + k - radius < length) inside[at] += weights[k];
  }
  return inside;
}

/// Gaussian mean over what lies inside of the picture.
inline image<float> smoothed(const image<float>& picture, double sigma) {
  const std::vector<double> weights = gaussian_weights(sigma);
  image<float> smooth = summed_along(summed_along(picture, weights, axis::y), weights, axis::x);
  const std::vector<double> across = weight_inside(weights, picture.width());
  const std::vector<double> down = weight_inside(weights, picture.height());
  for (std::size_t y = 0; y < picture.height(); ++y) {
    for (std::size_t x = 0; x < picture.width(); ++x)
      smooth(x, y) = static_cast<float>(static_cast<double>(smooth(x, y)) / (across[x] * down[y]));
  }
  return smooth;
}

/// Sobel gradients; beyond the picture its outermost pixels go on.
struct gradients {
  image<float> x, y, magnitude;
};

inline gradients sobel(const image<float>& p) {
  const image<float> blank(p.width(), p.height());
  gradients g{blank, blank, blank};
  for (std::size_t y = 0; y < p.height(); ++y) {
    const std::size_t up = y > 0 ? y - 1 : y, down = y + 1 < p.height() ? y + 1 : y;
    for (std::size_t x = 0; x < p.width(); ++x) {
      const std::size_t left = x > 0 ? x - 1 : x, right = x + 1 < p.width() ? x + 1 : x;
      const auto across = [&](std::size_t v) { return p(right, v) - p(left, v); };
      const auto along = [&](std::size_t u) { return p(u, down) - p(u, up); };
      g.x(x, y) = across(up) + 2 * across(y) + across(down);
      g.y(x, y) = along(left) + 2 * along(x) + along(right);
      g.magnitude(x, y) = std::hypot(g.x(x, y), g.y(x, y));
    }
  }
  return g;
}

/// Whether the gradients before and behind an inner pixel, in the direction of its own, are not
/// larger. They are interpolated between two of the eight neighbours.
inline bool is_ridge(const gradients& g, std::size_t x, std::size_t y) {
  const float gx = g.x(x, y), gy = g.y(x, y), m = g.magnitude(x, y);
  if (!(m > 0)) return false;
  const bool steep = std::abs(gy) >= std::abs(gx);
  const float share = steep ? std::abs(gx / gy) : std::abs(gy / gx);
  const std::ptrdiff_t turn = (gx < 0) == (gy < 0) ? 1 : -1;
  const auto at = [&](std::ptrdiff_t dx, std::ptrdiff_t dy) {
    return g.magnitude(x + static_cast<std::size_t>(dx), y + static_cast<std::size_t>(dy));
  };
  const auto beside = [&](std::ptrdiff_t way) {
    const float straight = steep ? at(0, way) : at(way, 0);
    const float diagonal = steep ? at(turn * way, way) : at(way, turn * way);
    return diagonal * share + straight * (1 - share);
  };
  return beside(1) <= m && beside(-1) <= m;
}

/// Marks what of `candidates` hangs together with pixel `from`, over sides and corners.
inline void follow(std::size_t from,
                   const image<std::uint8_t>& candidates,
                   image<std::uint8_t>& edges) {
  std::vector<std::size_t> open = {from};
  edges.data()[from] = 1;
  while (!open.empty()) {
    const std::size_t x = open.back() % edges.width(), y = open.back() / edges.width();
    open.pop_back();
    for (std::size_t v = y - 1; v != y + 2; ++v) {  // candidates are inner pixels
      for (std::size_t u = x - 1; u != x + 2; ++u) {
        if (!candidates(u, v) || edges(u, v)) continue;
        edges(u, v) = 1;
        open.push_back(v * edges.width() + u);
      }
    }
  }
}

}  // namespace detail

inline image<std::uint8_t> canny(view<const float> picture, const canny_options& options) {
  image<float> own(picture.width, picture.height);
  for (std::size_t y = 0; y < picture.height; ++y)
    std::copy_n(picture.row(y).begin(), picture.width, own.data() + y * picture.width);
  const detail::gradients g = detail::sobel(detail::smoothed(own, options.sigma));
  image<std::uint8_t> candidates(picture.width, picture.height), edges = candidates;
  for (std::size_t y = 1; y + 1 < picture.height; ++y) {
    for (std::size_t x = 1; x + 1 < picture.width; ++x)
      candidates(x, y) =
          static_cast<double>(g.magnitude(x, y)) >= options.low && detail::is_ridge(g, x, y);
  }
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (candidates.data()[i] && !edges.data()[i] &&
        static_cast<double>(g.magnitude.data()[i]) >= options.high)
      detail::follow(i, candidates, edges);
  }
  return edges;
}

}  // namespace aib::raster
