// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/isa.hpp>
#include <aib/search/hilbert.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace aib::search {
inline namespace AIB_ISA {

/// A Hilbert curve through a cube of space. Points outside take the key of the nearest cell, so
/// that a few strays do not take the resolution from all others.
struct curve {
  Eigen::Vector3f low = Eigen::Vector3f::Zero();
  float cells_per_unit = 1;
  int bits = 14;        ///< per axis
  int index_bits = 22;  ///< what is left of 64 bits for the index of a point

  /// Keys of 1 .. 8 points; what is behind them is undefined.
  [[nodiscard]] std::array<std::uint64_t, 8> keys(std::span<const Eigen::Vector3f> points) const {
    std::uint32_t cells[3][8] = {};
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (int axis = 0; axis < 3; ++axis) cells[axis][i] = cell(points[i], axis);
    }
    return hilbert_keys(u32x8::load(cells[0]), u32x8::load(cells[1]), u32x8::load(cells[2]), bits);
  }

 private:
  [[nodiscard]] std::uint32_t cell(const Eigen::Vector3f& p, int axis) const {
    const float last = static_cast<float>((1u << bits) - 1);
    const float place = (p[axis] - low[axis]) * cells_per_unit;
    return static_cast<std::uint32_t>(place > 0 ? std::min(place, last) : 0.0f);
  }
};

namespace detail {

/// Coordinates on one axis of at most 20 000 points of a cloud, evenly picked.
inline void sample_axis(std::span<const Eigen::Vector3f> points,
                        int axis,
                        std::vector<float>& values) {
  const std::size_t step = std::max<std::size_t>(1, points.size() / 20000);
  for (std::size_t i = 0; i < points.size(); i += step) values.push_back(points[i][axis]);
}

struct interval {
  float low;
  float high;
};

/// From the 0.5 to the 99.5 percentile, and a tenth more on both sides.
inline interval bulk_of(std::vector<float>& values) {
  if (values.empty()) return {0, 0};
  const auto cut = static_cast<std::ptrdiff_t>(values.size() / 200);
  std::nth_element(values.begin(), values.begin() + cut, values.end());
  const float low = values[static_cast<std::size_t>(cut)];
  std::nth_element(values.begin(), values.end() - 1 - cut, values.end());
  const float high = *(values.end() - 1 - cut);
  const float margin = (high - low) / 10;
  return {low - margin, high + margin};
}

}  // namespace detail

/// The curve through the bulk of both clouds together.
[[nodiscard]] inline curve common_curve(std::span<const Eigen::Vector3f> a,
                                        std::span<const Eigen::Vector3f> b) {
  const std::size_t most = std::max<std::size_t>({a.size(), b.size(), 2});
  curve c;
  c.index_bits = static_cast<int>(std::bit_width(most - 1));
  c.bits = std::min(14, (64 - c.index_bits) / 3);
  float extent = 0;
  std::vector<float> values;
  for (int axis = 0; axis < 3; ++axis) {
    values.clear();
    detail::sample_axis(a, axis, values);
    detail::sample_axis(b, axis, values);
    const detail::interval bulk = detail::bulk_of(values);
    c.low[axis] = bulk.low;
    extent = std::max(extent, bulk.high - bulk.low);
  }
  if (extent > 0) c.cells_per_unit = static_cast<float>((1u << c.bits) - 1) / extent;
  return c;
}

}  // namespace AIB_ISA
}  // namespace aib::search
