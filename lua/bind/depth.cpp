// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include "depth.hpp"

#include <aib/depth/depth_map.hpp>
#include <aib/depth/error_image.hpp>
#include <aib/depth/errors.hpp>
#include <aib/raster/downsample.hpp>

#include "depth_reading.hpp"
#include "raster.hpp"
#include "stats.hpp"
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace aib::bind {

namespace {

using depth::depth_map;

std::string print_map(const depth_map& d) {
  const auto valid = std::count_if(d.values.begin(), d.values.end(), depth::is_valid<float>);
  return message("depth_map(", d.values.width(), "x", d.values.height(), ", ", valid, " valid)");
}

std::size_t bytes_of_map(const depth_map& d) { return d.values.size() * sizeof(float); }

record summary_of(lua_State* state, const depth_map& d) {
  stats::moments valid;
  for (const float v : d.values) {
    if (depth::is_valid(v)) valid.add(v);
  }
  record r(state);
  r.set("width", d.values.width()).set("height", d.values.height()).set("n_valid", valid.count());
  return set_moments(r, valid);
}

void bind_map(lua_State* state) {
  type<depth_map>(state, "depth_map", print_map, bytes_of_map)
      .field("width", [](const depth_map& d) { return d.values.width(); })
      .field("height", [](const depth_map& d) { return d.values.height(); })
      .field("warnings", [](const depth_map& d) { return d.warnings; })
      .method("at", {"column", "row"},
              [](const depth_map& d, std::size_t column, std::size_t row) {
                return pixel_at(d.values, column, row, "depth_map:at");
              })
      .method("summary", {}, [](lua_State* l, const depth_map& d) { return summary_of(l, d); })
      .method("scaled", {"factor"}, [](const depth_map& d, double factor) {
        depth_map scaled = d;
        for (float& v : scaled.values) v = static_cast<float>(v * factor);
        return scaled;
      });
}

/// The errors of the frame, with those of each label in `by_label` where the options have labels.
record errors_with_labels(lua_State* state,
                          const depth_map& estimate,
                          const depth_map& reference,
                          const depth::error_options& options) {
  const auto frame = depth::measure(estimate.values.view(), reference.values.view(), options);
  record r = bind::as_record(state, depth::summarize(frame.sums, frame.transform));
  if (!options.labels.data) return r;
  return r.set("by_label", records_by_number(state, frame.by_label, [&](const auto& sums) {
                 return bind::as_record(state, depth::record_of(sums, frame.transform).errors,
                                        sums);
               }));
}

}  // namespace

void bind_depth(lua_State* state) {
  bind_map(state);
  module(state, "depth")
      .function("map", {"rows"},
                [](const std::vector<std::vector<double>>& rows) {
                  return depth_map{image_of_rows<float>(rows, "aib.depth.map")};
                })
      .function("downsample", {"depth", "width", "height", "options"},
                [](const depth_map& d, std::size_t width, std::size_t height, options& o) {
                  const auto rule = rule_option(o);
                  o.done();
                  return depth_map{raster::resample_nearest(d.values.view(), width, height, rule),
                                   d.warnings};
                })
      .function(
          "errors", {"estimate", "reference", "options"},
          [](lua_State* l, const depth_map& estimate, const depth_map& reference, options& o) {
            depth::error_options e = error_options(o, preset_option(o).errors);
            const auto mask = mask_option(o);
            e.mask = mask.view();
            e.labels = labels_option(o);
            o.done();
            return errors_with_labels(l, estimate, reference, e);
          })
      .function("srmse", {"estimate", "reference", "options"},
                [](const depth_map& estimate, const depth_map& reference, options& o) {
                  depth::error_options e = error_options(o, preset_option(o).errors);
                  const auto mask = mask_option(o);
                  e.mask = mask.view();
                  o.done();
                  return depth::srmse(estimate.values.view(), reference.values.view(), e);
                })
      .function("error_image", {"estimate", "reference", "options"},
                [](const depth_map& estimate, const depth_map& reference, options& o) {
                  depth::error_image_options how;
                  how.errors = error_options(o, preset_option(o).errors);
                  how.near = o.number("near", how.near);
                  how.far = o.number("far", how.far);
                  how.largest = o.number("largest", how.largest);
                  const auto mask = mask_option(o);
                  o.done();
                  how.errors.mask = mask.view();
                  return depth::error_image(estimate, reference, how);
                });
}

}  // namespace aib::bind
