// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/depth/boundary.hpp>
#include <aib/depth/boundary_errors.hpp>
#include <aib/depth/depth_map.hpp>
#include <aib/depth/normals.hpp>
#include <aib/depth/planes.hpp>
#include <aib/depth/rays.hpp>
#include <aib/depth/risk_coverage.hpp>
#include <aib/depth/strata.hpp>
#include <aib/depth/surface_errors.hpp>
#include <aib/math/camera.hpp>

#include "depth.hpp"
#include <algorithm>
#include <numbers>
#include <utility>
#include <vector>

namespace aib::bind {

namespace {

using depth::depth_map;

constexpr double degrees = 180 / std::numbers::pi;

std::vector<double> in_radians(std::vector<double> angles_deg) {
  for (double& angle : angles_deg) angle /= degrees;
  return angles_deg;
}

record spread_record(lua_State* state, const depth::spread& s) {
  return record(state)
      .set("mean", s.mean)
      .set("median", s.median)
      .set("p95", s.p95)
      .set("rmse", s.rmse)
      .set("max", s.max);
}

record surface_errors(lua_State* state,
                      const depth_map& estimate,
                      const depth_map& reference,
                      const math::camera& camera,
                      options& o) {
  using enum depth::surface_distance;
  depth::surface_error_options how;
  how.distance = o.choice("distance", how.distance, {{"normal", normal}, {"ray", ray}});
  how.tau = o.numbers("tau", how.tau);
  how.min = o.number("min", how.min);
  how.max = o.number("max", how.max);
  how.transform = affine_option(o, "transform");
  how.normals.max_jump = o.number("max_jump", how.normals.max_jump);
  const auto mask = mask_option(o);
  how.mask = mask.view();
  o.done();
  const auto found =
      depth::surface_errors(estimate.values.view(), reference.values.view(), camera, how);
  return record(state)
      .set("distance", spread_record(state, found.distance))
      .set("gsd", spread_record(state, found.gsd))
      .set("mean_gsd", found.mean_gsd)
      .set("within", keyed(state, how.tau, found.within))
      .set("within_total", keyed(state, how.tau, found.within_total))
      .set("coverage", found.coverage)
      .set("n_valid", found.n_valid)
      .set("n_reference", found.n_reference)
      .set("n_without_normal", found.n_without_normal);
}

record normal_errors(lua_State* state,
                     const depth_map& estimate,
                     const depth_map& reference,
                     const math::camera& camera,
                     options& o) {
  const auto tau_deg = o.numbers("tau", {11.25, 22.5, 30});
  depth::normal_error_options how;
  how.tau = in_radians(tau_deg);
  how.normals.max_jump = o.number("max_jump", how.normals.max_jump);
  const auto mask = mask_option(o);
  how.mask = mask.view();
  o.done();
  const auto& e = estimate.values;
  const auto found = depth::normal_errors(e.view(), reference.values.view(),
                                          depth::rays(camera, e.width(), e.height()), how);
  return record(state)
      .set("mean_deg", found.mean * degrees)
      .set("median_deg", found.median * degrees)
      .set("rmse_deg", found.rmse * degrees)
      .set("below", keyed(state, tau_deg, found.below))
      .set("n_valid", found.n_valid)
      .set("n_reference", found.n_reference);
}

sol::table plane_errors(lua_State* state,
                        const depth_map& estimate,
                        const depth_map& reference,
                        const math::camera& camera,
                        const raster::label_image& planes) {
  const auto& e = estimate.values;
  const auto found = depth::plane_errors(e.view(), reference.values.view(),
                                         depth::rays(camera, e.width(), e.height()), planes.view());
  return records_by_number(state, found, [&](const depth::plane_errors_summary& p) {
    return record(state)
        .set("flatness", p.flatness)
        .set("orientation_deg", p.orientation * degrees)
        .set("offset", p.offset)
        .set("reference_flatness", p.reference_flatness)
        .set("n_valid", p.n_valid);
  });
}

record risk_coverage(lua_State* state,
                     const depth_map& estimate,
                     const depth_map& reference,
                     const depth_map& confidence,
                     options& o) {
  using enum depth::pixel_error;
  depth::risk_options how;
  how.error =
      o.choice("error", how.error,
               {{"relative", relative}, {"difference", difference}, {"log_ratio", log_ratio}});
  how.steps = o.count("steps", how.steps);
  how.min = o.number("min", how.min);
  how.max = o.number("max", how.max);
  how.transform = affine_option(o, "transform");
  const auto mask = mask_option(o);
  how.mask = mask.view();
  o.done();
  const auto curve = depth::risk_coverage(estimate.values.view(), reference.values.view(),
                                          confidence.values.view(), how);
  return record(state)
      .set("coverage", curve.coverage)
      .set("risk", curve.risk)
      .set("oracle", curve.oracle)
      .set("aurc", curve.aurc)
      .set("ause", curve.ause)
      .set("n_valid", curve.n_valid)
      .set("n_unsure", curve.n_unsure);
}

}  // namespace

void bind_depth_surface(lua_State* state) {
  module(state, "depth")
      .function("surface_errors", {"estimate", "reference", "camera", "options"},
                [](lua_State* l, const depth_map& estimate, const depth_map& reference,
                   const math::camera& camera,
                   options& o) { return surface_errors(l, estimate, reference, camera, o); })
      .function("normal_errors", {"estimate", "reference", "camera", "options"},
                [](lua_State* l, const depth_map& estimate, const depth_map& reference,
                   const math::camera& camera,
                   options& o) { return normal_errors(l, estimate, reference, camera, o); })
      .function("plane_errors", {"estimate", "reference", "camera", "planes"},
                [](lua_State* l, const depth_map& estimate, const depth_map& reference,
                   const math::camera& camera, const raster::label_image& planes) {
                  return plane_errors(l, estimate, reference, camera, planes);
                })
      .function("risk_coverage", {"estimate", "reference", "confidence", "options"},
                [](lua_State* l, const depth_map& estimate, const depth_map& reference,
                   const depth_map& confidence,
                   options& o) { return risk_coverage(l, estimate, reference, confidence, o); })
      .function("strata", {"reference", "options"},
                [](const depth_map& reference, options& o) {
                  depth::strata_options how;
                  how.jump = o.number("jump", how.jump);
                  how.edge_width = o.count("edge_width", how.edge_width);
                  how.thin_width = o.count("thin_width", how.thin_width);
                  o.done();
                  return depth::strata(reference.values.view(), how);
                })
      .function("boundary_f1", {"estimate", "reference", "options"},
                [](const depth_map& estimate, const depth_map& reference, options& o) {
                  depth::boundary_options how;
                  how.t_min = o.number("t_min", how.t_min);
                  how.t_max = o.number("t_max", how.t_max);
                  how.n = o.count("n", how.n);
                  o.done();
                  return depth::boundary_f1(estimate.values.view(), reference.values.view(), how);
                })
      .function("edges", {"depth"},
                [](const depth_map& map) {
                  const auto edges = depth::depth_edges(map.values.view());
                  raster::label_image labels(edges.width(), edges.height());
                  std::copy(edges.begin(), edges.end(), labels.begin());
                  return labels;
                })
      .function("boundary_errors", {"estimate", "edges"},
                [](lua_State* l, const depth_map& estimate, const raster::label_image& edges) {
                  const auto mask = raster::mask_of(edges);
                  const auto found = depth::boundary_error(estimate.values.view(), mask.view());
                  return record(l)
                      .set("accuracy", found.accuracy)
                      .set("completeness", found.completeness)
                      .set("n_estimate", found.n_estimate)
                      .set("n_reference", found.n_reference);
                });
}

}  // namespace aib::bind
