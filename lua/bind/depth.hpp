// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/depth/accumulate.hpp>
#include <aib/depth/errors.hpp>
#include <aib/depth/fit.hpp>
#include <aib/depth/presets.hpp>
#include <aib/raster/color.hpp>
#include <aib/raster/image.hpp>

#include "kit.hpp"
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>

/// What the bindings of depth maps share: options and results.
namespace aib::bind {

constexpr std::initializer_list<choice<depth::alignment>> depth_alignments = {
    {"none", depth::alignment::none},
    {"median", depth::alignment::median},
    {"median_lower", depth::alignment::median_lower},
    {"scale", depth::alignment::scale},
    {"scale_l1", depth::alignment::scale_l1},
    {"scale_shift", depth::alignment::scale_shift},
    {"log", depth::alignment::log}};

inline depth::affine affine_option(options& o, const char* name) {
  const auto table = o.get<sol::table>(name);
  if (!table) return {};
  const auto scale = table->get<std::optional<double>>("scale");
  const auto shift = table->get<std::optional<double>>("shift");
  if (!scale) o.reject(name, "a table with `scale` (and `shift`) expected, as a fit gives it");
  return {*scale, shift.value_or(0)};
}

inline depth::accumulate_options preset_option(options& o) {
  using enum depth::preset;
  const auto chosen = o.choice("preset", paper,
                               {{"paper", paper},
                                {"kitti", kitti},
                                {"monodepth2", monodepth2},
                                {"cut3r", cut3r},
                                {"pi3", pi3}});
  return depth::options_of(chosen);
}

/// The options of a frame's errors but mask and labels, on top of those of a preset.
inline depth::error_options error_options(options& o, depth::error_options e) {
  using enum depth::crop_rule;
  e.crop = o.choice("crop", e.crop, {{"none", none}, {"garg", garg}, {"eigen", eigen}});
  if (o.has("transform")) e.align = depth::alignment::none;
  e.align = o.choice("align", e.align, depth_alignments);
  e.min = o.number("min", e.min);
  e.max = o.number("max", e.max);
  e.transform = affine_option(o, "transform");
  e.clamp_min = o.number("clamp_min", e.clamp_min);
  e.clamp_max = o.number("clamp_max", e.clamp_max);
  e.clamp_log = o.number("clamp_log", e.clamp_log);
  return e;
}

inline raster::image<std::uint8_t> mask_option(options& o) {
  const auto* labels = o.object<raster::label_image>("mask");
  return labels ? raster::mask_of(*labels) : raster::image<std::uint8_t>();
}

inline raster::view<const std::uint16_t> labels_option(options& o) {
  const auto* labels = o.object<raster::label_image>("labels");
  return labels ? labels->view() : raster::view<const std::uint16_t>();
}

inline record as_record(lua_State* state, const depth::error_summary& e) {
  record r(state);
  for (const auto& [name, value] : depth::error_fields) r.set(name.data(), e.*value);
  r.set("n_valid", e.n_valid).set("n_reference", e.n_reference).set("n_estimate", e.n_estimate);
  return r;
}

/// Counts alone where no pixel is valid.
inline record as_record(lua_State* state,
                        const std::optional<depth::error_summary>& errors,
                        const depth::error_sums& sums) {
  if (errors) return as_record(state, *errors);
  return record(state)
      .set("n_valid", 0)
      .set("n_reference", sums.n_reference)
      .set("n_estimate", sums.n_estimate);
}

inline double depth::error_summary::*field_option(options& o) {
  const std::string wanted = o.text("field", "srmse");
  std::string known;
  for (const auto& [name, value] : depth::error_fields) {
    if (name == wanted) return value;
    known += message(known.empty() ? "" : ", ", name);
  }
  o.reject("field", message("one of ", known, " expected, found '", wanted, "'"));
}

/// A table from numbers to records.
template <class Map, class AsRecord>
sol::table records_by_number(lua_State* state, const Map& map, AsRecord as) {
  sol::table table(state, sol::create);
  for (const auto& [number, value] : map) table[number] = as(value).table();
  return table;
}

}  // namespace aib::bind
