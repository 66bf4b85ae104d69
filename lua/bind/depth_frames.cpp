// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/depth/accumulate.hpp>
#include <aib/depth/fit.hpp>
#include <aib/io/depth_frame.hpp>

#include "depth.hpp"
#include "depth_reading.hpp"
#include "stats.hpp"
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace aib::bind {

namespace {

using depth::accumulator;
using depth::depth_map;
using depth::fitter;

std::string print_accumulator(const accumulator& a) {
  return message("accumulator(", a.frames().size(), " frames)");
}

std::string print_fitter(const fitter& f) { return message("fitter(", f.n_valid(), " pixels)"); }

record affine_record(lua_State* state, const depth::affine& a) {
  return record(state).set("scale", a.scale).set("shift", a.shift);
}

record frame_record(lua_State* state, const depth::frame_record& f) {
  return bind::as_record(state, f.errors, f.sums).set("name", f.name);
}

/// How one of the two maps is read: a table of options inside the options.
io::depth_options reading_option(lua_State* state, options& o, const char* name) {
  const auto table = o.get<sol::table>(name);
  if (!table) return {};
  table->push();
  const std::string function = "aib.depth.evaluate", argument = name;
  options inner(state, lua_gettop(state), function, {function, place::option, argument});
  const io::depth_options read = depth_values(inner);
  inner.done();
  lua_pop(state, 1);
  return read;
}

io::depth_frame_files files_of(const sol::table& frame) {
  const auto text = [&](const char* name) {
    return frame.get<std::optional<std::string>>(name).value_or(std::string());
  };
  io::depth_frame_files files{text("name"), text("estimate"), text("reference"), text("mask"),
                              text("labels")};
  if (files.estimate.empty() || files.reference.empty()) {
    throw argument_error(
        "aib.depth.evaluate: frames { { name =, estimate = path, reference = path }, ... } "
        "expected, found one without");
  }
  return files;
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
      .method("result", {},
              [](lua_State* l, const fitter& f) { return affine_record(l, f.result()); });
}

void bind_accumulator(lua_State* state) {
  type<accumulator>(state, "accumulator", print_accumulator)
      .length([](const accumulator& a) { return a.frames().size(); })
      .method(
          "add", {"estimate", "reference", "options"},
          [](accumulator& a, const depth_map& estimate, const depth_map& reference, options& o) {
            const auto mask = mask_option(o);
            const auto labels = labels_option(o);
            std::string name = o.text("name", message(a.frames().size() + 1));
            o.done();
            a.add(std::move(name), estimate.values.view(), reference.values.view(), mask.view(),
                  labels);
            return self{};
          })
      .method("merge", {"other"},
              [](accumulator& a, const accumulator& other) {
                a += other;
                return self{};
              })
      .method("labels", {}, [](const accumulator& a) { return a.labels(); })
      .method("of_label", {"label"},
              [](const accumulator& a, std::uint16_t label) { return a.of_label(label); })
      .method("result", {"options"},
              [](lua_State* l, const accumulator& a, options& o) {
                const bool pooled = o.flag("pooled", false);
                o.done();
                const auto summary = a.result();
                record r = bind::as_record(l, pooled ? summary.pooled : summary.mean);
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
                  for (const auto& f : a.frames()) list.push_back(frame_record(l, f));
                } else {
                  for (const std::size_t i : depth::worst_first(a.frames(), field))
                    list.push_back(frame_record(l, a.frames()[i]));
                }
                return list;
              })
      .method("interval", {"options"}, [](lua_State* l, const accumulator& a, options& o) {
        const auto field = field_option(o);
        std::vector<double> values;
        for (const auto& f : a.frames())
          if (f.errors) values.push_back((*f.errors).*field);
        return bootstrap_record(l, values, o);
      });
}

/// Reads and scores frames, as many at a time as there are threads.
accumulator evaluate(lua_State* state,
                     session& s,
                     const std::vector<sol::table>& frames,
                     options& o) {
  depth::accumulate_options how = preset_option(o);
  how.errors = error_options(o, how.errors);
  using enum depth::scope;
  how.align_over =
      o.choice("align_over", how.align_over, {{"frame", frame}, {"sequence", sequence}});
  how.threads = s.threads;
  how.control = s.control;
  const io::depth_frame_options read{.estimate = reading_option(state, o, "estimate"),
                                     .reference = reading_option(state, o, "reference"),
                                     .rule = rule_option(o)};
  o.done();
  std::vector<io::depth_frame_files> files;
  for (const sol::table& frame : frames) files.push_back(files_of(frame));
  return depth::accumulate(files.size(), how,
                           [&](std::size_t i) { return io::read_depth_frame(files[i], read); });
}

}  // namespace

void bind_depth_frames(lua_State* state) {
  bind_fitter(state);
  bind_accumulator(state);
  module(state, "depth")
      .function("evaluate", {"frames", "options"},
                [](lua_State* l, session& s, const std::vector<sol::table>& frames, options& o) {
                  return evaluate(l, s, frames, o);
                })
      .function(
          "accumulate", {"options"},
          [](options& o) {
            const auto preset = preset_option(o);
            const auto e = error_options(o, preset.errors);
            if (preset.align_over == depth::scope::sequence && e.align != depth::alignment::none) {
              o.reject("preset",
                       "it fits a whole sequence: use aib.depth.evaluate, or give the "
                       "`transform` that aib.depth.fit finds");
            }
            o.done();
            return accumulator(e);
          })
      .function("fit", {"options"}, [](options& o) {
        const auto align = o.choice("align", depth::alignment::median, depth_alignments);
        const depth::pixel_rules rules = {.min = o.number("min", 0),
                                          .max = o.number("max", HUGE_VAL)};
        o.done();
        return fitter(align, rules);
      });
}

}  // namespace aib::bind
