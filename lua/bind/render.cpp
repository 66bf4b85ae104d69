// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/cloud/select.hpp>
#include <aib/io/npy.hpp>
#include <aib/mesh/distances.hpp>
#include <aib/render/depth.hpp>
#include <aib/render/frame.hpp>
#include <aib/render/visible.hpp>
#include <aib/stream/render_frames.hpp>

#include "kit.hpp"
#include "views.hpp"
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace aib::bind {

namespace {

std::string print_scene(const render_scene& s) {
  return message("render_scene(", s.surface.n_triangles(), " triangles)");
}

std::size_t bytes_of_scene(const render_scene& s) {
  const search::ray_tree& tree = s.surface.tree();
  return tree.nodes().size_bytes() + tree.blocks().size_bytes() +
         s.mesh.triangles.size() * sizeof(mesh::triangle) +
         s.mesh.vertices.size() * sizeof(Eigen::Vector3f);
}

std::uint16_t background_option(options& o) {
  const std::size_t label = o.count("background", 65535);
  if (label > 65535) o.reject("background", "0..65535 expected");
  return static_cast<std::uint16_t>(label);
}

record as_record(lua_State* state, render::frame f) {
  record r(state);
  r.set("n_hit", f.n_seen()).set("range", std::move(f.range)).set("depth", std::move(f.depth));
  const std::span values(f.normals.data()->data(), 3 * f.normals.size());
  r.set("normals", io::make_array<float>({f.normals.height(), f.normals.width(), 3}, values));
  return r.set("labels", std::move(f.labels));
}

std::vector<stream::render_map> maps_option(options& o) {
  using enum stream::render_map;
  const auto names = o.get<std::vector<std::string>>("maps");
  std::vector<stream::render_map> maps;
  for (const std::string& name : names.value_or(std::vector<std::string>{"depth"})) {
    if (name == "depth")
      maps.push_back(depth);
    else if (name == "range")
      maps.push_back(range);
    else if (name == "normals")
      maps.push_back(normals);
    else if (name == "labels")
      maps.push_back(labels);
    else
      o.reject("maps", message("depth, range, normals or labels expected, found '", name, "'"));
  }
  return maps;
}

/// Some of the poses, or all.
pose::trajectory frames_option(options& o, const pose::trajectory& t) {
  const auto chosen = o.get<std::vector<std::size_t>>("frames");
  if (!chosen) return t;
  std::vector<std::size_t> index;
  for (const std::size_t i : *chosen) {
    if (i < 1 || i > t.size()) o.reject("frames", message("1..", t.size(), " expected, found ", i));
    index.push_back(i - 1);
  }
  return pose::select(t, index);
}

record render_frames(lua_State* state,
                     session& s,
                     const sol::object& scene,
                     const pose::trajectory& trajectory,
                     const sol::object& cameras,
                     options& o) {
  constexpr const char* function = "aib.render.frames";
  using enum stream::existing_files;
  stream::render_frames_options how;
  how.maps = maps_option(o);
  how.width = o.count("width", 0);
  how.height = o.count("height", 0);
  how.background = background_option(o);
  how.existing = o.choice("existing", replace, {{"replace", replace}, {"keep", keep}});
  how.threads = s.threads;
  how.control = s.control;
  const auto folder = o.get<std::filesystem::path>("folder");
  if (!folder) o.reject("folder", "the folder to write to expected");
  const pose::trajectory chosen = frames_option(o, trajectory);
  o.done();
  const auto done = stream::render_frames(scene_argument(scene, function, s)->surface, chosen,
                                          cameras_of(cameras, chosen, function), *folder, how);
  return record(state)
      .set("n_frames", done.n_frames)
      .set("n_kept", done.n_kept)
      .set("files", done.files);
}

record free_space(lua_State* state,
                  session& s,
                  const sol::object& scene,
                  const cloud::cloud& points,
                  const pose::trajectory& trajectory,
                  const sol::object& cameras,
                  options& o) {
  constexpr const char* function = "aib.render.free_space";
  const render::free_space_options how{.tolerance = o.number("tolerance", 0.05),
                                       .cast = {s.threads, s.control}};
  o.done();
  const scene_argument of(scene, function, s);
  const auto distances =
      mesh::distances(points, of->mesh, {.threads = s.threads, .control = s.control});
  std::vector<float> apart(points.size());
  for (std::size_t i = 0; i < apart.size(); ++i) apart[i] = static_cast<float>(distances[i]);
  const auto verdicts =
      render::free_space(of->surface, points, apart, views_of(cameras, trajectory, function), how);
  constexpr const char* names[] = {"surface", "free", "hidden"};
  std::size_t n[3] = {};
  std::vector<std::string> texts;
  for (const render::space_verdict v : verdicts) {
    ++n[static_cast<std::size_t>(v)];
    texts.emplace_back(names[static_cast<std::size_t>(v)]);
  }
  record r(state);
  r.set("n_surface", n[0]).set("n_free", n[1]).set("n_hidden", n[2]).set("verdicts", texts);
  r.set("free_share", static_cast<double>(n[1]) / static_cast<double>(points.size()));
  return r.set("free", cloud::select_where(points, [&](std::size_t i) {
                 return verdicts[i] == render::space_verdict::free;
               }));
}

}  // namespace

void bind_render(lua_State* state) {
  type<render_scene>(state, "render_scene", print_scene, bytes_of_scene)
      .field("n_triangles", [](const render_scene& s) { return s.surface.n_triangles(); })
      .field("label_names", [](const render_scene& s) { return s.surface.label_names(); });
  module(state, "render")
      .function("scene", {"mesh"},
                [](session& s, const mesh::mesh& m) {
                  return render_scene{m, mesh::ray_surface(m, s.threads, s.control)};
                })
      .function(
          "depth", {"scene", "camera", "pose", "options"},
          [](session& s, const sol::object& scene, const math::camera& camera,
             const math::rigid3& pose, options& o) {
            using enum render::depth_kind;
            const std::size_t width = o.count("width", 0), height = o.count("height", 0);
            const auto kind = o.choice("kind", planar, {{"planar", planar}, {"range", range}});
            o.done();
            const scene_argument of(scene, "aib.render.depth", s);
            return render::depth(of->surface, render::view_rays(camera, width, height, s.threads),
                                 pose, kind, {s.threads, s.control});
          })
      .function("frame", {"scene", "camera", "pose", "options"},
                [](lua_State* l, session& s, const sol::object& scene, const math::camera& camera,
                   const math::rigid3& pose, options& o) {
                  const std::size_t width = o.count("width", 0), height = o.count("height", 0);
                  const render::frame_options how{.background = background_option(o),
                                                  .cast = {s.threads, s.control}};
                  o.done();
                  const scene_argument of(scene, "aib.render.frame", s);
                  const render::view_rays rays(camera, width, height, s.threads);
                  return as_record(l, render::cast_frame(of->surface, rays, pose, how));
                })
      .function("frames", {"scene", "trajectory", "cameras", "options"},
                [](lua_State* l, session& s, const sol::object& scene, const pose::trajectory& t,
                   const sol::object& cameras,
                   options& o) { return render_frames(l, s, scene, t, cameras, o); })
      .function("visible", {"scene", "points", "trajectory", "cameras", "options"},
                [](session& s, const sol::object& scene, const cloud::cloud& points,
                   const pose::trajectory& t, const sol::object& cameras, options& o) {
                  const render::visible_options how{.tolerance = o.number("tolerance", 0.001),
                                                    .cast = {s.threads, s.control}};
                  o.done();
                  const scene_argument of(scene, "aib.render.visible", s);
                  return render::n_views(of->surface, points,
                                         views_of(cameras, t, "aib.render.visible"), how);
                })
      .function("free_space", {"scene", "points", "trajectory", "cameras", "options"},
                [](lua_State* l, session& s, const sol::object& scene, const cloud::cloud& points,
                   const pose::trajectory& t, const sol::object& cameras,
                   options& o) { return free_space(l, s, scene, points, t, cameras, o); });
}

}  // namespace aib::bind
