// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/raster/image.hpp>

#include <array>
#include <cstddef>
#include <cstdint>

namespace aib::raster {

/// Red, green, blue, 8 bits each, sRGB as in PNG and JPEG files.
using rgb = std::array<std::uint8_t, 3>;

using color_image = image<rgb>;

/// A whole number a pixel: classes, or a mask where 0 is outside.
using label_image = image<std::uint16_t>;

/// 1 where the label is not 0.
[[nodiscard]] inline image<std::uint8_t> mask_of(const label_image& labels) {
  image<std::uint8_t> mask(labels.width(), labels.height());
  for (std::size_t i = 0; i < labels.size(); ++i) mask.data()[i] = labels.data()[i] != 0;
  return mask;
}

}  // namespace aib::raster
