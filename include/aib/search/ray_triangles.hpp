// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/isa.hpp>
#include <aib/core/simd.hpp>
#include <aib/search/ray_fan.hpp>
#include <aib/search/ray_tree.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace aib::search {

inline namespace AIB_ISA {

namespace detail {

/// How far forward a ray in the plane of a triangle meets its outline.
inline double side_distance(const ray_frame& frame,
                            const Eigen::Vector3d& ray,
                            const Eigen::Vector3d& normal,
                            const std::array<Eigen::Vector3d, 3>& triangle) {
  const Eigen::Vector3d forward = frame.axes.row(2), aside = normal.cross(ray);
  double nearest = HUGE_VAL;
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector3d from = triangle[k] - frame.origin;
    const Eigen::Vector3d to = triangle[(k + 1) % 3] - frame.origin;
    const double before = aside.dot(from), behind = aside.dot(to);
    if ((before > 0) == (behind > 0)) continue;
    const double share = before / (before - behind);
    nearest = std::min(nearest, forward.dot(from) + share * forward.dot(to - from));
  }
  return nearest;
}

}  // namespace detail

/// How far forward in the frame a ray meets a triangle that it hits: at origin + distance * ray. A
/// ray that passes an edge by a rounding error is held within the triangle's own range.
[[nodiscard]] inline double forward_distance(const ray_frame& frame,
                                             const Eigen::Vector3d& ray,
                                             const std::array<Eigen::Vector3d, 3>& triangle) {
  const Eigen::Vector3d a = triangle[0] - frame.origin;
  const Eigen::Vector3d ab = triangle[1] - triangle[0], ac = triangle[2] - triangle[0];
  const Eigen::Vector3d normal = ab.cross(ac);
  const double steepness = normal.dot(ray);
  const Eigen::Vector3d forward = frame.axes.row(2);
  const double at_a = forward.dot(a), at_b = at_a + forward.dot(ab), at_c = at_a + forward.dot(ac);
  const double low = std::min({at_a, at_b, at_c}), high = std::max({at_a, at_b, at_c});
  const bool from_the_side = steepness * steepness <= 1e-12 * normal.squaredNorm();
  const double distance = from_the_side ? detail::side_distance(frame, ray, normal, triangle)
                                        : normal.dot(a) / steepness;
  return distance > low ? std::min(distance, high) : low;
}

/// Eight vectors, coordinates side by side.
struct vector_f32x8 {
  f32x8 x, y, z;

  friend vector_f32x8 operator-(const vector_f32x8& a, const vector_f32x8& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
};

inline f32x8 dot(const vector_f32x8& a, const vector_f32x8& b) {
  return (a.x * b.x + a.y * b.y) + a.z * b.z;
}
/// Swapping the factors changes the sign and no other bit.
inline vector_f32x8 cross(const vector_f32x8& a, const vector_f32x8& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline f32x8 absolute(f32x8 a) { return max(a, f32x8::broadcast(0) - a); }

/// A ray_frame eight-fold. The origin is held as the sum of two floats, so that what is near the
/// camera is placed as exactly as the camera is, wherever that stands.
class ray_frame_f32x8 {
 public:
  explicit ray_frame_f32x8(const ray_frame& frame) {
    for (int a = 0; a < 3; ++a) {
      const auto coarse = static_cast<float>(frame.origin[a]);
      coarse_[a] = f32x8::broadcast(coarse);
      fine_[a] =
          f32x8::broadcast(static_cast<float>(frame.origin[a] - static_cast<double>(coarse)));
      for (int b = 0; b < 3; ++b)
        axes_[a][b] = f32x8::broadcast(static_cast<float>(frame.axes(a, b)));
    }
  }

  /// Eight coordinates on an axis of the world, counted from the origin.
  [[nodiscard]] f32x8 from_origin(const float* coordinates, int axis) const {
    return (f32x8::load(coordinates) - coarse_[axis]) - fine_[axis];
  }

  /// A corner of the triangles in the frame.
  [[nodiscard]] vector_f32x8 corner(const triangle_block& block, int k) const {
    const f32x8 x = from_origin(block.corner[k][0], 0);
    const f32x8 y = from_origin(block.corner[k][1], 1);
    const f32x8 z = from_origin(block.corner[k][2], 2);
    const auto along = [&](int a) { return (axes_[a][0] * x + axes_[a][1] * y) + axes_[a][2] * z; };
    return {along(0), along(1), along(2)};
  }

 private:
  f32x8 coarse_[3], fine_[3], axes_[3][3];
};

/// Bits of the lanes of a block or node that are there.
constexpr unsigned first_lanes(std::uint32_t n) { return (1u << n) - 1; }

/// Eight triangles as their outlines and inverse depths in the plane of slopes.
///
/// A ray (s, t, 1) hits where every edge function `edge.x s + edge.y t + edge.z` is >= 0. They are
/// raised by a bound of their rounding error: between two triangles that share an edge or a corner
/// no ray finds a gap. There its inverse forward distance is `inverse.x s + inverse.y t +
/// inverse.z`, held within [farthest, nearest].
///
/// Source: Olano and Greer, "Triangle scan conversion using 2D homogeneous coordinates", 1997: the
/// functions hold for corners behind the camera as well.
struct triangle_outlines {
  vector_f32x8 edge[3];
  f32x8 slack[3];  ///< by which each edge is raised
  vector_f32x8 inverse;
  f32x8 farthest, nearest;
  unsigned edge_on;  ///< lanes that are seen from the side: either orientation may hit
  unsigned nowhere;  ///< those of them that the camera's plane cuts: they hide nothing

  /// largest_slope   of all rays
  triangle_outlines(const vector_f32x8 (&corner)[3], float largest_slope);

  /// Turns to the other orientation.
  void turn() {
    const f32x8 zero = f32x8::broadcast(0), two = f32x8::broadcast(2);
    for (int k = 0; k < 3; ++k) {
      vector_f32x8& e = edge[k];
      e = {zero - e.x, zero - e.y, two * slack[k] - e.z};
    }
  }
};

namespace detail {

/// What the products in a cross product could add up to: of its z, and of its x and y.
struct cross_bound {
  f32x8 z, xy;

  cross_bound(const vector_f32x8& a, const vector_f32x8& b) {
    const f32x8 side_a = max(absolute(a.x), absolute(a.y));
    const f32x8 side_b = max(absolute(b.x), absolute(b.y));
    z = (side_a * side_b) * f32x8::broadcast(2);
    xy = side_a * absolute(b.z) + absolute(a.z) * side_b;
  }
};

/// Eight units of rounding: more than any sum here gathers.
inline constexpr float rounding = 5e-7f;

}  // namespace detail

inline triangle_outlines::triangle_outlines(const vector_f32x8 (&corner)[3], float largest_slope) {
  const f32x8 zero = f32x8::broadcast(0), one = f32x8::broadcast(1), two = f32x8::broadcast(2);
  const f32x8 slope = f32x8::broadcast(2 * largest_slope);
  const f32x8 unit = f32x8::broadcast(detail::rounding);
  const detail::cross_bound first(corner[1], corner[2]);
  const f32x8 side = max(absolute(corner[0].x), absolute(corner[0].y));
  const f32x8 uncertain = (absolute(corner[0].z) * first.z + two * (side * first.xy)) * unit;
  const f32x8 volume = dot(corner[0], cross(corner[1], corner[2]));
  const f32x8 sign = choose(volume, zero, f32x8::broadcast(-1), one);
  for (int k = 0; k < 3; ++k) {
    const vector_f32x8& from = corner[(k + 1) % 3];
    const vector_f32x8& to = corner[(k + 2) % 3];
    const detail::cross_bound bound(from, to);
    const vector_f32x8 e = cross(from, to);
    slack[k] = (bound.z + slope * bound.xy) * unit;
    edge[k] = {e.x * sign, e.y * sign, e.z * sign + slack[k]};
  }

  const vector_f32x8 normal = cross(corner[1] - corner[0], corner[2] - corner[0]);
  const f32x8 scale = one / dot(normal, corner[0]);
  inverse = {normal.x * scale, normal.y * scale, normal.z * scale};
  const f32x8 near_z = min(min(corner[0].z, corner[1].z), corner[2].z);
  const f32x8 far_z = max(max(corner[0].z, corner[1].z), corner[2].z);
  farthest = choose(zero, near_z, one / far_z, zero);
  nearest = choose(zero, near_z, one / near_z, f32x8::broadcast(1e30f));
  edge_on = ~less(uncertain, absolute(volume)) & 0xffu;
  nowhere = edge_on & ~less(zero, near_z);
}

}  // namespace AIB_ISA
}  // namespace aib::search
