// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/raster/color.hpp>
#include <aib/raster/draw.hpp>

#include "kit.hpp"
#include <algorithm>
#include <string>
#include <vector>

namespace aib::bind {

namespace {

using raster::color_image;
using raster::label_image;

std::string print_image(const color_image& i) {
  return message("image(", i.width(), "x", i.height(), ")");
}

std::string print_labels(const label_image& l) {
  return message("label_image(", l.width(), "x", l.height(), ")");
}

template <class T>
std::size_t bytes(const raster::image<T>& image) {
  return image.size() * sizeof(T);
}

/// The pixel at a one-based column and row.
template <class T>
const T& at(const raster::image<T>& image, std::size_t column, std::size_t row) {
  if (column == 0 || row == 0 || column > image.width() || row > image.height()) {
    throw argument_error(message("column 1..", image.width(), " and row 1..", image.height(),
                                 " expected, found ", column, " and ", row));
  }
  return image(column - 1, row - 1);
}

label_image labels_of_rows(const std::vector<std::vector<std::uint16_t>>& rows) {
  label_image labels(rows.empty() ? 0 : rows.front().size(), rows.size());
  auto to = labels.begin();
  for (const auto& row : rows) {
    if (row.size() != labels.width())
      throw argument_error("aib.raster.labels: rows of one length expected");
    to = std::copy(row.begin(), row.end(), to);
  }
  return labels;
}

}  // namespace

void bind_raster(lua_State* state) {
  type<color_image>(state, "image", print_image, bytes<raster::rgb>)
      .field("width", [](const color_image& i) { return i.width(); })
      .field("height", [](const color_image& i) { return i.height(); })
      .method("at", {"column", "row"},
              [](const color_image& i, std::size_t column, std::size_t row) {
                const raster::rgb& c = at(i, column, row);
                return std::vector<int>(c.begin(), c.end());
              });
  type<label_image>(state, "label_image", print_labels, bytes<std::uint16_t>)
      .field("width", [](const label_image& l) { return l.width(); })
      .field("height", [](const label_image& l) { return l.height(); })
      .method("at", {"column", "row"},
              [](const label_image& l, std::size_t column, std::size_t row) {
                return at(l, column, row);
              })
      .method("mask", {"label"}, [](const label_image& l, std::uint16_t label) {
        label_image mask(l.width(), l.height());
        std::transform(l.begin(), l.end(), mask.begin(),
                       [label](std::uint16_t v) { return std::uint16_t{v == label}; });
        return mask;
      });
  module(state, "raster")
      .function(
          "labels", {"rows"},
          [](const std::vector<std::vector<std::uint16_t>>& rows) { return labels_of_rows(rows); })
      .function("contact_sheet", {"pictures", "options"},
                [](const std::vector<color_image>& pictures, options& o) {
                  const std::size_t columns = o.count("columns", 3);
                  const std::size_t width = o.count("width", 480);
                  o.done();
                  return raster::contact_sheet(pictures, columns, width);
                });
}

}  // namespace aib::bind
