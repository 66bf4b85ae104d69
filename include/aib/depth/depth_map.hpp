// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/raster/image.hpp>

#include <cmath>
#include <string>
#include <vector>

namespace aib::depth {

/// Planar depth of a view: distance along the optical axis, in the unit of its source.
/// A pixel is valid where it is finite and > 0; readers turn the background markers of their source
/// into 0.
template <class Scalar>
struct basic_depth_map {
  raster::image<Scalar> values;
  std::vector<std::string> warnings = {};  ///< what the reader removed or doubts, a sentence each
};

using depth_map = basic_depth_map<float>;

template <class Scalar>
[[nodiscard]] bool is_valid(Scalar depth) {
  return std::isfinite(depth) && depth > 0;
}

}  // namespace aib::depth
