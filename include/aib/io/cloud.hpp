// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/cloud.hpp>
#include <aib/core/error.hpp>
#include <aib/io/array_cloud.hpp>
#include <aib/io/axes.hpp>
#include <aib/io/file_kind.hpp>
#include <aib/io/las.hpp>
#include <aib/io/limits.hpp>
#include <aib/io/obj.hpp>
#include <aib/io/pcd.hpp>
#include <aib/io/ply.hpp>
#include <aib/io/ply_write.hpp>
#include <aib/io/xyz.hpp>
#include <aib/mesh/mesh.hpp>

#if defined(AIB_WITH_JSON)
#include <aib/io/glb.hpp>
#endif

#include <filesystem>
#include <string>
#include <utility>

namespace aib::io {

struct cloud_options {
  up_axis up = up_axis::z;                 ///< axis that points up in the file
  splat_rule splats = splat_rule::refuse;  ///< PLY files of 3D Gaussian splats
  std::string key = {};                    ///< NPZ: name of the array; empty: see read_npz_cloud
  io::limits limits = {};
};

/// Reads a cloud; the format is told from the content, then from the extension: PLY, PCD, XYZ, CSV,
/// PTS, LAS, NPY, NPZ, GLB. Of a mesh file (PLY, OBJ, GLB) the vertices are read.
///
/// Throws format_error where the format is not known or the file is damaged, io_error where it
/// cannot be read.
cloud::cloud read_cloud(const std::filesystem::path& path, const cloud_options& options = {});

namespace detail {

inline cloud::cloud vertices_of(mesh::mesh mesh) {
  return {.origin = mesh.origin,
          .points = std::move(mesh.vertices),
          .warnings = std::move(mesh.warnings)};
}

inline cloud::cloud read_stored_cloud(const std::filesystem::path& path,
                                      const cloud_options& options) {
  switch (kind_of(path)) {
    case file_kind::ply:
      return read_ply_cloud(path, options.splats);
    case file_kind::pcd:
      return read_pcd(path, options.limits);
    case file_kind::las:
      return read_las(path);
    case file_kind::text_points:
      return read_xyz(path);
    case file_kind::obj:
      return vertices_of(read_obj(path));
    case file_kind::npy:
      return read_npy_cloud(path);
    case file_kind::npz:
#if defined(AIB_WITH_NPZ)
      return read_npz_cloud(path, options.key, options.limits);
#else
      throw format_error(path, "this build of aib reads no NPZ; build it with zlib");
#endif
    case file_kind::glb:
#if defined(AIB_WITH_JSON)
      return read_glb_cloud(path, options.limits);
#else
      throw format_error(path, "this build of aib reads no GLB; build it with nlohmann-json");
#endif
    case file_kind::stl:
      throw format_error(path,
                         "a cloud expected, found an STL mesh; read it as a mesh and sample it");
    case file_kind::e57:
      throw format_error(path,
                         "E57 is not supported; convert it with CloudCompare or "
                         "`pdal translate in.e57 out.ply`");
    default:
      throw format_error(path, "a cloud expected: PLY, PCD, XYZ, CSV, PTS, LAS, NPY, NPZ or GLB");
  }
}

}  // namespace detail

inline cloud::cloud read_cloud(const std::filesystem::path& path, const cloud_options& options) {
  cloud::cloud result = detail::read_stored_cloud(path, options);
  demand_points(path, "points", result.size(), options.limits);
  turn_z_up(result, options.up);
  return result;
}

/// Writes a cloud as PLY. Throws argument_error for another extension.
inline void write_cloud(const std::filesystem::path& path,
                        const cloud::cloud& cloud,
                        const ply_cloud_extras& extras = {}) {
  if (extension_of(path) != ".ply") {
    throw argument_error(message("io::write_cloud: the extension .ply expected, found \"",
                                 path.extension().string(), "\""));
  }
  write_ply(path, cloud, extras);
}

}  // namespace aib::io
