// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/raster/image.hpp>

#include "kit.hpp"
#include <algorithm>
#include <cstddef>
#include <vector>

/// What the bindings of depth maps, pictures and label images share.
namespace aib::bind {

/// The pixel at a one-based column and row. Throws argument_error where there is none.
template <class T>
const T& pixel_at(const raster::image<T>& image,
                  std::size_t column,
                  std::size_t row,
                  const char* function) {
  if (column == 0 || row == 0 || column > image.width() || row > image.height()) {
    throw argument_error(message(function, ": column 1..", image.width(), " and row 1..",
                                 image.height(), " expected, found ", column, " and ", row));
  }
  return image(column - 1, row - 1);
}

/// The image of a list of rows. Throws argument_error where they differ in length.
template <class T, class Number>
raster::image<T> image_of_rows(const std::vector<std::vector<Number>>& rows, const char* function) {
  raster::image<T> image(rows.empty() ? 0 : rows.front().size(), rows.size());
  auto to = image.begin();
  for (const auto& row : rows) {
    if (row.size() != image.width())
      throw argument_error(message(function, ": rows of one length expected"));
    to = std::transform(row.begin(), row.end(), to, [](Number n) { return static_cast<T>(n); });
  }
  return image;
}

}  // namespace aib::bind
