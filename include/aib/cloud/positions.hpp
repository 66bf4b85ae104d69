// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/cloud.hpp>
#include <aib/cloud/origin.hpp>
#include <aib/core/concepts.hpp>
#include <aib/core/error.hpp>

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <ranges>
#include <span>
#include <utility>
#include <vector>

namespace aib::cloud {

/// Whether the three coordinates are finite, and so are squared distances between such points in
/// float: beyond 2^62 a coordinate counts as infinite.
[[nodiscard]] inline bool is_finite(const Eigen::Vector3f& p) {
  constexpr float largest = 0x1p62F;
  return std::abs(p.x()) <= largest && std::abs(p.y()) <= largest && std::abs(p.z()) <= largest;
}

/// Positions in double as the float points of a cloud, see origin_finder.
struct placed_points {
  Eigen::Vector3d origin;
  std::vector<Eigen::Vector3f> points;
};

/// Places n positions; `position(i)` is called twice for each i. Non-finite positions stay what
/// they are and have no part in the origin.
template <class Position>
[[nodiscard]] placed_points place(std::size_t n, Position&& position) {
  origin_finder origin(n);
  for (std::size_t i = 0; i < n; ++i) origin.add(position(i));
  placed_points placed;
  placed.origin = origin.result();
  placed.points.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector3d p = position(i) - placed.origin;
    placed.points[i] = p.cast<float>();
  }
  return placed;
}

/// The cloud of a range of points of any type that `point_traits` knows.
template <point_range Range>
[[nodiscard]] cloud from_points(const Range& range) {
  const auto at = [&](std::size_t i) {
    using difference = std::ranges::range_difference_t<const Range>;
    return as_vector<double>(std::ranges::begin(range)[static_cast<difference>(i)]);
  };
  placed_points placed = place(static_cast<std::size_t>(std::ranges::size(range)), at);
  return {.origin = placed.origin, .points = std::move(placed.points)};
}

/// The finite points of a cloud as floats from a chosen origin. Borrows the cloud where nothing has
/// to be changed.
class finite_points {
 public:
  finite_points(const cloud& source, const Eigen::Vector3d& origin) : n_given_(source.size()) {
    if (source.size() > std::numeric_limits<std::uint32_t>::max()) {
      throw argument_error(
          message("cloud: at most 4 294 967 295 points expected, found ", source.size()));
    }
    if (source.origin == origin && all_finite(source.points)) {
      borrowed_ = source.points;
    } else {
      copy_finite(source, source.origin - origin);
    }
  }

  [[nodiscard]] std::span<const Eigen::Vector3f> points() const {
    return copied_ ? std::span<const Eigen::Vector3f>(own_) : borrowed_;
  }
  [[nodiscard]] std::size_t n_given() const { return n_given_; }
  [[nodiscard]] std::size_t n_dropped() const { return n_given_ - points().size(); }

  /// Index in the cloud of finite point i.
  [[nodiscard]] std::size_t source_index(std::size_t i) const { return copied_ ? kept_[i] : i; }

 private:
  static bool all_finite(std::span<const Eigen::Vector3f> points) {
    for (const Eigen::Vector3f& p : points) {
      if (!is_finite(p)) return false;
    }
    return true;
  }

  void copy_finite(const cloud& source, const Eigen::Vector3d& shift) {
    copied_ = true;
    own_.reserve(source.size());
    kept_.reserve(source.size());
    for (std::size_t i = 0; i < source.size(); ++i) {
      const Eigen::Vector3d moved = shift + source.points[i].cast<double>();
      const Eigen::Vector3f p = moved.cast<float>();
      if (!is_finite(p)) continue;
      own_.push_back(p);
      kept_.push_back(static_cast<std::uint32_t>(i));
    }
  }

  std::size_t n_given_;
  bool copied_ = false;
  std::span<const Eigen::Vector3f> borrowed_;
  std::vector<Eigen::Vector3f> own_;
  std::vector<std::uint32_t> kept_;
};

}  // namespace aib::cloud
