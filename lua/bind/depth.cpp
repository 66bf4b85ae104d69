// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/depth/accumulate.hpp>
#include <aib/depth/depth_map.hpp>
#include <aib/depth/error_image.hpp>
#include <aib/depth/errors.hpp>
#include <aib/depth/fit.hpp>
#include <aib/depth/presets.hpp>
#include <aib/raster/color.hpp>
#include <aib/raster/downsample.hpp>
#include <aib/stats/bootstrap.hpp>

#include "kit.hpp"
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace aib::bind {

namespace {

using depth::accumulator;
using depth::alignment;
using depth::depth_map;
using depth::error_summary;
using depth::fitter;
using raster::label_image;

std::string print_map(const depth_map& d) {
  const auto valid = std::count_if(d.values.begin(), d.values.end(), depth::is_valid<float>);
  return message("depth_map(", d.values.width(), "x", d.values.height(), ", ", valid, " valid)");
}

std::string print_accumulator(const accumulator& a) {
  return message("accumulator(", a.frames().size(), " frames)");
}

std::string print_fitter(const fitter& f) { return message("fitter(", f.n_valid(), " pixels)"); }

std::size_t bytes_of_map(const depth_map& d) { return d.values.size() * sizeof(float); }

constexpr std::initializer_list<choice<alignment>> alignments = {
    {"none", alignment::none},
    {"median", alignment::median},
    {"median_lower", alignment::median_lower},
    {"scale", alignment::scale},
    {"scale_l1", alignment::scale_l1},
    {"scale_shift", alignment::scale_shift},
    {"log", alignment::log}};

depth::affine affine_option(options& o, const char* name) {
  const auto table = o.get<sol::table>(name);
  if (!table) return {};
  const auto scale = table->get<std::optional<double>>("scale");
  const auto shift = table->get<std::optional<double>>("shift");
  if (!scale) o.reject(name, "a table with `scale` (and `shift`) expected, as a fit gives it");
  return {*scale, shift.value_or(0)};
}

depth::accumulate_options preset_option(options& o) {
  using enum depth::preset;
  const auto chosen = o.choice("preset", paper,
                               {{"paper", paper},
                                {"kitti", kitti},
                                {"monodepth2", monodepth2},
                                {"cut3r", cut3r},
                                {"pi3", pi3}});
  return depth::options_of(chosen);
}

/// The options of a frame's errors but the mask, on top of those of a preset.
depth::error_options error_options(options& o, depth::error_options e) {
  using enum depth::crop_rule;
  e.crop = o.choice("crop", e.crop, {{"none", none}, {"garg", garg}, {"eigen", eigen}});
  if (o.has("transform")) e.align = alignment::none;
  e.align = o.choice("align", e.align, alignments);
  e.min = o.number("min", e.min);
  e.max = o.number("max", e.max);
  e.transform = affine_option(o, "transform");
  e.clamp_min = o.number("clamp_min", e.clamp_min);
  e.clamp_max = o.number("clamp_max", e.clamp_max);
  e.clamp_log = o.number("clamp_log", e.clamp_log);
  return e;
}

raster::image<std::uint8_t> mask_option(options& o) {
  const auto* labels = o.object<label_image>("mask");
  return labels ? raster::mask_of(*labels) : raster::image<std::uint8_t>();
}

record as_record(lua_State* state, const error_summary& e) {
  record r(state);
  for (const auto& [name, value] : depth::error_fields) r.set(name.data(), e.*value);
  r.set("n_valid", e.n_valid).set("n_reference", e.n_reference).set("n_estimate", e.n_estimate);
  return r;
}

record as_record(lua_State* state, const depth::frame_record& f) {
  record r = f.errors ? as_record(state, *f.errors) : record(state);
  if (!f.errors) {
    r.set("n_valid", 0).set("n_reference", f.sums.n_reference);
    r.set("n_estimate", f.sums.n_estimate);
  }
  r.set("name", f.name);
  return r;
}

record as_record(lua_State* state, const depth::affine& a) {
  return record(state).set("scale", a.scale).set("shift", a.shift);
}

double error_summary::*field_option(options& o) {
  const std::string wanted = o.text("field", "srmse");
  std::string known;
  for (const auto& [name, value] : depth::error_fields) {
    if (name == wanted) return value;
    known += message(known.empty() ? "" : ", ", name);
  }
  o.reject("field", message("one of ", known, " expected, found '", wanted, "'"));
}

depth_map map_of_rows(const std::vector<std::vector<double>>& rows) {
  depth_map map{raster::image<float>(rows.empty() ? 0 : rows.front().size(), rows.size())};
  auto to = map.values.begin();
  for (const auto& row : rows) {
    if (row.size() != map.values.width())
      throw argument_error("aib.depth.map: rows of one length expected");
    to = std::transform(row.begin(), row.end(), to, [](double d) { return static_cast<float>(d); });
  }
  return map;
}

void bind_map(lua_State* state) {
  type<depth_map>(state, "depth_map", print_map, bytes_of_map)
      .field("width", [](const depth_map& d) { return d.values.width(); })
      .field("height", [](const depth_map& d) { return d.values.height(); })
      .field("warnings", [](const depth_map& d) { return d.warnings; })
      .method(
          "at", {"column", "row"},
          [](const depth_map& d, std::size_t column, std::size_t row) {
            const auto& v = d.values;
            if (column == 0 || row == 0 || column > v.width() || row > v.height()) {
              throw argument_error(message("depth_map:at: column 1..", v.width(), " and row 1..",
                                           v.height(), " expected, found ", column, " and ", row));
            }
            return v(column - 1, row - 1);
          })
      .method("scaled", {"factor"}, [](const depth_map& d, double factor) {
        depth_map scaled = d;
        for (float& v : scaled.values) v = static_cast<float>(v * factor);
        return scaled;
      });
}

void bind_fitter(lua_State* state) {
  type<fitter>(state, "fitter", print_fitter)
      .field("n_valid", [](const fitter& f) { return f.n_valid(); })
      .method("add", {"estimate", "reference", "options"},
              [](fitter& f, const depth_map& estimate, const depth_map& reference, options& o) {
                const auto mask = mask_option(o);
                o.done();
                f.add(estimate.values.view(), reference.values.view(), mask.view());
                return self{};
              })
      .method("merge", {"other"},
              [](fitter& f, const fitter& other) {
                f += other;
                return self{};
              })
      .method("result", {}, [](lua_State* l, const fitter& f) { return as_record(l, f.result()); });
}

void bind_accumulator(lua_State* state) {
  type<accumulator>(state, "accumulator", print_accumulator)
      .length([](const accumulator& a) { return a.frames().size(); })
      .method(
          "add", {"estimate", "reference", "options"},
          [](accumulator& a, const depth_map& estimate, const depth_map& reference, options& o) {
            const auto mask = mask_option(o);
            std::string name = o.text("name", message(a.frames().size() + 1));
            o.done();
            a.add(std::move(name), estimate.values.view(), reference.values.view(), mask.view());
            return self{};
          })
      .method("merge", {"other"},
              [](accumulator& a, const accumulator& other) {
                a += other;
                return self{};
              })
      .method("result", {"options"},
              [](lua_State* l, const accumulator& a, options& o) {
                const bool pooled = o.flag("pooled", false);
                o.done();
                const auto summary = a.result();
                record r = as_record(l, pooled ? summary.pooled : summary.mean);
                r.set("n_frames", summary.n_frames).set("n_defined", summary.n_defined);
                r.set("undefined", summary.undefined);
                return r;
              })
      .method("frames", {"options"},
              [](lua_State* l, const accumulator& a, options& o) {
                const bool worst = o.has("field");
                const auto field = field_option(o);
                o.done();
                std::vector<record> list;
                if (!worst) {
                  for (const auto& f : a.frames()) list.push_back(as_record(l, f));
                } else {
                  for (const std::size_t i : depth::worst_first(a.frames(), field))
                    list.push_back(as_record(l, a.frames()[i]));
                }
                return list;
              })
      .method("interval", {"options"}, [](lua_State* l, const accumulator& a, options& o) {
        const auto field = field_option(o);
        stats::bootstrap_options b;
        b.block = o.count("block", b.block);
        b.resamples = o.count("resamples", b.resamples);
        b.level = o.number("level", b.level);
        b.seed = o.count("seed", b.seed);
        o.done();
        std::vector<double> values;
        for (const auto& f : a.frames())
          if (f.errors) values.push_back((*f.errors).*field);
        const auto i = stats::bootstrap_mean(values, b);
        return record(l)
            .set("mean", i.mean)
            .set("low", i.low)
            .set("high", i.high)
            .set("deviation", i.deviation);
      });
}

}  // namespace

void bind_depth(lua_State* state) {
  bind_map(state);
  bind_fitter(state);
  bind_accumulator(state);
  module(state, "depth")
      .function("map", {"rows"},
                [](const std::vector<std::vector<double>>& rows) { return map_of_rows(rows); })
      .function(
          "downsample", {"depth", "width", "height", "options"},
          [](const depth_map& d, std::size_t width, std::size_t height, options& o) {
            using enum raster::nearest_rule;
            const auto rule = o.choice("rule", centre, {{"centre", centre}, {"floor", floor}});
            o.done();
            return depth_map{raster::resample_nearest(d.values.view(), width, height, rule),
                             d.warnings};
          })
      .function(
          "errors", {"estimate", "reference", "options"},
          [](lua_State* l, const depth_map& estimate, const depth_map& reference, options& o) {
            depth::error_options e = error_options(o, preset_option(o).errors);
            const auto mask = mask_option(o);
            o.done();
            e.mask = mask.view();
            return as_record(l, depth::errors(estimate, reference, e));
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
                })
      .function("accumulate", {"options"},
                [](options& o) {
                  const auto preset = preset_option(o);
                  const auto e = error_options(o, preset.errors);
                  if (preset.align_over == depth::scope::sequence && e.align != alignment::none) {
                    o.reject("preset",
                             "it fits a whole sequence: give the `transform` that "
                             "aib.depth.fit finds");
                  }
                  o.done();
                  return accumulator(e);
                })
      .function("fit", {"options"}, [](options& o) {
        const auto align = o.choice("align", alignment::median, alignments);
        const depth::pixel_rules rules = {.min = o.number("min", 0),
                                          .max = o.number("max", HUGE_VAL)};
        o.done();
        return fitter(align, rules);
      });
}

}  // namespace aib::bind
