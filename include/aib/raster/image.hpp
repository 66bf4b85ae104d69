// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/raster/view.hpp>

#include <cstddef>
#include <limits>
#include <vector>

namespace aib::raster {

/// A rectangle of pixels, owned, rows without gaps.
template <class T>
class image {
 public:
  image() = default;
  /// Throws argument_error where there are not so many addresses.
  image(std::size_t width, std::size_t height, T value = {})
      : width_(width), height_(height), pixels_(area(width, height), value) {}

  [[nodiscard]] std::size_t width() const { return width_; }
  [[nodiscard]] std::size_t height() const { return height_; }
  [[nodiscard]] std::size_t size() const { return pixels_.size(); }
  [[nodiscard]] bool empty() const { return pixels_.empty(); }

  [[nodiscard]] T* data() { return pixels_.data(); }
  [[nodiscard]] const T* data() const { return pixels_.data(); }
  [[nodiscard]] T& operator()(std::size_t x, std::size_t y) { return pixels_[y * width_ + x]; }
  [[nodiscard]] const T& operator()(std::size_t x, std::size_t y) const {
    return pixels_[y * width_ + x];
  }

  [[nodiscard]] auto begin() { return pixels_.begin(); }
  [[nodiscard]] auto end() { return pixels_.end(); }
  [[nodiscard]] auto begin() const { return pixels_.begin(); }
  [[nodiscard]] auto end() const { return pixels_.end(); }

  [[nodiscard]] raster::view<T> view() { return {data(), width_, height_, width_}; }
  [[nodiscard]] raster::view<const T> view() const { return {data(), width_, height_, width_}; }
  operator raster::view<T>() { return view(); }
  operator raster::view<const T>() const { return view(); }

  friend bool operator==(const image&, const image&) = default;

 private:
  static std::size_t area(std::size_t width, std::size_t height) {
    if (height != 0 && width > std::numeric_limits<std::ptrdiff_t>::max() / sizeof(T) / height) {
      throw argument_error(
          message("an image of ", width, " x ", height, " pixels is larger than memory can be"));
    }
    return width * height;
  }

  std::size_t width_ = 0;
  std::size_t height_ = 0;
  std::vector<T> pixels_;
};

}  // namespace aib::raster
