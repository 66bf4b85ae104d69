// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/depth/depth_map.hpp>
#include <aib/io/array_depth.hpp>
#include <aib/io/colmap_depth.hpp>
#include <aib/io/dmap.hpp>
#include <aib/io/file_kind.hpp>
#include <aib/io/limits.hpp>
#include <aib/io/npy.hpp>
#include <aib/io/pfm.hpp>
#include <aib/io/range_depth.hpp>
#include <aib/io/raw_depth.hpp>
#include <aib/math/camera.hpp>
#include <aib/raster/downsample.hpp>
#include <aib/raster/image.hpp>
#include <aib/raster/view.hpp>

#if defined(AIB_WITH_EXR)
#include <aib/io/exr.hpp>
#endif
#if defined(AIB_WITH_PNG)
#include <aib/io/png.hpp>
#endif

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace aib::io {

struct depth_options {
  std::string channel = {};               ///< EXR: name of the channel; empty: see read_exr
  std::string key = {};                   ///< NPZ: name of the array; empty: see read_array_frames
  std::optional<std::size_t> index = {};  ///< NPY, NPZ of several frames: which one
  /// Stored value of one unit of length: 1000 for millimetres, TUM 5000, KITTI 256.
  /// 0: 1000 for PNG, 1 for all others.
  double scale = 0;
  double max_depth = std::numeric_limits<double>::infinity();  ///< this and beyond becomes 0
  std::size_t width = 0, height = 0;  ///< size of the result by nearest neighbour; 0: the file's
  raster::nearest_rule rule = raster::nearest_rule::centre;
  std::size_t raw_width = 0, raw_height = 0;      ///< files without header (ETH3D): their size
  std::optional<math::camera> range_camera = {};  ///< the file holds distances along its rays
  io::limits limits = {};
};

/// Reads a depth map; the format is told from the content, then from the extension: EXR, PFM, NPY,
/// NPZ, 16-bit PNG, COLMAP .bin, OpenMVS .dmap, and headerless floats where their size is given.
/// Planar depth; pixels without depth are 0 or not finite. What was removed, assumed or is in doubt
/// stands in the warnings.
///
/// Throws format_error where the format is not known or the file is damaged, io_error where it
/// cannot be read, argument_error where an option has no meaning.
depth::depth_map read_depth(const std::filesystem::path& path, const depth_options& options = {});

/// Reads all frames of an NPY or NPZ array; of any other file the one that it has.
/// Throws as read_depth does.
std::vector<depth::depth_map> read_depth_stack(const std::filesystem::path& path,
                                               const depth_options& options = {});

struct depth_write_options {
  double scale = 1000;  ///< PNG: stored value of one unit of length
};

/// Writes a depth map in the format of the extension: .exr (float, ZIP), .pfm, .npy (float, H x W),
/// .png (16 bits; what is not finite, not positive or beyond 65535 becomes 0).
/// Throws argument_error for another extension.
void write_depth(const std::filesystem::path& path,
                 raster::view<const float> depth,
                 const depth_write_options& options = {});

namespace detail {

inline depth::depth_map read_depth_array(const std::filesystem::path& path,
                                         const depth_options& options) {
  const array_frames frames = read_array_frames(path, options.key, options.limits);
  if (!options.index && frames.size() > 1)
    throw argument_error(message(path.string(), ": ", frames.size(),
                                 " frames in the array; the option index says which to read"));
  return {frames.frame(options.index.value_or(0))};
}

inline depth::depth_map read_exr_depth(const std::filesystem::path& path,
                                       const depth_options& options) {
#if defined(AIB_WITH_EXR)
  // Rays need all pixels at their places; else lines that nobody asks for are not decoded.
  const bool shrink = !options.range_camera;
  return read_exr(path, {.channel = options.channel,
                         .width = shrink ? options.width : 0,
                         .height = shrink ? options.height : 0,
                         .rule = options.rule,
                         .limits = options.limits});
#else
  static_cast<void>(options);
  throw format_error(path, "this build of aib reads no EXR; build it with zlib");
#endif
}

inline depth::depth_map read_png_depth(const std::filesystem::path& path,
                                       const depth_options& options) {
#if defined(AIB_WITH_PNG)
  png_decoder decoder(path, options.limits);
  const png_header header = decoder.header();
  if (header.bits != 16 || !header.is_gray)
    throw format_error(path,
                       "png: gray depth of 16 bits expected; 8 bits or colours are a picture "
                       "of depth, not depth");
  const auto stored = decode_gray(decoder);
  depth::depth_map result{raster::image<float>(stored.width(), stored.height())};
  std::copy(stored.begin(), stored.end(), result.values.begin());
  if (options.scale == 0)
    result.warnings.push_back("1000 steps a unit were assumed; the option scale says otherwise");
  return result;
#else
  static_cast<void>(options);
  throw format_error(path, "this build of aib reads no PNG; build it with libspng");
#endif
}

inline depth::depth_map read_stored_depth(const std::filesystem::path& path,
                                          file_kind kind,
                                          const depth_options& options) {
  if (options.raw_width > 0 && options.raw_height > 0)
    return read_raw_depth(path, options.raw_width, options.raw_height);
  switch (kind) {
    case file_kind::colmap_map:
      return read_colmap_depth(path);
    case file_kind::dmap:
      return read_dmap(path);
    case file_kind::exr:
      return read_exr_depth(path, options);
    case file_kind::npy:
    case file_kind::npz:
      return read_depth_array(path, options);
    case file_kind::pfm:
      return read_pfm(path);
    case file_kind::png:
      return read_png_depth(path, options);
    default:
      throw format_error(path,
                         "a depth map expected: EXR, PFM, NPY, NPZ, 16-bit PNG, COLMAP .bin, "
                         ".dmap, or floats without header whose size is given");
  }
}

inline void clear_from(depth::depth_map& map, double max_depth) {
  std::size_t n = 0;
  for (float& depth : map.values) {
    if (!(static_cast<double>(depth) >= max_depth)) continue;
    depth = 0;
    ++n;
  }
  if (n > 0) {
    map.warnings.push_back(message(n, " of ", map.values.size(), " pixels are at max_depth ",
                                   max_depth, " or beyond"));
  }
}

/// Stored values to depth of the wanted size.
inline depth::depth_map finish_depth(depth::depth_map map,
                                     file_kind kind,
                                     const depth_options& options) {
  const double usual = kind == file_kind::png ? 1000 : 1;
  const double scale = options.scale > 0 ? options.scale : usual;
  if (scale != 1)
    for (float& depth : map.values) depth = static_cast<float>(static_cast<double>(depth) / scale);
  if (options.range_camera) planar_from_range(map.values, *options.range_camera);
  if (options.max_depth < std::numeric_limits<double>::infinity())
    clear_from(map, options.max_depth);
  const std::size_t width = options.width ? options.width : map.values.width();
  const std::size_t height = options.height ? options.height : map.values.height();
  if (width != map.values.width() || height != map.values.height())
    map.values = raster::resample_nearest<float>(map.values, width, height, options.rule);
  return map;
}

inline void check_depth_options(const depth_options& options) {
  if (!(options.scale >= 0) || !(options.max_depth > 0))
    throw argument_error("io::read_depth: scale >= 0 and max_depth > 0 expected");
}

inline raster::image<std::uint16_t> depth_steps(raster::view<const float> depth, double scale) {
  raster::image<std::uint16_t> steps(depth.width, depth.height);
  for (std::size_t y = 0; y < depth.height; ++y) {
    for (std::size_t x = 0; x < depth.width; ++x) {
      const double step = std::round(static_cast<double>(depth(x, y)) * scale);
      steps(x, y) = step > 0 && step <= 65535 ? static_cast<std::uint16_t>(step) : std::uint16_t{0};
    }
  }
  return steps;
}

}  // namespace detail

inline depth::depth_map read_depth(const std::filesystem::path& path,
                                   const depth_options& options) {
  detail::check_depth_options(options);
  const file_kind kind = kind_of(path);
  depth::depth_map stored = detail::read_stored_depth(path, kind, options);
  demand_pixels(path, "depth", stored.values.width(), stored.values.height(), options.limits);
  return detail::finish_depth(std::move(stored), kind, options);
}

inline std::vector<depth::depth_map> read_depth_stack(const std::filesystem::path& path,
                                                      const depth_options& options) {
  detail::check_depth_options(options);
  const file_kind kind = kind_of(path);
  std::vector<depth::depth_map> stack;
  if (kind != file_kind::npy && kind != file_kind::npz) {
    stack.push_back(read_depth(path, options));
    return stack;
  }
  const array_frames frames = read_array_frames(path, options.key, options.limits);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    depth::depth_map frame{frames.frame(i)};
    demand_pixels(path, "depth", frame.values.width(), frame.values.height(), options.limits);
    stack.push_back(detail::finish_depth(std::move(frame), kind, options));
  }
  return stack;
}

inline void write_depth(const std::filesystem::path& path,
                        raster::view<const float> depth,
                        const depth_write_options& options) {
  const std::string extension = extension_of(path);
  if (depth.empty()) throw argument_error("io::write_depth: an empty depth map");
  if (extension == ".pfm") return write_pfm(path, depth);
  if (extension == ".npy") {
    std::vector<float> values;
    for (std::size_t y = 0; y < depth.height; ++y)
      values.insert(values.end(), depth.row(y).begin(), depth.row(y).end());
    return write_npy(path, make_array<float>({depth.height, depth.width}, values));
  }
#if defined(AIB_WITH_EXR)
  if (extension == ".exr") return write_exr(path, depth);
#endif
#if defined(AIB_WITH_PNG)
  if (extension == ".png")
    return write_png<std::uint16_t>(path, detail::depth_steps(depth, options.scale));
#else
  static_cast<void>(options);
#endif
  throw argument_error(
      message("io::write_depth: the extension .exr, .pfm, .npy or .png expected, "
              "found \"",
              path.extension().string(), "\""));
}

}  // namespace aib::io
