// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/raster/view.hpp>

#include <cstddef>

namespace aib::depth {

/// The part of a frame that is evaluated, as driving benchmarks cut it.
enum class crop_rule {
  none,
  garg,   ///< Garg et al., "Unsupervised CNN for single view depth estimation", ECCV 2016
  eigen,  ///< Eigen, Puhrsch, Fergus, NeurIPS 2014
};

namespace detail {

/// Shares of height and width; ends are truncated to whole pixels and exclusive.
struct crop_shares {
  double top, bottom, left, right;
};

constexpr crop_shares shares_of(crop_rule c) {
  switch (c) {
    case crop_rule::garg:
      return {0.40810811, 0.99189189, 0.03594771, 0.96405229};
    case crop_rule::eigen:
      return {0.3324324, 0.91351351, 0.0359477, 0.96405229};
    default:
      return {0, 1, 0, 1};
  }
}

}  // namespace detail

/// The cropped part of a view; an empty view stays empty.
template <class T>
[[nodiscard]] raster::view<T> cropped(raster::view<T> whole, crop_rule c) {
  const detail::crop_shares s = detail::shares_of(c);
  const auto at = [](double share, std::size_t size) {
    return static_cast<std::size_t>(share * static_cast<double>(size));
  };
  const std::size_t x = at(s.left, whole.width), y = at(s.top, whole.height);
  return raster::part(whole, x, y, at(s.right, whole.width) - x, at(s.bottom, whole.height) - y);
}

}  // namespace aib::depth
