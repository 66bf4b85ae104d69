// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/cloud.hpp>
#include <aib/core/error.hpp>
#include <aib/io/axes.hpp>
#include <aib/io/file_kind.hpp>
#include <aib/io/ply.hpp>
#include <aib/io/ply_write.hpp>

#include <filesystem>

namespace aib::io {

struct cloud_options {
  up_axis up = up_axis::z;                 ///< axis that points up in the file
  splat_rule splats = splat_rule::refuse;  ///< PLY files of 3D Gaussian splats
};

/// Reads a cloud; the format is told from the content, then from the extension. Of a mesh file the
/// vertices are read.
///
/// Throws format_error where the format is not known or the file is damaged, io_error where it
/// cannot be read.
inline cloud::cloud read_cloud(const std::filesystem::path& path,
                               const cloud_options& options = {}) {
  cloud::cloud result;
  switch (kind_of(path)) {
    case file_kind::ply:
      result = read_ply_cloud(path, options.splats);
      break;
    default:
      throw format_error(path, "a cloud expected: PLY");
  }
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
