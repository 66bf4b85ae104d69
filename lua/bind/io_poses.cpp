// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/io/trajectory.hpp>
#include <aib/io/trajectory_write.hpp>

#include "camera.hpp"
#include "kit.hpp"
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace aib::bind {

namespace {

namespace fs = std::filesystem;
using io::camera_axes;
using io::pose_convention;
using io::pose_format;
using io::quaternion_order;

constexpr std::initializer_list<choice<pose_format>> formats = {
    {"tum", pose_format::tum},
    {"kitti", pose_format::kitti},
    {"euroc", pose_format::euroc},
    {"log", pose_format::log},
    {"da3", pose_format::da3},
    {"colmap", pose_format::colmap},
    {"transforms", pose_format::transforms},
    {"opensfm", pose_format::opensfm},
    {"metashape", pose_format::metashape},
    {"reality_capture", pose_format::reality_capture},
    {"npy", pose_format::npy},
    {"npz", pose_format::npz}};

constexpr std::initializer_list<choice<pose_convention>> conventions = {
    {"world_from_camera", pose_convention::world_from_camera},
    {"camera_from_world", pose_convention::camera_from_world}};

constexpr std::initializer_list<choice<camera_axes>> axes = {{"opencv", camera_axes::opencv},
                                                             {"opengl", camera_axes::opengl}};

/// A choice that may be left out.
template <class E>
std::optional<E> maybe(options& o, const char* name, std::initializer_list<choice<E>> choices) {
  if (!o.has(name)) return std::nullopt;
  return o.choice(name, E{}, choices);
}

io::trajectory_options reading_options(options& o) {
  io::trajectory_options r;
  r.format = maybe(o, "format", formats);
  r.convention = maybe(o, "convention", conventions);
  r.axes = maybe(o, "axes", axes);
  r.quaternion = o.choice("quaternion", r.quaternion,
                          {{"xyzw", quaternion_order::xyzw}, {"wxyz", quaternion_order::wxyz}});
  r.key = o.text("key", "");
  r.names = o.get<std::vector<std::string>>("names").value_or(std::vector<std::string>());
  r.size = {o.count("width", 0), o.count("height", 0)};
  o.done();
  return r;
}

io::trajectory_write_options writing_options(options& o) {
  using io::colmap_encoding;
  io::trajectory_write_options w;
  w.format = maybe(o, "format", formats);
  w.frame.convention = o.choice("convention", w.frame.convention, conventions);
  w.frame.axes = o.choice("axes", w.frame.axes, axes);
  w.encoding = o.choice("encoding", w.encoding,
                        {{"binary", colmap_encoding::binary}, {"text", colmap_encoding::text}});
  return w;
}

/// The cameras of the poses, by name.
std::vector<math::camera> cameras_option(options& o, const pose::trajectory& t) {
  const auto by_name = o.get<camera_map>("cameras");
  std::vector<math::camera> cameras;
  if (!by_name) return cameras;
  for (const std::string& name : t.names) {
    const auto camera = by_name->find(name);
    if (camera == by_name->end()) o.reject("cameras", message("no camera of '", name, "'"));
    cameras.push_back(camera->second);
  }
  return cameras;
}

record as_record(lua_State* state, io::colmap_model model) {
  record r(state);
  r.set("path", model.path).set("cameras", io::cameras_by_name(model));
  r.set("point_errors", model.point_errors_px).set("track_lengths", model.track_lengths);
  r.set("trajectory", std::move(model.trajectory)).set("points", std::move(model.points));
  return r;
}

void bind_trajectories(lua_State* state) {
  module(state, "io")
      .function("read_trajectory", {"path", "options"},
                [](const fs::path& path, options& o) {
                  return io::read_trajectory(path, reading_options(o));
                })
      .function("read_cameras", {"path", "options"},
                [](const fs::path& path, options& o) {
                  return io::read_cameras(path, reading_options(o));
                })
      .function("write_trajectory", {"path", "trajectory", "options"},
                [](const fs::path& path, const pose::trajectory& t, options& o) {
                  const io::trajectory_write_options w = writing_options(o);
                  const io::posed_images images{t, cameras_option(o, t)};
                  o.done();
                  io::write_trajectory(path, images, w);
                });
}

#ifdef AIB_WITH_JSON
std::vector<io::posed_images> opensfm_components(const fs::path& path) {
  return io::read_opensfm_components(io::detail::file_in(path, "reconstruction.json"));
}
#else
std::vector<io::posed_images> opensfm_components(const fs::path& path) {
  io::detail::needs_library(path, "JSON", "nlohmann-json");
}
#endif

void bind_opensfm(lua_State* state) {
  module(state, "io")
      .function("read_opensfm_components", {"path"}, [](lua_State* l, const fs::path& path) {
        std::vector<record> components;
        for (io::posed_images& images : opensfm_components(path)) {
          camera_map cameras;
          for (std::size_t i = 0; i < images.cameras.size(); ++i)
            cameras.insert_or_assign(images.trajectory.names[i], images.cameras[i]);
          record r(l);
          r.set("cameras", cameras).set("trajectory", std::move(images.trajectory));
          components.push_back(std::move(r));
        }
        return components;
      });
}

void bind_colmap(lua_State* state) {
  module(state, "io")
      .function(
          "read_colmap", {"path"},
          [](lua_State* l, const fs::path& path) { return as_record(l, io::read_colmap(path)); })
      .function("read_colmap_models", {"path"}, [](lua_State* l, const fs::path& path) {
        std::vector<record> models;
        for (io::colmap_model& model : io::read_colmap_models(path))
          models.push_back(as_record(l, std::move(model)));
        return models;
      });
}

}  // namespace

void bind_io_poses(lua_State* state) {
  bind_trajectories(state);
  bind_colmap(state);
  bind_opensfm(state);
}

}  // namespace aib::bind
