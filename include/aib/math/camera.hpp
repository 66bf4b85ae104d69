// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace aib::math {

/// Camera models with COLMAP's numbers, up to COLMAP 4.2.
enum class camera_model : std::int32_t {
  simple_pinhole = 0,
  pinhole = 1,
  simple_radial = 2,
  radial = 3,
  opencv = 4,
  opencv_fisheye = 5,
  full_opencv = 6,
  fov = 7,
  simple_radial_fisheye = 8,
  radial_fisheye = 9,
  thin_prism_fisheye = 10,
  rad_tan_thin_prism_fisheye = 11,
  simple_division = 12,
  division = 13,
  simple_fisheye = 14,
  fisheye = 15,
  eucm = 16,
  equirectangular = 17,
};

/// What COLMAP calls a model and how its parameters begin.
struct camera_model_info {
  std::string_view name;  ///< as in cameras.txt
  std::size_t n_parameters;
  std::size_t n_focal;  ///< 1: f, cx, cy, ...   2: fx, fy, cx, cy, ...   0: no focal length
};

inline constexpr std::array<camera_model_info, 18> camera_models{{
    {"SIMPLE_PINHOLE", 3, 1},
    {"PINHOLE", 4, 2},
    {"SIMPLE_RADIAL", 4, 1},
    {"RADIAL", 5, 1},
    {"OPENCV", 8, 2},
    {"OPENCV_FISHEYE", 8, 2},
    {"FULL_OPENCV", 12, 2},
    {"FOV", 5, 2},
    {"SIMPLE_RADIAL_FISHEYE", 4, 1},
    {"RADIAL_FISHEYE", 5, 1},
    {"THIN_PRISM_FISHEYE", 12, 2},
    {"RAD_TAN_THIN_PRISM_FISHEYE", 16, 2},
    {"SIMPLE_DIVISION", 4, 1},
    {"DIVISION", 5, 2},
    {"SIMPLE_FISHEYE", 3, 1},
    {"FISHEYE", 4, 2},
    {"EUCM", 6, 2},
    {"EQUIRECTANGULAR", 2, 0},
}};

[[nodiscard]] constexpr const camera_model_info& info(camera_model model) {
  return camera_models[static_cast<std::size_t>(model)];
}

/// The model of COLMAP's number or name; nothing where COLMAP (up to 4.2) has none such.
[[nodiscard]] constexpr std::optional<camera_model> find_camera_model(std::int64_t id) {
  if (id < 0 || id >= static_cast<std::int64_t>(camera_models.size())) return std::nullopt;
  return static_cast<camera_model>(id);
}
[[nodiscard]] constexpr std::optional<camera_model> find_camera_model(std::string_view name) {
  for (std::size_t i = 0; i < camera_models.size(); ++i) {
    if (camera_models[i].name == name) return static_cast<camera_model>(i);
  }
  return std::nullopt;
}

/// Intrinsics of a camera. Pixel (0.5, 0.5) is the centre of the top left pixel.
struct camera {
  camera_model model = camera_model::pinhole;
  std::uint64_t width = 0;         ///< pixels
  std::uint64_t height = 0;        ///< pixels
  std::vector<double> parameters;  ///< in COLMAP's order, pixels where they are lengths

  [[nodiscard]] bool has_focal() const { return info(model).n_focal > 0; }

  /// Focal lengths and principal point in pixels. Throw argument_error where the model has none.
  [[nodiscard]] double fx() const;
  [[nodiscard]] double fy() const;
  [[nodiscard]] double cx() const;
  [[nodiscard]] double cy() const;
};

namespace detail {

inline double pinhole_parameter(const camera& c, std::size_t index) {
  if (!c.has_focal())
    throw argument_error(message("camera: ", info(c.model).name, " has no focal length"));
  if (index >= c.parameters.size()) {
    throw argument_error(message("camera: ", info(c.model).name, " expects ",
                                 info(c.model).n_parameters, " parameters, found ",
                                 c.parameters.size()));
  }
  return c.parameters[index];
}

}  // namespace detail

inline double camera::fx() const { return detail::pinhole_parameter(*this, 0); }
inline double camera::fy() const {
  return detail::pinhole_parameter(*this, info(model).n_focal - 1);
}
inline double camera::cx() const { return detail::pinhole_parameter(*this, info(model).n_focal); }
inline double camera::cy() const {
  return detail::pinhole_parameter(*this, info(model).n_focal + 1);
}

/// A camera without distortion.
[[nodiscard]] inline camera pinhole(
    std::uint64_t width, std::uint64_t height, double fx, double fy, double cx, double cy) {
  return {camera_model::pinhole, width, height, {fx, fy, cx, cy}};
}

}  // namespace aib::math
