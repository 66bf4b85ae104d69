// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include <array>
#include <concepts>
#include <cstddef>
#include <ranges>
#include <type_traits>

namespace aib {

/// Teaches aib a point type. A specialisation has
///   using scalar = float or double;
///   static scalar coordinate(const Point& point, int axis);   // axis 0, 1, 2
template <class Point>
struct point_traits;

template <std::floating_point Scalar, int Options>
struct point_traits<Eigen::Matrix<Scalar, 3, 1, Options>> {
  using scalar = Scalar;
  static scalar coordinate(const Eigen::Matrix<Scalar, 3, 1, Options>& point, int axis) {
    return point[axis];
  }
};

template <std::floating_point Scalar>
struct point_traits<std::array<Scalar, 3>> {
  using scalar = Scalar;
  static scalar coordinate(const std::array<Scalar, 3>& point, int axis) {
    return point[static_cast<std::size_t>(axis)];
  }
};

/// A type that `point_traits` knows.
template <class Point>
concept point = requires(const Point& p) {
  typename point_traits<Point>::scalar;
  { point_traits<Point>::coordinate(p, 0) } -> std::same_as<typename point_traits<Point>::scalar>;
};

/// Any sized random-access range of points: a vector, a span, a range of your own.
template <class Range>
concept point_range = std::ranges::random_access_range<const Range> &&
    std::ranges::sized_range<const Range> && point<std::ranges::range_value_t<const Range>>;

/// Scalar of the points of a range.
template <point_range Range>
using scalar_of = typename point_traits<std::ranges::range_value_t<const Range>>::scalar;

/// The point as an Eigen vector of another scalar.
template <class Scalar, point Point>
Eigen::Matrix<Scalar, 3, 1> as_vector(const Point& p) {
  using traits = point_traits<Point>;
  return {static_cast<Scalar>(traits::coordinate(p, 0)),
          static_cast<Scalar>(traits::coordinate(p, 1)),
          static_cast<Scalar>(traits::coordinate(p, 2))};
}

}  // namespace aib
