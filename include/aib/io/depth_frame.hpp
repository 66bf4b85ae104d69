// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/depth/accumulate.hpp>
#include <aib/io/depth.hpp>
#include <aib/io/image.hpp>
#include <aib/raster/color.hpp>
#include <aib/raster/downsample.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

namespace aib::io {

/// The files of a frame; an empty path: there is none.
struct depth_frame_files {
  std::string name;
  std::filesystem::path estimate;
  std::filesystem::path reference;
  std::filesystem::path mask = {};    ///< gray PNG, 0 leaves a pixel out
  std::filesystem::path labels = {};  ///< gray or indexed PNG
};

struct depth_frame_options {
  depth_options estimate = {};
  depth_options reference = {};  ///< its size and rule are not used
  raster::nearest_rule rule = raster::nearest_rule::centre;
};

/// Reads a frame for depth::accumulate, from any thread. Reference, mask and labels are brought to
/// the size of the estimate by nearest neighbour, never the other way: of an EXR file by lines the
/// lines in between are not even decoded.
///
///   depth::accumulate(files.size(), {}, [&](auto i) { return io::read_depth_frame(files[i]); });
///
/// Throws as read_depth and read_labels do.
[[nodiscard]] inline depth::frame read_depth_frame(const depth_frame_files& files,
                                                   const depth_frame_options& options = {}) {
  depth::frame frame{.name = files.name,
                     .estimate = read_depth(files.estimate, options.estimate),
                     .reference = {}};
  const std::size_t width = frame.estimate.values.width(), height = frame.estimate.values.height();
  depth_options of_reference = options.reference;
  of_reference.width = width;
  of_reference.height = height;
  of_reference.rule = options.rule;
  frame.reference = read_depth(files.reference, of_reference);
  const auto at_size = [&](const std::filesystem::path& path) {
    return raster::resample_nearest<std::uint16_t>(read_labels(path), width, height, options.rule);
  };
  if (!files.mask.empty()) frame.mask = raster::mask_of(at_size(files.mask));
  if (!files.labels.empty()) frame.labels = at_size(files.labels);
  return frame;
}

}  // namespace aib::io
