// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/depth/depth_map.hpp>
#include <aib/depth/errors.hpp>
#include <aib/raster/color.hpp>
#include <aib/raster/colormap.hpp>
#include <aib/raster/draw.hpp>
#include <aib/raster/view.hpp>
#include <aib/stats/quantiles.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace aib::depth {

struct error_image_options {
  error_options errors = {};  ///< which pixels count, and what takes the estimate to the reference
  double near = 0;            ///< depth of the first colour; 0: 1 % of the references are nearer
  double far = 0;             ///< depth of the last colour; 0: 1 % of the references are farther
  double largest = 0;  ///< relative error of the last colour; 0: 95 % of the errors are smaller
};

/// Three panels side by side: the estimate as transformed, the reference, and the signed error
/// (estimate - reference) / reference. Depths share one scale from blue (near) to yellow (far);
/// the error is blue where the estimate is too near, red where it is too far. Pixels without a
/// value are hatched grey. Below are the scales with their numbers.
///
/// Throws as `errors` does.
[[nodiscard]] raster::color_image error_image(const depth_map& estimate,
                                              const depth_map& reference,
                                              const error_image_options& options = {});

namespace detail {

/// The largest and smallest number that colours stand for.
struct color_range {
  double low;
  double high;
};

inline raster::rgb hatch(std::size_t x, std::size_t y) {
  const std::uint8_t grey = (x + y) / 3 % 2 ? 120 : 95;
  return {grey, grey, grey};
}

/// "12.3": four characters or so, plain notation.
inline std::string short_number(double value) {
  const double size = std::abs(value);
  if (size == 0) return "0";
  const int digits = size >= 100 ? 0 : size >= 10 ? 1 : size >= 0.1 ? 2 : 4;
  char text[64];
  const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, digits);
  return {text, end.ptr};
}

/// A bar of colours with its lowest, middle and highest number below.
template <class Color>
raster::color_image scale_bar(
    std::size_t width, const color_range& range, double unit, const char* suffix, Color color) {
  constexpr std::size_t bar = 12, gap = 4, scale = 2;
  raster::color_image image(width, bar + 2 * gap + raster::character_height * scale,
                            {255, 255, 255});
  for (std::size_t x = 0; x < width; ++x) {
    const double share = (static_cast<double>(x) + 0.5) / static_cast<double>(width);
    for (std::size_t y = 0; y < bar; ++y) image(x, y) = color(share);
  }
  const std::string labels[] = {short_number(range.low * unit) + suffix,
                                short_number((range.low + range.high) / 2 * unit) + suffix,
                                short_number(range.high * unit) + suffix};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t length = labels[i].size() * raster::character_width * scale;
    const std::size_t room = width > length ? width - length : 0;
    raster::draw_number(image, labels[i], room * i / 2, bar + gap, {0, 0, 0}, scale);
  }
  return image;
}

/// What the pictures show, pixel by pixel; NaN where there is nothing.
struct error_panels {
  raster::image<double> estimate;
  raster::image<double> reference;
  raster::image<double> relative;
};

inline error_panels panels_of(const depth_map& estimate,
                              const depth_map& reference,
                              const error_options& options,
                              const affine& transform) {
  const std::size_t width = estimate.values.width(), height = estimate.values.height();
  const raster::image<double> nothing(width, height, std::numeric_limits<double>::quiet_NaN());
  error_panels panels{nothing, nothing, nothing};
  const auto mask = options.mask;
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      if (mask.data && mask(x, y) == 0) continue;
      const double raw = static_cast<double>(estimate.values(x, y));
      const double r = static_cast<double>(reference.values(x, y));
      const double e =
          std::clamp(transform.scale * raw + transform.shift, options.clamp_min, options.clamp_max);
      const bool has_estimate = is_valid(raw) && is_valid(e);
      const bool has_reference = r > options.min && r < options.max;
      if (has_estimate) panels.estimate(x, y) = e;
      if (has_reference) panels.reference(x, y) = r;
      if (has_estimate && has_reference) panels.relative(x, y) = (e - r) / r;
    }
  }
  return panels;
}

inline std::vector<double> numbers_of(const raster::image<double>& image) {
  std::vector<double> numbers;
  std::copy_if(image.begin(), image.end(), std::back_inserter(numbers),
               [](double v) { return std::isfinite(v); });
  return numbers;
}

template <class Color>
raster::color_image painted(const raster::image<double>& numbers,
                            const color_range& range,
                            Color color) {
  raster::color_image image(numbers.width(), numbers.height());
  for (std::size_t y = 0; y < image.height(); ++y) {
    for (std::size_t x = 0; x < image.width(); ++x) {
      const double v = numbers(x, y);
      image(x, y) =
          std::isfinite(v) ? color((v - range.low) / (range.high - range.low)) : hatch(x, y);
    }
  }
  return image;
}

inline color_range depth_range(const error_panels& panels, const error_image_options& options) {
  std::vector<double> depths = numbers_of(panels.reference);
  color_range range{options.near, options.far};
  if (!(range.low > 0)) range.low = stats::quantile_in_place<double>(depths, 0.01);
  if (!(range.high > 0)) range.high = stats::quantile_in_place<double>(depths, 0.99);
  if (!(range.high > range.low)) range.high = range.low * 1.01;
  return range;
}

inline color_range error_range(const error_panels& panels, const error_image_options& options) {
  double largest = options.largest;
  if (!(largest > 0)) {
    std::vector<double> errors = numbers_of(panels.relative);
    for (double& e : errors) e = std::abs(e);
    largest = std::max(stats::quantile_in_place<double>(errors, 0.95), 1e-6);
  }
  return {-largest, largest};
}

}  // namespace detail

inline raster::color_image error_image(const depth_map& estimate,
                                       const depth_map& reference,
                                       const error_image_options& options) {
  const frame_sums frame = measure(estimate.values.view(), reference.values.view(), options.errors);
  (void)summarize(frame.sums);  // throws where there is nothing to show
  const auto panels = detail::panels_of(estimate, reference, options.errors, frame.transform);
  const auto depths = detail::depth_range(panels, options);
  const auto errors = detail::error_range(panels, options);
  const auto sequential = [](double share) { return raster::sequential_color(share); };
  const auto diverging = [](double share) { return raster::diverging_color(2 * share - 1); };

  constexpr std::size_t gap = 6;
  const std::size_t width = estimate.values.width(), height = estimate.values.height();
  const auto depth_bar = detail::scale_bar(2 * width + gap, depths, 1, "", sequential);
  const auto error_bar = detail::scale_bar(width, errors, 100, "%", diverging);
  raster::color_image image(3 * width + 4 * gap, height + 3 * gap + depth_bar.height(),
                            {255, 255, 255});
  const std::size_t second = width + 2 * gap, third = 2 * width + 3 * gap;
  raster::paste(image, detail::painted(panels.estimate, depths, sequential), gap, gap);
  raster::paste(image, detail::painted(panels.reference, depths, sequential), second, gap);
  raster::paste(image, detail::painted(panels.relative, errors, diverging), third, gap);
  raster::paste(image, depth_bar, gap, height + 2 * gap);
  raster::paste(image, error_bar, third, height + 2 * gap);
  return image;
}

}  // namespace aib::depth
