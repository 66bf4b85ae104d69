// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/depth/depth_map.hpp>
#include <aib/io/file_kind.hpp>
#include <aib/io/limits.hpp>
#include <aib/io/npy.hpp>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#if defined(AIB_WITH_NPZ)
#include <aib/io/npz.hpp>
#endif

namespace aib::io {

namespace detail {

/// An array's axes as pictures.
struct frame_shape {
  std::size_t n = 1, height = 0, width = 0;
  std::size_t components = 1;  ///< of a pixel
};

/// The pictures of an array of H x W or N x H x W, with axes of length 1 before or behind; nothing
/// where it is none. components   what the last axis may be, if it has that length
inline std::optional<frame_shape> find_frames(std::vector<std::size_t> shape,
                                              std::size_t components) {
  frame_shape frames;
  if (components > 1 && shape.size() > 2 && shape.back() == components) {
    frames.components = components;
    shape.pop_back();
  }
  if (shape.size() > 2 && shape.back() == 1) shape.pop_back();
  while (shape.size() > 2 && shape.front() == 1) shape.erase(shape.begin());
  if (shape.size() < 2 || shape.size() > 3 || element_count(shape).value_or(0) == 0)
    return std::nullopt;
  if (shape.size() == 3) frames.n = shape.front();
  frames.height = shape[shape.size() - 2];
  frames.width = shape.back();
  return frames;
}

}  // namespace detail

/// Depth maps in an array: H x W, or N of them, with axes of length 1 before or behind as the
/// methods leave them (VGGT: N x H x W x 1, pi3: 1 x N x H x W x 3).
class array_frames {
 public:
  /// points   the last axis is x, y, z in the frame of the camera, of which z is taken
  /// Throws format_error where the array has not that shape.
  array_frames(array values, const std::filesystem::path& path, std::string_view name);

  [[nodiscard]] std::size_t size() const { return shape_.n; }

  /// Frame number i < size().
  [[nodiscard]] raster::image<float> frame(std::size_t i) const;

 private:
  array values_;
  detail::frame_shape shape_;
};

/// Reads the depth maps of an NPY or NPZ file.
///
/// key   the array of an NPZ file; empty: `depth`, `depths` or `local_points`, else the only one
///       with two axes or more
///
/// Pickled members are never loaded. Throws format_error where there is no such array.
array_frames read_array_frames(const std::filesystem::path& path,
                               const std::string& key = {},
                               const limits& limits = {});

inline array_frames::array_frames(array values,
                                  const std::filesystem::path& path,
                                  std::string_view name)
    : values_(std::move(values)) {
  const auto shape = detail::find_frames(values_.shape, name == "local_points" ? 3 : 1);
  if (!shape) {
    throw format_error(
        path, message("an array of H x W or N x H x W expected", name.empty() ? "" : " in ", name,
                      ", found ", text_of_shape(values_.shape)));
  }
  shape_ = *shape;
}

inline raster::image<float> array_frames::frame(std::size_t i) const {
  const auto& [n, height, width, components] = shape_;
  if (i >= n) throw argument_error(message("frame ", i + 1, " of ", n, " does not exist"));
  raster::image<float> image(width, height);
  const std::size_t first = i * image.size() * components + (components - 1);
  const auto load = detail::loader(values_.type);
  const char* from = values_.bytes.data() + first * size_of(values_.type);
  for (float& value : image) {
    value = static_cast<float>(load(from));
    from += components * size_of(values_.type);
  }
  return image;
}

#if defined(AIB_WITH_NPZ)

namespace detail {

/// The array of an NPZ file that holds depth.
inline std::string depth_member(const npz_file& file, const std::string& key) {
  if (!key.empty()) {
    if (file.contains(key)) return key;
    throw format_error(file.path(),
                       message("npz: no array \"", key, "\"; there are ", file.list()));
  }
  for (const char* usual : {"depth", "depths", "local_points"})
    if (file.contains(usual) && !file.is_unreadable(usual)) return usual;
  std::vector<std::string> pictures;
  for (const std::string& name : file.names()) {
    if (!file.is_unreadable(name) && file.read_header(name).shape.size() >= 2)
      pictures.push_back(name);
  }
  if (pictures.size() == 1) return pictures.front();
  throw format_error(file.path(),
                     message("npz: no array is called depth; name one of ", file.list()));
}

}  // namespace detail

#endif

inline array_frames read_array_frames(const std::filesystem::path& path,
                                      const std::string& key,
                                      [[maybe_unused]] const limits& limits) {
  if (kind_of(path) != file_kind::npz) return array_frames(read_npy(path), path, key);
#if defined(AIB_WITH_NPZ)
  const npz_file members(path, limits);
  const std::string name = detail::depth_member(members, key);
  return array_frames(members.read(name), path, name);
#else
  throw format_error(path, "this build of aib reads no NPZ; build it with zlib");
#endif
}

}  // namespace aib::io
