// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/math/camera.hpp>
#include <aib/mesh/mesh.hpp>
#include <aib/mesh/ray_surface.hpp>
#include <aib/pose/trajectory.hpp>
#include <aib/render/visible.hpp>

#include "camera.hpp"
#include "kit.hpp"
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace aib::bind {

/// A mesh that is looked at, and its tree.
struct render_scene {
  mesh::mesh mesh;
  mesh::ray_surface surface;
};

/// The scene that an argument is, or one that is made of the mesh that it is.
class scene_argument {
 public:
  scene_argument(const sol::object& object, const char* function, const session& s) {
    given_ = get_if<render_scene>(object);
    if (given_) return;
    const auto* m = get_if<mesh::mesh>(object);
    if (!m) throw argument_error(message(function, ": a mesh or a render scene expected"));
    made_ = std::make_unique<render_scene>(
        render_scene{*m, mesh::ray_surface(*m, s.threads, s.control)});
    given_ = made_.get();
  }
  const render_scene& operator*() const { return *given_; }
  const render_scene* operator->() const { return given_; }

 private:
  std::unique_ptr<render_scene> made_;
  const render_scene* given_ = nullptr;
};

/// The cameras of the poses: one for all, or those of a table by image name.
inline std::vector<math::camera> cameras_of(const sol::object& object,
                                            const pose::trajectory& t,
                                            const char* function) {
  if (const auto* one = get_if<math::camera>(object)) return {*one};
  const auto by_name = read_if<camera_map>(object);
  if (!by_name)
    throw argument_error(message(function, ": a camera or a table of cameras by name expected"));
  if (t.names.empty())
    throw argument_error(message(function, ": a trajectory with names expected"));
  std::vector<math::camera> cameras;
  for (const std::string& name : t.names) {
    const auto camera = by_name->find(name);
    if (camera == by_name->end())
      throw argument_error(message(function, ": no camera of '", name, "'"));
    cameras.push_back(camera->second);
  }
  return cameras;
}

/// The registered poses of a trajectory with their cameras.
inline std::vector<render::view> views_of(const sol::object& cameras,
                                          const pose::trajectory& t,
                                          const char* function) {
  const auto all = cameras_of(cameras, t, function);
  std::vector<render::view> views;
  for (std::size_t i = 0; i < t.size(); ++i) {
    if (t.world_from_camera[i].is_finite())
      views.push_back({all.size() == 1 ? all.front() : all[i], t.world_from_camera[i]});
  }
  return views;
}

}  // namespace aib::bind
