// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <type_traits>

namespace aib::raster {

/// A rectangle of pixels that somebody else owns. Row-major, row 0 on top.
template <class T>
struct view {
  T* data = nullptr;
  std::size_t width = 0;
  std::size_t height = 0;
  std::size_t stride = 0;  ///< elements from one row to the next

  [[nodiscard]] T& operator()(std::size_t x, std::size_t y) const { return data[y * stride + x]; }
  [[nodiscard]] std::span<T> row(std::size_t y) const { return {data + y * stride, width}; }
  [[nodiscard]] std::size_t size() const { return width * height; }
  [[nodiscard]] bool empty() const { return size() == 0; }

  operator view<const T>() const requires(!std::is_const_v<T>) {
    return {data, width, height, stride};
  }
};

/// The part of a view that begins at (x, y). The caller keeps it inside.
template <class T>
[[nodiscard]] view<T> part(
    view<T> whole, std::size_t x, std::size_t y, std::size_t width, std::size_t height) {
  return {whole.data + y * whole.stride + x, width, height, whole.stride};
}

}  // namespace aib::raster
