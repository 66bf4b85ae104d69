// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/cloud/cloud.hpp>
#include <aib/mesh/mesh.hpp>
#ifdef AIB_WITH_NPZ
#include <aib/report/packed.hpp>
#include <aib/report/packed_depth.hpp>
#include <aib/report/packed_points.hpp>
#endif

#include "cloud.hpp"
#include "depth.hpp"
#include "kit.hpp"
#include <cstddef>
#include <span>
#include <string>
#include <vector>

// Data as a page carries it: in steps, deflated, in base64.

namespace aib::bind {

#ifdef AIB_WITH_NPZ

namespace {

record packed_values(lua_State* state, std::span<const float> values) {
  const report::range r = report::range_of(values);
  return record(state).set("low", r.low).set("high", r.high).set("data", report::packed(values, r));
}

record packed_points(lua_State* state, const cloud::cloud& points, options& o) {
  const std::size_t limit = o.count("limit", 100000);
  const auto values = o.get<sol::object>("values");
  o.done();
  const report::thinned kept = report::thin(points, limit);
  const report::packed_positions p = report::packed(points, kept.index);
  record r(state);
  r.set("n", kept.index.size()).set("n_given", points.size()).set("voxel", kept.voxel);
  r.set("box", as_record(state, p.box)).set("positions", p.data);
  if (!values) return r;
  const std::vector<float> all = values_of(*values, "aib.packed.points");
  if (all.size() != points.size()) {
    throw argument_error(
        message("aib.packed.points: ", points.size(), " values expected, found ", all.size()));
  }
  std::vector<float> some;
  for (const std::size_t i : kept.index) some.push_back(all[i]);
  return r.set("values", packed_values(state, some));
}

record packed_mesh(lua_State* state, const mesh::mesh& m) {
  const report::packed_positions p = report::packed(m);
  record r(state);
  r.set("n_vertices", m.vertices.size()).set("n_triangles", m.triangles.size());
  r.set("box", as_record(state, p.box)).set("positions", p.data);
  return r.set("triangles", report::packed_triangles(m));
}

record packed_depth(lua_State* state,
                    const depth::depth_map& est,
                    const depth::depth_map& ref,
                    options& o) {
  const std::size_t width = o.count("width", 240);
  depth::error_image_options how;
  how.errors.transform = affine_option(o, "transform");
  o.done();
  const report::packed_frame f = report::packed(est, ref, how, width);
  record r(state);
  r.set("width", f.width).set("height", f.height);
  r.set("near", f.depths.low).set("far", f.depths.high).set("largest", f.errors.high);
  return r.set("estimate", f.estimate).set("reference", f.reference).set("error", f.error);
}

}  // namespace

void bind_packed(lua_State* state) {
  module(state, "packed")
      .function("points", {"cloud", "options"},
                [](lua_State* l, const cloud::cloud& points, options& o) {
                  return packed_points(l, points, o);
                })
      .function("mesh", {"mesh"},
                [](lua_State* l, const mesh::mesh& m) { return packed_mesh(l, m); })
      .function("values", {"values"},
                [](lua_State* l, const sol::object& values) {
                  return packed_values(l, values_of(values, "aib.packed.values"));
                })
      .function("depth", {"est", "ref", "options"},
                [](lua_State* l, const depth::depth_map& est, const depth::depth_map& ref,
                   options& o) { return packed_depth(l, est, ref, o); });
}

#else

void bind_packed(lua_State*) {}

#endif

}  // namespace aib::bind
