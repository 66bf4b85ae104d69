// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/depth/depth_map.hpp>
#include <aib/raster/image.hpp>
#include <aib/raster/view.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace aib::depth {

/// What a pixel of a reference shows. The numbers are labels for errors_by_label.
enum class stratum : std::uint16_t {
  nothing = 0,  ///< no valid depth
  inside = 1,   ///< a surface, away from its edges
  edge = 2,     ///< near a jump of the depth, on either side
  thin = 3,     ///< a bar, cable or rail with farther things (or sky) on both sides
};

struct strata_options {
  double jump = 0.1;  ///< neighbours are apart where one depth exceeds the other by this share
  std::size_t edge_width = 2;  ///< pixels from a jump that are still at the edge
  std::size_t thin_width = 8;  ///< pixels across, along the row or the column
};

/// Sorts the pixels of a reference into strata: global errors hide what is wrong at edges and in
/// thin structures. A pixel without depth counts as farther than any other: sky. What lies at the
/// border of the image is not known to end there. Throws argument_error if jump <= 0.
[[nodiscard]] raster::image<std::uint16_t> strata(raster::view<const float> reference,
                                                  const strata_options& options = {});

namespace detail {

/// A line of pixels: a row or a column.
struct pixel_line {
  const float* depth;
  std::uint16_t* stratum;
  std::size_t size;
  std::size_t depth_step;
  std::size_t stratum_step;

  [[nodiscard]] double at(std::size_t i) const {
    return static_cast<double>(depth[i * depth_step]);
  }
  [[nodiscard]] std::uint16_t& mark(std::size_t i) const { return stratum[i * stratum_step]; }
};

/// Whether pixel i lies farther than its neighbour j by a jump.
inline bool is_farther(const pixel_line& line, std::size_t i, std::size_t j, double jump) {
  return is_valid(line.at(j)) && (!is_valid(line.at(i)) || line.at(i) > (1 + jump) * line.at(j));
}

inline bool has_jump(const pixel_line& line, std::size_t i, double jump) {
  return is_farther(line, i, i + 1, jump) || is_farther(line, i + 1, i, jump);
}

/// Marks the valid pixels from `first` to before `end` that are less than `to`.
inline void raise(const pixel_line& line, std::size_t first, std::size_t end, stratum to) {
  for (std::size_t i = first; i < end; ++i) {
    if (is_valid(line.at(i))) line.mark(i) = std::max(line.mark(i), static_cast<std::uint16_t>(to));
  }
}

inline void mark_line(const pixel_line& line, const strata_options& o) {
  std::size_t first = 0;  // of the run that ends at the jump
  for (std::size_t i = 0; i + 1 < line.size; ++i) {
    if (!has_jump(line, i, o.jump)) continue;
    const std::size_t left = i + 1 > o.edge_width ? i + 1 - o.edge_width : 0;
    raise(line, left, std::min(line.size, i + 1 + o.edge_width), stratum::edge);
    const bool in_front = first > 0 && is_farther(line, first - 1, first, o.jump) &&
                          is_farther(line, i + 1, i, o.jump);
    if (in_front && i + 1 - first <= o.thin_width) raise(line, first, i + 1, stratum::thin);
    first = i + 1;
  }
}

}  // namespace detail

inline raster::image<std::uint16_t> strata(raster::view<const float> reference,
                                           const strata_options& options) {
  if (!(options.jump > 0)) {
    throw argument_error(message("depth::strata: jump > 0 expected, found ", options.jump));
  }
  raster::image<std::uint16_t> image(reference.width, reference.height);
  const auto line = [&](std::size_t x, std::size_t y) {
    return detail::pixel_line{&reference(x, y), &image(x, y), 0, 0, 0};
  };
  for (std::size_t y = 0; y < reference.height && reference.width > 0; ++y) {
    detail::pixel_line row = line(0, y);
    row.size = reference.width;
    row.depth_step = row.stratum_step = 1;
    detail::raise(row, 0, row.size, stratum::inside);
    detail::mark_line(row, options);
  }
  for (std::size_t x = 0; x < reference.width && reference.height > 0; ++x) {
    detail::pixel_line column = line(x, 0);
    column.size = reference.height;
    column.depth_step = reference.stride;
    column.stratum_step = image.width();
    detail::mark_line(column, options);
  }
  return image;
}

}  // namespace aib::depth
