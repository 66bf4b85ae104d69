// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/core/executor.hpp>
#include <aib/math/camera.hpp>
#include <aib/math/projection.hpp>
#include <aib/search/ray_fan.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace aib::render {

/// The rays through the pixel centres of a camera, made once for many frames: squares of 8 x 8
/// pixels, each a fan about its own axes. Of any camera model; a pixel without a ray sees nothing.
class view_rays {
 public:
  static constexpr std::size_t side = 8;  ///< of a square, pixels

  struct square {
    Eigen::Matrix3d axes;  ///< right, down, forward of the fan, in the camera
    search::ray_fan fan;
    std::size_t x, y;  ///< of its first pixel

    /// The pixel of a ray, counted from the square's first.
    static std::size_t column(std::size_t lane) { return lane % 4 + 4 * (lane / 8 % 2); }
    static std::size_t row(std::size_t lane) { return lane / 4 % 2 + 2 * (lane / 16); }
  };

  /// A ray that looks too far aside of its square's others to go with them.
  struct stray {
    Eigen::Vector3d direction;  ///< in the camera, unit length
    std::size_t x, y;
  };

  /// width, height   of the map; 0: those of the camera. Another size sees the same field of view.
  /// Throws argument_error where the size is not known or not below 2^15.
  explicit view_rays(const math::camera& camera,
                     std::size_t width = 0,
                     std::size_t height = 0,
                     unsigned threads = 0);

  [[nodiscard]] std::size_t width() const { return width_; }
  [[nodiscard]] std::size_t height() const { return height_; }
  [[nodiscard]] const std::vector<square>& squares() const { return squares_; }
  [[nodiscard]] const std::vector<stray>& strays() const { return strays_; }

 private:
  using directions = std::array<Eigen::Vector3d, search::ray_fan::lanes>;

  [[nodiscard]] directions directions_of(const math::camera& camera, const square& s) const;
  static std::vector<stray> fill(square& s, const directions& in_camera);

  std::size_t width_, height_;
  std::vector<square> squares_;
  std::vector<stray> strays_;
};

namespace detail {

inline std::size_t map_side(std::size_t wanted, std::uint64_t of_camera, const char* name) {
  const std::uint64_t side = wanted > 0 ? wanted : of_camera;
  if (side > 0 && side < 1u << 15) return static_cast<std::size_t>(side);
  throw argument_error(message("render: a ", name, " of 1 to 32767 pixels expected, found ", side));
}

/// Axes about a direction, right as near to the camera's as may be.
inline Eigen::Matrix3d axes_about(const Eigen::Vector3d& direction) {
  Eigen::Matrix3d axes = search::ray_frame::towards({}, direction).axes;
  const Eigen::Vector3d forward = axes.row(2);
  const Eigen::Vector3d right = Eigen::Vector3d::UnitX() - forward.x() * forward;
  if (right.norm() < 1e-3) return axes;
  axes.row(0) = right.normalized();
  axes.row(1) = forward.cross(right.normalized());
  return axes;
}

}  // namespace detail

inline view_rays::directions view_rays::directions_of(const math::camera& camera,
                                                      const square& s) const {
  const auto scale = [](std::uint64_t of_camera, std::size_t of_map) {
    return of_camera > 0 ? static_cast<double>(of_camera) / static_cast<double>(of_map) : 1;
  };
  const double scale_x = scale(camera.width, width_), scale_y = scale(camera.height, height_);
  directions found;
  for (std::size_t lane = 0; lane < found.size(); ++lane) {
    const std::size_t x = s.x + square::column(lane), y = s.y + square::row(lane);
    found[lane].setConstant(std::numeric_limits<double>::quiet_NaN());
    if (x >= width_ || y >= height_) continue;
    const auto direction = math::unproject(camera, {(static_cast<double>(x) + 0.5) * scale_x,
                                                    (static_cast<double>(y) + 0.5) * scale_y});
    if (direction) found[lane] = *direction;
  }
  return found;
}

inline std::vector<view_rays::stray> view_rays::fill(square& s, const directions& in_camera) {
  constexpr double least_forward = 0.5;  // 60 degrees off the axis of the square
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& d : in_camera)
    if (d.allFinite()) middle += d;
  s.axes = middle.norm() > 1e-3 ? detail::axes_about(middle) : Eigen::Matrix3d::Identity();
  std::vector<stray> strays;
  std::array<Eigen::Vector2d, search::ray_fan::lanes> slopes;
  for (std::size_t lane = 0; lane < slopes.size(); ++lane) {
    const Eigen::Vector3d along = s.axes * in_camera[lane];
    slopes[lane] = along.head<2>() / along.z();
    if (along.z() >= least_forward) continue;
    slopes[lane].setConstant(std::numeric_limits<double>::quiet_NaN());
    if (along.allFinite())
      strays.push_back({in_camera[lane], s.x + square::column(lane), s.y + square::row(lane)});
  }
  s.fan = search::ray_fan::of(slopes);
  return strays;
}

inline view_rays::view_rays(const math::camera& camera,
                            std::size_t width,
                            std::size_t height,
                            unsigned threads)
    : width_(detail::map_side(width, camera.width, "width")),
      height_(detail::map_side(height, camera.height, "height")) {
  const std::size_t columns = (width_ + side - 1) / side, rows = (height_ + side - 1) / side;
  squares_.resize(columns * rows);
  strays_ = reduce_chunks(
      squares_.size(), 256, threads, {}, std::vector<stray>(),
      [&](const chunk& c) {
        std::vector<stray> found;
        for (std::size_t i = c.begin; i < c.end; ++i) {
          square& s = squares_[i];
          s.x = side * (i % columns);
          s.y = side * (i / columns);
          const auto strays = fill(s, directions_of(camera, s));
          found.insert(found.end(), strays.begin(), strays.end());
        }
        return found;
      },
      [](std::vector<stray> all, const std::vector<stray>& more) {
        all.insert(all.end(), more.begin(), more.end());
        return all;
      });
}

}  // namespace aib::render
