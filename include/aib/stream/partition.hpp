// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace aib::stream {

/// A coordinate triple as it lies on disk.
using point = std::array<float, 3>;

/// Space cut into tiles by planes along the axes, each at the median of a sample, across the
/// longest side.
class partition {
 public:
  /// 2^depth tiles.
  partition(std::vector<point> sample, int depth) : depth_(depth) {
    nodes_.resize((std::size_t{1} << depth) - 1);
    split(sample, 0, 0);
  }

  [[nodiscard]] std::size_t size() const { return nodes_.size() + 1; }

  [[nodiscard]] std::uint16_t tile_of(const point& p) const {
    std::size_t node = 0;
    while (node < nodes_.size()) {
      const cut& c = nodes_[node];
      node = 2 * node + (p[c.axis] < c.place ? 1 : 2);
    }
    return static_cast<std::uint16_t>(node - nodes_.size());
  }

 private:
  struct cut {
    std::size_t axis = 0;
    float place = 0;
  };

  static std::size_t longest_axis(std::span<const point> points) {
    std::array<float, 3> extent{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] =
          std::minmax_element(points.begin(), points.end(),
                              [k](const point& a, const point& b) { return a[k] < b[k]; });
      extent[k] = (*high)[k] - (*low)[k];
    }
    return static_cast<std::size_t>(std::max_element(extent.begin(), extent.end()) -
                                    extent.begin());
  }

  void split(std::span<point> points, std::size_t node, int level) {
    if (level == depth_) return;
    const std::size_t half = points.size() / 2;
    if (!points.empty()) {
      const std::size_t k = longest_axis(points);
      std::nth_element(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(half),
                       points.end(), [k](const point& a, const point& b) { return a[k] < b[k]; });
      nodes_[node] = {k, points[half][k]};
    }
    split(points.first(half), 2 * node + 1, level + 1);
    split(points.subspan(half), 2 * node + 2, level + 1);
  }

  int depth_;
  std::vector<cut> nodes_;
};

}  // namespace aib::stream
