// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/core/executor.hpp>
#include <aib/core/isa.hpp>
#include <aib/io/depth.hpp>
#include <aib/io/image.hpp>
#include <aib/io/npy.hpp>
#include <aib/math/camera.hpp>
#include <aib/mesh/ray_surface.hpp>
#include <aib/pose/trajectory.hpp>
#include <aib/render/frame.hpp>
#include <aib/render/view_rays.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace aib::stream {

/// What is written of each frame.
enum class render_map {
  depth,    ///< depth/NAME.exr, planar, float, 0 where nothing is seen
  range,    ///< range/NAME.exr
  normals,  ///< normals/NAME.npy, h x w x 3 floats in the camera
  labels,   ///< labels/NAME.png, 16 bits
};

/// What is done with files that are there.
enum class existing_files { replace, keep };

struct render_frames_options {
  std::vector<render_map> maps = {render_map::depth};
  std::size_t width = 0, height = 0;  ///< of the maps; 0: those of the camera
  existing_files existing = existing_files::replace;
  std::uint16_t background = 65535;  ///< label where nothing is seen
  unsigned threads = 0;              ///< 0: all
  aib::control control = {};
};

struct rendered_frames {
  std::size_t n_frames = 0;                       ///< that were cast
  std::size_t n_kept = 0;                         ///< whose files were all there
  std::vector<std::filesystem::path> files = {};  ///< in the order of the frames
};

namespace detail {

/// The file of a map of a frame. The name loses its extension and keeps its folders.
inline std::filesystem::path file_of(const std::filesystem::path& folder,
                                     render_map map,
                                     const std::string& name) {
  struct kind {
    const char* folder;
    const char* extension;
  };
  constexpr kind kinds[] = {
      {"depth", ".exr"}, {"range", ".exr"}, {"normals", ".npy"}, {"labels", ".png"}};
  const kind& k = kinds[static_cast<std::size_t>(map)];
  const std::filesystem::path relative = std::filesystem::path(name).lexically_normal();
  const bool inside = relative.is_relative() && *relative.begin() != ".." && !name.empty();
  if (!inside)
    throw argument_error(message("stream::render_frames: '", name, "' is no name of an image"));
  return (folder / k.folder / relative).replace_extension(k.extension);
}

inline void write_normals(const std::filesystem::path& path,
                          const raster::image<Eigen::Vector3f>& normals) {
  const std::span values(normals.data()->data(), 3 * normals.size());
  io::write_npy(path, io::make_array<float>({normals.height(), normals.width(), 3}, values));
}

inline void write_map(const std::filesystem::path& path, render_map map, const render::frame& f) {
  std::filesystem::create_directories(path.parent_path());
  switch (map) {
    case render_map::depth:
      return io::write_depth(path, f.depth.values, {});
    case render_map::range:
      return io::write_depth(path, f.range.values, {});
    case render_map::normals:
      return write_normals(path, f.normals);
    case render_map::labels:
      return io::write_image<std::uint16_t>(path, f.labels);
  }
}

inline bool same(const math::camera& a, const math::camera& b) {
  return a.model == b.model && a.width == b.width && a.height == b.height &&
         a.parameters == b.parameters;
}

}  // namespace detail

inline namespace AIB_ISA {

/// Renders the frames of a trajectory into a folder, as many at a time as there are threads. Files
/// are written whole or not at all, so that a stopped run can be taken up with
/// `existing_files::keep`. The same bytes for any number of threads.
///
/// cameras   one a pose, or one for all
///
/// Poses that are not registered are left out. Throws argument_error where there are no names or
/// the cameras do not fit, io_error where a file cannot be written.
inline rendered_frames render_frames(const mesh::ray_surface& surface,
                                     const pose::trajectory& poses,
                                     std::span<const math::camera> cameras,
                                     const std::filesystem::path& folder,
                                     const render_frames_options& options = {}) {
  if (poses.names.size() != poses.size() ||
      (cameras.size() != 1 && cameras.size() != poses.size())) {
    throw argument_error(message("stream::render_frames: ", poses.size(), " poses, ",
                                 poses.names.size(), " names, ", cameras.size(),
                                 " cameras: a name a pose and one camera or one a pose expected"));
  }
  rendered_frames done;
  std::vector<std::size_t> wanted;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (!poses.world_from_camera[i].is_finite()) continue;
    bool all_there = options.existing == existing_files::keep;
    for (const render_map map : options.maps) {
      done.files.push_back(detail::file_of(folder, map, poses.names[i]));
      all_there = all_there && std::filesystem::exists(done.files.back());
    }
    all_there ? void(++done.n_kept) : wanted.push_back(i);
  }
  done.n_frames = wanted.size();
  if (wanted.empty()) return done;
  const bool one_camera = std::all_of(cameras.begin(), cameras.end(), [&](const math::camera& c) {
    return detail::same(c, cameras.front());
  });
  std::optional<render::view_rays> shared;
  if (one_camera) shared.emplace(cameras.front(), options.width, options.height, options.threads);
  for_each_chunk(wanted.size(), 1, options.threads, options.control, [&](const chunk& c) {
    const std::size_t i = wanted[c.index];
    const render::frame_options how{.background = options.background, .cast = {.threads = 1}};
    const auto cast = [&](const render::view_rays& rays) {
      return render::cast_frame(surface, rays, poses.world_from_camera[i], how);
    };
    const render::frame f =
        shared ? cast(*shared)
               : cast(render::view_rays(cameras[i], options.width, options.height, 1));
    for (const render_map map : options.maps)
      detail::write_map(detail::file_of(folder, map, poses.names[i]), map, f);
  });
  return done;
}

}  // namespace AIB_ISA
}  // namespace aib::stream
