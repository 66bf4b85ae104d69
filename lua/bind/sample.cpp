// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/io/npy.hpp>
#include <aib/sample/mesh.hpp>
#include <aib/sample/point_map.hpp>
#include <aib/sample/thin.hpp>
#include <aib/sample/unproject.hpp>
#include <aib/sample/voxel.hpp>
#include <aib/sample/voxel_grid.hpp>

#include "kit.hpp"
#include <cstdint>
#include <string>
#include <utility>

namespace aib::bind {

namespace {

sample::unproject_options unproject_options(options& o, const session& s) {
  using sample::confidence_rule;
  using sample::depth_meaning;
  sample::unproject_options u;
  if (const auto* confidence = o.object<depth::depth_map>("confidence"))
    u.confidence = confidence->values.view();
  if (const auto* image = o.object<raster::color_image>("image")) u.colors = image->view();
  u.min_confidence = o.get<double>("min_confidence");
  u.rule = o.choice("rule", u.rule,
                    {{"raw", confidence_rule::raw},
                     {"sigmoid", confidence_rule::sigmoid},
                     {"percentile", confidence_rule::percentile}});
  u.stride = o.count("stride", u.stride);
  u.pixel_offset = o.number("pixel_offset", u.pixel_offset);
  u.meaning = o.choice("depth", u.meaning,
                       {{"planar", depth_meaning::planar}, {"range", depth_meaning::range}});
  u.threads = s.threads;
  u.control = s.control;
  return u;
}

sample::voxel_options voxel_options(options& o, const session& s) {
  using sample::voxel_anchor;
  using sample::voxel_pick;
  sample::voxel_options v;
  v.size = o.number("size", v.size);
  v.anchor = o.choice("anchor", v.anchor,
                      {{"world", voxel_anchor::world}, {"open3d", voxel_anchor::open3d}});
  v.pick = o.choice("pick", v.pick,
                    {{"mean", voxel_pick::mean},
                     {"centre", voxel_pick::centre},
                     {"nearest", voxel_pick::nearest}});
  v.threads = s.threads;
  v.control = s.control;
  return v;
}

record info_of(lua_State* state, const sample::unprojected& made) {
  record info(state);
  info.set("n_valid", made.n_valid).set("n_unsure", made.n_unsure);
  return info.set("n_unseen", made.n_unseen);
}

sample::unprojected place_point_map(const io::array& points,
                                    const math::rigid3& pose,
                                    const sample::unproject_options& how) {
  if (points.shape.size() != 3 || points.shape[2] != 3) {
    throw argument_error(message("aib.sample.point_map: an array of H x W x 3 expected, found ",
                                 io::text_of_shape(points.shape)));
  }
  return sample::place_point_map(points.values<float>(), points.shape[1], points.shape[0], pose,
                                 how);
}

std::string print_grid(const sample::voxel_grid& g) {
  return message("voxel_grid(", g.size(), " voxels of ", g.n_points(), " points)");
}

void bind_voxel_grid(lua_State* state) {
  type<sample::voxel_grid>(state, "voxel_grid", print_grid)
      .length([](const sample::voxel_grid& g) { return g.size(); })
      .field("n_points", [](const sample::voxel_grid& g) { return g.n_points(); })
      .method("add", {"cloud"},
              [](sample::voxel_grid& g, const cloud::cloud& points) {
                g.add(points);
                return self{};
              })
      .method("cloud", {}, [](const sample::voxel_grid& g) { return g.result(); });
}

}  // namespace

void bind_sample(lua_State* state) {
  bind_voxel_grid(state);
  module(state, "sample")
      .function("mesh", {"mesh", "options"},
                [](lua_State* l, session& s, const mesh::mesh& surface, options& o) {
                  const sample::mesh_options how{
                      .n = o.get<std::size_t>("n"),
                      .spacing = o.get<double>("spacing"),
                      .per_area = o.get<double>("per_area"),
                      .method = o.choice("method", sample::spread::uniform,
                                         {{"uniform", sample::spread::uniform},
                                          {"poisson", sample::spread::poisson}}),
                      .seed = static_cast<std::uint64_t>(o.integer("seed", 1)),
                      .threads = s.threads,
                      .control = s.control};
                  o.done();
                  auto samples = sample::mesh(surface, how);
                  record info(l);
                  info.set("area", samples.area).set("density", samples.density);
                  info.set("floor", samples.floor);
                  return results(std::move(samples.points), info);
                })
      .function("thin", {"cloud", "options"},
                [](session& s, const cloud::cloud& points, options& o) {
                  sample::thin_options how{.control = s.control};
                  how.spacing = o.number("spacing", how.spacing);
                  how.seed = static_cast<std::uint64_t>(o.integer("seed", 1));
                  o.done();
                  return sample::thin(points, how);
                })
      .function("voxel", {"cloud", "options"},
                [](session& s, const cloud::cloud& points, options& o) {
                  const auto how = voxel_options(o, s);
                  o.done();
                  return sample::voxel(points, how);
                })
      .function("voxel_grid", {"options"},
                [](session& s, options& o) {
                  const sample::voxel_options how{.size = o.number("size", 0),
                                                  .threads = s.threads};
                  o.done();
                  return sample::voxel_grid(how);
                })
      .function("unproject", {"depth", "camera", "pose", "options"},
                [](lua_State* l, session& s, const depth::depth_map& map,
                   const math::camera& camera, const math::rigid3& pose, options& o) {
                  const auto how = unproject_options(o, s);
                  o.done();
                  auto made = sample::unproject(map, camera, pose, how);
                  const record info = info_of(l, made);
                  return results(std::move(made.points), info);
                })
      .function("point_map", {"points", "pose", "options"},
                [](lua_State* l, session& s, const io::array& points, const math::rigid3& pose,
                   options& o) {
                  const auto how = unproject_options(o, s);
                  o.done();
                  auto made = place_point_map(points, pose, how);
                  const record info = info_of(l, made);
                  return results(std::move(made.points), info);
                });
}

}  // namespace aib::bind
