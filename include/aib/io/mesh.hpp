// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/io/axes.hpp>
#include <aib/io/file_kind.hpp>
#include <aib/io/limits.hpp>
#include <aib/io/obj.hpp>
#include <aib/io/ply.hpp>
#include <aib/io/ply_write.hpp>
#include <aib/io/stl.hpp>
#include <aib/mesh/mesh.hpp>

#if defined(AIB_WITH_JSON)
#include <aib/io/glb.hpp>
#endif

#include <filesystem>

namespace aib::io {

struct mesh_options {
  up_axis up = up_axis::z;  ///< axis that points up in the file
  io::limits limits = {};
};

/// Reads a mesh; the format is told from the content, then from the extension: PLY, OBJ, STL, GLB.
///
/// Throws format_error where the format is not known or the file is damaged, io_error where it
/// cannot be read.
mesh::mesh read_mesh(const std::filesystem::path& path, const mesh_options& options = {});

namespace detail {

inline mesh::mesh read_stored_mesh(const std::filesystem::path& path,
                                   [[maybe_unused]] const limits& limits) {
  switch (kind_of(path)) {
    case file_kind::ply:
      return read_ply_mesh(path);
    case file_kind::obj:
      return read_obj(path);
    case file_kind::stl:
      return read_stl(path);
    case file_kind::glb:
#if defined(AIB_WITH_JSON)
      return read_glb_mesh(path, limits);
#else
      throw format_error(path, "this build of aib reads no GLB; build it with nlohmann-json");
#endif
    case file_kind::gltf:
      throw format_error(path, "glTF of several files is not supported; export it as .glb");
    default:
      throw format_error(path, "a mesh expected: PLY, OBJ, STL or GLB");
  }
}

}  // namespace detail

inline mesh::mesh read_mesh(const std::filesystem::path& path, const mesh_options& options) {
  mesh::mesh result = detail::read_stored_mesh(path, options.limits);
  demand_points(path, "vertices", result.vertices.size(), options.limits);
  demand_points(path, "triangles", result.triangles.size(), options.limits);
  turn_z_up(result, options.up);
  return result;
}

/// Writes a mesh as PLY. Throws argument_error for another extension.
inline void write_mesh(const std::filesystem::path& path,
                       const mesh::mesh& mesh,
                       const ply_mesh_extras& extras = {}) {
  if (extension_of(path) != ".ply") {
    throw argument_error(message("io::write_mesh: the extension .ply expected, found \"",
                                 path.extension().string(), "\""));
  }
  write_ply(path, mesh, extras);
}

}  // namespace aib::io
