// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/depth/depth_map.hpp>
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

/// Depth maps in an array: H x W, or N of them, with axes of length 1 before or behind as the
/// methods leave them (VGGT: N x H x W x 1, pi3: 1 x N x H x W x 3).
class array_frames {
 public:
  /// points   the last axis is x, y, z in the frame of the camera, of which z is taken
  /// Throws format_error where the array has not that shape.
  array_frames(array values, const std::filesystem::path& path, std::string_view name);

  [[nodiscard]] std::size_t size() const { return n_; }

  /// Frame number i < size().
  [[nodiscard]] raster::image<float> frame(std::size_t i) const;

 private:
  array values_;
  std::size_t n_ = 1, height_ = 0, width_ = 0;
  std::size_t components_ = 1;
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
  std::vector<std::size_t> shape = values_.shape;
  if (shape.size() > 2 && shape.back() == 3 && name == "local_points") {
    components_ = 3;
    shape.pop_back();
  }
  if (shape.size() > 2 && shape.back() == 1) shape.pop_back();
  while (shape.size() > 2 && shape.front() == 1) shape.erase(shape.begin());
  if (shape.size() < 2 || shape.size() > 3 || values_.size() == 0) {
    throw format_error(
        path, message("an array of H x W or N x H x W expected", name.empty() ? "" : " in ", name,
                      ", found ", text_of_shape(values_.shape)));
  }
  width_ = shape.back();
  height_ = shape[shape.size() - 2];
  if (shape.size() == 3) n_ = shape.front();
}

inline raster::image<float> array_frames::frame(std::size_t i) const {
  if (i >= n_) {
    throw argument_error(message("frame ", i + 1, " of ", n_, " does not exist"));
  }
  raster::image<float> image(width_, height_);
  const std::size_t first = i * image.size() * components_ + (components_ - 1);
  for (std::size_t k = 0; k < image.size(); ++k)
    image.data()[k] = static_cast<float>(values_[first + k * components_]);
  return image;
}

#if defined(AIB_WITH_NPZ)

namespace detail {

/// The array of an NPZ file that holds depth.
inline std::string depth_member(const npz_file& file, const std::string& key) {
  const std::vector<std::string> names = file.names();
  const auto list = [&] {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
    return text;
  };
  if (!key.empty()) {
    if (file.contains(key)) return key;
    throw format_error(file.path(), message("npz: no array \"", key, "\"; there are ", list()));
  }
  for (const char* usual : {"depth", "depths", "local_points"})
    if (file.contains(usual) && !file.is_unreadable(usual)) return usual;
  std::vector<std::string> pictures;
  for (const std::string& name : names) {
    if (!file.is_unreadable(name) && file.read_header(name).shape.size() >= 2)
      pictures.push_back(name);
  }
  if (pictures.size() == 1) return pictures.front();
  throw format_error(file.path(), message("npz: no array is called depth; name one of ", list()));
}

}  // namespace detail

#endif

inline array_frames read_array_frames(const std::filesystem::path& path,
                                      const std::string& key,
                                      [[maybe_unused]] const limits& limits) {
  std::string begin(2, '\0');
  const input_file file(path);
  if (file.size() >= begin.size()) file.read_at(0, begin.data(), begin.size());
  if (begin != "PK") return array_frames(read_npy(path), path, key);
#if defined(AIB_WITH_NPZ)
  const npz_file members(path, limits);
  const std::string name = detail::depth_member(members, key);
  return array_frames(members.read(name), path, name);
#else
  throw format_error(path, "this build of aib reads no NPZ; build it with zlib");
#endif
}

}  // namespace aib::io
