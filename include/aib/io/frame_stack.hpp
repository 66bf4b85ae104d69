// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/io/array_depth.hpp>
#include <aib/io/file.hpp>
#include <aib/io/file_kind.hpp>
#include <aib/io/npy.hpp>
#include <aib/raster/image.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#if defined(AIB_WITH_NPZ)
#include <aib/io/npz.hpp>
#endif

namespace aib::io {

/// The frames of one array of an NPY or NPZ file, read one at a time: depth maps, confidences
/// (H x W each) or point maps (H x W x 3). Memory holds one frame, whatever the file's size. Frames
/// of a deflated member are cheap in their order; going back begins anew.
///
/// The checksum of an NPZ member is not verified, since nobody reads all of it.
class frame_stack {
 public:
  /// key   the array of an NPZ file; empty: as read_array_frames chooses
  /// Throws io_error where the file cannot be opened, format_error where the array is none of N x H
  /// x W (x 1, x 3 for the names of point maps) or is in Fortran order.
  explicit frame_stack(const std::filesystem::path& path, const std::string& key = {});

  [[nodiscard]] std::size_t size() const { return shape_.n; }
  [[nodiscard]] std::size_t height() const { return shape_.height; }
  [[nodiscard]] std::size_t width() const { return shape_.width; }
  [[nodiscard]] bool is_point_map() const { return shape_.components == 3; }

  /// Frame i as it is stored. Throws argument_error where there is none.
  [[nodiscard]] array at(std::size_t i);

  /// Frame i as a picture: of a point map its z.
  [[nodiscard]] raster::image<float> frame(std::size_t i);

 private:
  void open_npy(const std::filesystem::path& path);
  void open_npz(const std::filesystem::path& path, const std::string& key);
  void set_shape(const detail::npy_header& header,
                 const std::filesystem::path& path,
                 std::string_view name);

  /// Bytes of the array's file from its first element on.
  class source {
   public:
    source() = default;
    source(const source&) = delete;
    source& operator=(const source&) = delete;
    virtual ~source() = default;
    virtual void read(std::uint64_t offset, std::string& to) = 0;
  };
  class plain_source;
#if defined(AIB_WITH_NPZ)
  class deflated_source;
#endif

  std::unique_ptr<source> source_;
  dtype type_ = dtype::f4;
  bool reversed_ = false;
  detail::frame_shape shape_;
};

namespace detail {

inline bool is_point_map_name(std::string_view name) {
  constexpr std::array<std::string_view, 4> names{"local_points", "points", "world_points",
                                                  "world_points_from_depth"};
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace detail

/// A part of a file that lies there as it is.
class frame_stack::plain_source : public frame_stack::source {
 public:
  plain_source(const std::filesystem::path& path, std::uint64_t begin)
      : file_(path), begin_(begin) {}
  void read(std::uint64_t offset, std::string& to) override {
    file_.read_at(begin_ + offset, to.data(), to.size());
  }

 private:
  input_file file_;
  std::uint64_t begin_;
};

#if defined(AIB_WITH_NPZ)

/// A deflated part of a file, inflated from its begin on as far as is asked for.
class frame_stack::deflated_source : public frame_stack::source {
 public:
  deflated_source(const std::filesystem::path& path,
                  const npz_place& place,
                  std::uint64_t header_bytes)
      : file_(path), place_(place), header_bytes_(header_bytes) {}

  void read(std::uint64_t offset, std::string& to) override {
    const std::uint64_t wanted = header_bytes_ + offset;
    if (!stream_ || wanted < at_) restart();
    std::string skipped;
    while (at_ < wanted) {
      constexpr std::uint64_t step = std::uint64_t{1} << 20;
      skipped.resize(static_cast<std::size_t>(std::min(step, wanted - at_)));
      fill(skipped);
    }
    fill(to);
  }

 private:
  void restart() {
    stream_ = std::make_unique<detail::deflate_stream>();
    at_ = packed_at_ = 0;
    block_.clear();
  }

  void fill(std::string& to) {
    std::size_t filled = 0;
    while (filled < to.size()) {
      const std::size_t before = filled;
      if (!stream_->fill(to, filled)) fail();
      if (filled == to.size()) break;
      if (packed_at_ == place_.packed) {
        if (filled == before) fail();
        continue;
      }
      constexpr std::uint64_t step = std::uint64_t{1} << 20;
      block_.resize(static_cast<std::size_t>(std::min(step, place_.packed - packed_at_)));
      file_.read_at(place_.begin + packed_at_, block_.data(), block_.size());
      packed_at_ += block_.size();
      stream_->input(block_);
    }
    at_ += to.size();
  }

  [[noreturn]] void fail() const {
    throw format_error(file_.path(), "npz: the deflated data is damaged or cut off");
  }

  input_file file_;
  npz_place place_;
  std::uint64_t header_bytes_;
  std::unique_ptr<detail::deflate_stream> stream_ = {};
  std::string block_ = {};
  std::uint64_t at_ = 0;         ///< of the inflated bytes
  std::uint64_t packed_at_ = 0;  ///< of the deflated ones
};

inline void frame_stack::open_npz(const std::filesystem::path& path, const std::string& key) {
  const npz_file file(path);
  const std::string name = detail::depth_member(file, key);
  const detail::npy_header header = file.npy_header_of(name);
  const npz_place place = file.place_of(name);
  set_shape(header, path, name);
  if (place.is_deflated)
    source_ = std::make_unique<deflated_source>(path, place, header.begin);
  else
    source_ = std::make_unique<plain_source>(path, place.begin + header.begin);
}

#else

inline void frame_stack::open_npz(const std::filesystem::path& path, const std::string&) {
  throw format_error(path, "this build of aib reads no NPZ; build it with zlib");
}

#endif

inline void frame_stack::open_npy(const std::filesystem::path& path) {
  const input_file file(path);
  const std::string begin = file.begin(1 << 16);
  const detail::npy_header header = detail::read_npy_header(begin, file.size(), path);
  set_shape(header, path, path.stem().string());
  source_ = std::make_unique<plain_source>(path, header.begin);
}

inline frame_stack::frame_stack(const std::filesystem::path& path, const std::string& key) {
  if (kind_of(path) == file_kind::npz)
    open_npz(path, key);
  else
    open_npy(path);
}

inline void frame_stack::set_shape(const detail::npy_header& header,
                                   const std::filesystem::path& path,
                                   std::string_view name) {
  const auto shape = detail::find_frames(header.shape, detail::is_point_map_name(name) ? 3 : 1);
  if (!shape || header.fortran) {
    throw format_error(
        path, message("an array of N x H x W in C order expected in ", name, ", found ",
                      text_of_shape(header.shape), header.fortran ? " in Fortran order" : ""));
  }
  type_ = header.type;
  reversed_ = header.order != std::endian::native;
  shape_ = *shape;
}

inline array frame_stack::at(std::size_t i) {
  const auto& [n, height, width, components] = shape_;
  if (i >= n) throw argument_error(message("frame ", i + 1, " of ", n, " does not exist"));
  array frame{type_, {height, width}, {}};
  if (components > 1) frame.shape.push_back(components);
  frame.bytes.resize(height * width * components * size_of(type_));
  source_->read(std::uint64_t{i} * frame.bytes.size(), frame.bytes);
  if (reversed_) detail::reverse_elements(frame.bytes, size_of(type_));
  return frame;
}

inline raster::image<float> frame_stack::frame(std::size_t i) {
  const std::vector<float> values = at(i).values<float>();
  raster::image<float> image(width(), height());
  for (std::size_t k = 0; k < image.size(); ++k)
    image.data()[k] = values[k * shape_.components + shape_.components - 1];
  return image;
}

}  // namespace aib::io
