// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include "raster.hpp"

#include <aib/raster/color.hpp>
#include <aib/raster/draw.hpp>

#include "kit.hpp"
#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
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

record summary_of(lua_State* state, const color_image& image) {
  std::array<double, 3> mean = {};
  for (const raster::rgb& pixel : image) {
    for (std::size_t c = 0; c < 3; ++c) mean[c] += pixel[c];
  }
  record r(state);
  r.set("width", image.width()).set("height", image.height());
  if (image.size() == 0) return r;
  for (double& sum : mean) sum /= static_cast<double>(image.size());
  return r.set("mean", std::vector<double>(mean.begin(), mean.end()));
}

record summary_of(lua_State* state, const label_image& image) {
  std::map<std::uint16_t, std::size_t> counts;
  for (const std::uint16_t label : image) ++counts[label];
  sol::table by_label(state, sol::create);
  for (const auto& [label, n] : counts) by_label[label] = n;
  return record(state)
      .set("width", image.width())
      .set("height", image.height())
      .set("counts", by_label);
}

}  // namespace

void bind_raster(lua_State* state) {
  type<color_image>(state, "image", print_image, bytes<raster::rgb>)
      .field("width", [](const color_image& i) { return i.width(); })
      .field("height", [](const color_image& i) { return i.height(); })
      .method("summary", {}, [](lua_State* l, const color_image& i) { return summary_of(l, i); })
      .method("at", {"column", "row"},
              [](const color_image& i, std::size_t column, std::size_t row) {
                const raster::rgb& c = pixel_at(i, column, row, "image:at");
                return std::vector<int>(c.begin(), c.end());
              });
  type<label_image>(state, "label_image", print_labels, bytes<std::uint16_t>)
      .field("width", [](const label_image& l) { return l.width(); })
      .field("height", [](const label_image& l) { return l.height(); })
      .method("summary", {}, [](lua_State* l, const label_image& i) { return summary_of(l, i); })
      .method("at", {"column", "row"},
              [](const label_image& l, std::size_t column, std::size_t row) {
                return pixel_at(l, column, row, "label_image:at");
              })
      .method("mask", {"label"}, [](const label_image& l, std::uint16_t label) {
        label_image mask(l.width(), l.height());
        std::transform(l.begin(), l.end(), mask.begin(),
                       [label](std::uint16_t v) { return std::uint16_t{v == label}; });
        return mask;
      });
  module(state, "raster")
      .function("labels", {"rows"},
                [](const std::vector<std::vector<std::uint16_t>>& rows) {
                  return image_of_rows<std::uint16_t>(rows, "aib.raster.labels");
                })
      .function("contact_sheet", {"pictures", "options"},
                [](const std::vector<color_image>& pictures, options& o) {
                  const std::size_t columns = o.count("columns", 3);
                  const std::size_t width = o.count("width", 480);
                  o.done();
                  return raster::contact_sheet(pictures, columns, width);
                });
}

}  // namespace aib::bind
