// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/cloud.hpp>
#include <aib/core/error.hpp>
#include <aib/raster/colormap.hpp>

#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace aib::cloud {

/// The colours of numbers: grey where there is none (NaN).
enum class color_scale {
  sequential,  ///< 0 dark blue to `high` light yellow
  diverging,   ///< -high blue, 0 light grey, high red
};

/// A colour for each value; beyond `high` it is that of `high`.
/// Throws argument_error unless high > 0.
[[nodiscard]] inline std::vector<color> colors_of(std::span<const float> values,
                                                  double high,
                                                  color_scale scale = color_scale::sequential) {
  if (!(high > 0)) {
    throw argument_error(message("cloud::colors_of: high > 0 expected, found ", high));
  }
  std::vector<color> colors;
  colors.reserve(values.size());
  for (const float v : values) {
    const double place = v / high;
    colors.push_back(std::isnan(v)                     ? color{128, 128, 128}
                     : scale == color_scale::diverging ? raster::diverging_color(place)
                                                       : raster::sequential_color(place));
  }
  return colors;
}

/// The cloud in the colours of one value a point, its errors for example.
/// Throws argument_error unless there are as many values as points and high > 0.
[[nodiscard]] inline cloud colored(cloud points,
                                   std::span<const float> values,
                                   double high,
                                   color_scale scale = color_scale::sequential) {
  if (values.size() != points.size()) {
    throw argument_error(message("cloud::colored: a value for each of ", points.size(),
                                 " points expected, found ", values.size()));
  }
  points.colors = colors_of(values, high, scale);
  return points;
}

}  // namespace aib::cloud
