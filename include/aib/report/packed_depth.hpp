// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/depth/depth_map.hpp>
#include <aib/depth/error_image.hpp>
#include <aib/depth/errors.hpp>
#include <aib/raster/image.hpp>
#include <aib/report/packed.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

namespace aib::report {

/// A frame's depths and relative errors for a page: width x height bytes a panel, row by row,
/// deflated, in base64. A byte is 0..254, 255 where there is nothing. Depths are in even steps of
/// their logarithm from `depths.low` to `depths.high`, errors in even steps of `errors`.
struct packed_frame {
  std::size_t width;
  std::size_t height;
  range depths;
  range errors;
  std::string estimate;
  std::string reference;
  std::string error;  ///< (estimate - reference) / reference
};

/// Every k-th pixel, so that at most `width` columns are left. What counts, and the ranges, are
/// those of depth::error_image. Throws as that does.
[[nodiscard]] packed_frame packed(const depth::depth_map& estimate,
                                  const depth::depth_map& reference,
                                  const depth::error_image_options& options,
                                  std::size_t width);

namespace detail {

template <class Scale>
std::string packed_panel(const raster::image<double>& panel,
                         std::size_t stride,
                         const range& r,
                         Scale scale) {
  std::string bytes;
  for (std::size_t y = stride / 2; y < panel.height(); y += stride)
    for (std::size_t x = stride / 2; x < panel.width(); x += stride)
      bytes += static_cast<char>(step_of<std::uint8_t>(scale(panel(x, y)), r));
  return base64(deflated(bytes));
}

/// Pixels that every `stride`-th of n is, from the middle of the first.
inline std::size_t n_kept(std::size_t n, std::size_t stride) {
  return n > stride / 2 ? (n - stride / 2 - 1) / stride + 1 : 0;
}

}  // namespace detail

inline packed_frame packed(const depth::depth_map& estimate,
                           const depth::depth_map& reference,
                           const depth::error_image_options& options,
                           std::size_t width) {
  const auto frame =
      depth::measure(estimate.values.view(), reference.values.view(), options.errors);
  (void)depth::summarize(frame.sums);  // throws where there is nothing to show
  const auto panels =
      depth::detail::panels_of(estimate, reference, options.errors, frame.transform);
  const auto depths = depth::detail::depth_range(panels, options);
  const auto errors = depth::detail::error_range(panels, options);
  const std::size_t columns = panels.relative.width(), rows = panels.relative.height();
  const std::size_t stride =
      std::max<std::size_t>(1, (columns + width - 1) / std::max(width, std::size_t{1}));
  const range log_depths{std::log(depths.low), std::log(depths.high)};
  const auto log = [](double d) { return std::log(d); };
  const auto same = [](double e) { return e; };
  return {detail::n_kept(columns, stride),
          detail::n_kept(rows, stride),
          {depths.low, depths.high},
          {errors.low, errors.high},
          detail::packed_panel(panels.estimate, stride, log_depths, log),
          detail::packed_panel(panels.reference, stride, log_depths, log),
          detail::packed_panel(panels.relative, stride, {errors.low, errors.high}, same)};
}

}  // namespace aib::report
