// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/raster/color.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace aib::raster {

/// A colour whose distances are those that people see.
/// Source: Ottosson, "A perceptual color space for image processing", 2020.
struct oklab {
  double lightness;  ///< 0 black, 1 white
  double a;          ///< green to red
  double b;          ///< blue to yellow
};

[[nodiscard]] oklab to_oklab(const rgb& color);

/// Colours outside of sRGB are cut channel by channel.
[[nodiscard]] rgb to_rgb(const oklab& color);

/// The colour at t in [0, 1] from dark blue to light yellow, in equal steps to the eye; readable
/// with red-green blindness and in print. t is clamped, NaN is 0.
[[nodiscard]] rgb sequential_color(double t);

/// The colour at t in [-1, 1]: blue, light grey at 0, red; equal steps to the eye on both sides.
/// t is clamped, NaN is 0.
[[nodiscard]] rgb diverging_color(double t);

namespace detail {

inline double to_linear(std::uint8_t channel) {
  const double c = channel / 255.0;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

inline std::uint8_t from_linear(double c) {
  const double encoded = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(encoded, 0.0, 1.0)));
}

inline oklab mix(const oklab& from, const oklab& to, double t) {
  const auto between = [t](double x, double y) { return x + (y - x) * t; };
  return {between(from.lightness, to.lightness), between(from.a, to.a), between(from.b, to.b)};
}

inline constexpr std::size_t color_steps = 256;

/// Colours of t = 0, 1/255, ... 1 on the straight line between two colours.
inline std::array<rgb, color_steps> color_table(const rgb& from, const rgb& to) {
  std::array<rgb, color_steps> table;
  const oklab first = to_oklab(from), last = to_oklab(to);
  for (std::size_t i = 0; i < color_steps; ++i)
    table[i] = to_rgb(mix(first, last, static_cast<double>(i) / (color_steps - 1)));
  return table;
}

inline const rgb& at(const std::array<rgb, color_steps>& table, double t) {
  const double place = t > 0 ? std::min(t, 1.0) * (color_steps - 1) : 0;
  return table[static_cast<std::size_t>(place + 0.5)];
}

}  // namespace detail

inline oklab to_oklab(const rgb& color) {
  const double r = detail::to_linear(color[0]);
  const double g = detail::to_linear(color[1]);
  const double b = detail::to_linear(color[2]);
  const double l = std::cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b);
  const double m = std::cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b);
  const double s = std::cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
  return {0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s,
          1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s,
          0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s};
}

inline rgb to_rgb(const oklab& c) {
  const auto cube = [](double x) { return x * x * x; };
  const double l = cube(c.lightness + 0.3963377774 * c.a + 0.2158037573 * c.b);
  const double m = cube(c.lightness - 0.1055613458 * c.a - 0.0638541728 * c.b);
  const double s = cube(c.lightness - 0.0894841775 * c.a - 1.2914855480 * c.b);
  return {detail::from_linear(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
          detail::from_linear(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
          detail::from_linear(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s)};
}

inline rgb sequential_color(double t) {
  static const auto table = detail::color_table({0, 32, 96}, {255, 233, 69});
  return detail::at(table, t);
}

inline rgb diverging_color(double t) {
  static const auto below = detail::color_table({238, 238, 238}, {20, 70, 170});
  static const auto above = detail::color_table({238, 238, 238}, {170, 30, 40});
  return t < 0 ? detail::at(below, -t) : detail::at(above, t);
}

}  // namespace aib::raster
