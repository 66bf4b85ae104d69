// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/cloud.hpp>
#include <aib/cloud/origin.hpp>
#include <aib/core/error.hpp>
#include <aib/core/executor.hpp>
#include <aib/depth/depth_map.hpp>
#include <aib/math/camera.hpp>
#include <aib/math/projection.hpp>
#include <aib/math/rigid3.hpp>
#include <aib/raster/color.hpp>
#include <aib/raster/view.hpp>
#include <aib/stats/quantiles.hpp>

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

namespace aib::sample {

/// What the numbers of a confidence map are, and thus what `min_confidence` is compared with.
enum class confidence_rule {
  raw,         ///< the number itself is above it (DA3, VGGT: never below 1)
  sigmoid,     ///< 1 / (1 + exp(-number)) is above it (pi3 stores logits)
  percentile,  ///< a share: that part of the valid pixels, the least confident, is left out
};

/// What a depth is.
enum class depth_meaning {
  planar,  ///< distance along the optical axis
  range,   ///< distance from the camera centre
};

struct unproject_options {
  raster::view<const float> confidence = {};  ///< none, or of the size of the map
  std::optional<double> min_confidence = {};  ///< a pixel is kept strictly above it
  confidence_rule rule = confidence_rule::raw;
  std::size_t stride = 1;     ///< every stride-th column and row
  double pixel_offset = 0.5;  ///< of a pixel's centre from its index: 0.5 as COLMAP, or 0
  depth_meaning meaning = depth_meaning::planar;
  raster::view<const raster::rgb> colors = {};  ///< none, or of the size of the map
  unsigned threads = 0;                         ///< 0: all
  aib::control control = {};
};

/// Points of a depth map, and what became of its pixels.
struct unprojected {
  cloud::cloud points;   ///< row by row
  std::size_t n_valid;   ///< pixels of the grid with a depth
  std::size_t n_unsure;  ///< of those, left out for their confidence
  std::size_t n_unseen;  ///< left out because the camera sees nothing there
};

/// The points that a depth map shows, in world frame.
///
/// depth              in the unit of the pose
/// camera             any model; where its size differs from the map's, pixels are scaled to it
/// world_from_camera  a depth map and a pose of a method's own scale give points of that scale:
///                    align the points afterwards
///
/// The order of the points does not depend on the number of threads. Throws argument_error if the
/// sizes differ, stride is 0, the pose is not finite or only one of confidence and min_confidence
/// is given.
[[nodiscard]] unprojected unproject(const depth::depth_map& map,
                                    const math::camera& camera,
                                    const math::rigid3& world_from_camera,
                                    const unproject_options& options = {});

namespace detail {

inline void check(const depth::depth_map& map,
                  const math::rigid3& pose,
                  const unproject_options& options) {
  const auto require = [&](bool holds, const auto&... what) {
    if (!holds) throw argument_error(message("sample::unproject: ", what...));
  };
  const auto same_size = [&](std::string_view thing, const auto& view) {
    require(!view.data || (view.width == map.values.width() && view.height == map.values.height()),
            "the depth map is ", map.values.width(), "x", map.values.height(), ", the ", thing, " ",
            view.width, "x", view.height);
  };
  same_size("confidence map", options.confidence);
  same_size("picture", options.colors);
  require(options.stride > 0, "stride >= 1 expected, found 0");
  require(pose.is_finite(), "the pose is not finite");
  require(options.min_confidence.has_value() == (options.confidence.data != nullptr),
          "a confidence map and min_confidence go together, found one of them");
}

/// The confidence as stored that a pixel must exceed. Of a percentile: the quantile of the
/// confidences of valid pixels.
inline double confidence_threshold(const depth::depth_map& map, const unproject_options& options) {
  const double least = *options.min_confidence;
  if (options.rule == confidence_rule::raw) return least;
  if (!(least >= 0 && least <= 1)) {
    throw argument_error(
        message("sample::unproject: min_confidence in [0, 1] expected, found ", least));
  }
  if (options.rule == confidence_rule::sigmoid) return std::log(least / (1 - least));
  std::vector<float> of_valid;
  for (std::size_t y = 0; y < map.values.height(); y += options.stride) {
    for (std::size_t x = 0; x < map.values.width(); x += options.stride) {
      if (depth::is_valid(map.values(x, y))) of_valid.push_back(options.confidence(x, y));
    }
  }
  if (of_valid.empty() || least == 0) return -HUGE_VAL;
  return stats::quantile_in_place<float>(of_valid, least, stats::quantile_rule::lower);
}

/// Unprojects rows of one map.
class unprojector {
 public:
  unprojector(const depth::depth_map& map,
              const math::camera& camera,
              const math::rigid3& world_from_camera,
              const unproject_options& options)
      : map_(map.values), camera_(camera), pose_(world_from_camera), options_(options) {
    if (options.confidence.data) threshold_ = confidence_threshold(map, options);
    if (camera.width > 0 && camera.height > 0) {
      scale_x_ = static_cast<double>(camera.width) / static_cast<double>(map_.width);
      scale_y_ = static_cast<double>(camera.height) / static_cast<double>(map_.height);
    }
  }

  /// Adds the points of a row to `to`, which are counted from `to.points.origin`.
  void add_row(std::size_t y, unprojected& to) const {
    for (std::size_t x = 0; x < map_.width; x += options_.stride) {
      const float depth = map_(x, y);
      if (!depth::is_valid(depth)) continue;
      ++to.n_valid;
      if (threshold_ && !(options_.confidence(x, y) > *threshold_)) {
        ++to.n_unsure;
      } else if (const auto p_in_camera = point(x, y, depth)) {
        const Eigen::Vector3d p = pose_ * *p_in_camera - to.points.origin;
        to.points.points.push_back(p.cast<float>());
        if (options_.colors.data) to.points.colors.push_back(options_.colors(x, y));
      } else {
        ++to.n_unseen;
      }
    }
  }

 private:
  [[nodiscard]] std::optional<Eigen::Vector3d> point(std::size_t x,
                                                     std::size_t y,
                                                     double depth) const {
    const Eigen::Vector2d pixel((static_cast<double>(x) + options_.pixel_offset) * scale_x_,
                                (static_cast<double>(y) + options_.pixel_offset) * scale_y_);
    const auto direction = math::unproject(camera_, pixel);
    if (!direction) return std::nullopt;
    if (options_.meaning == depth_meaning::range) return *direction * depth;
    if (!(direction->z() > 0)) return std::nullopt;
    return *direction * (depth / direction->z());
  }

  raster::view<const float> map_;
  const math::camera& camera_;
  const math::rigid3& pose_;
  const unproject_options& options_;
  std::optional<double> threshold_ = {};
  double scale_x_ = 1;
  double scale_y_ = 1;
};

inline unprojected append(unprojected a, const unprojected& b) {
  const auto extend = [](auto& to, const auto& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  extend(a.points.points, b.points.points);
  extend(a.points.colors, b.points.colors);
  a.n_valid += b.n_valid;
  a.n_unsure += b.n_unsure;
  a.n_unseen += b.n_unseen;
  return a;
}

}  // namespace detail

inline unprojected unproject(const depth::depth_map& map,
                             const math::camera& camera,
                             const math::rigid3& world_from_camera,
                             const unproject_options& options) {
  detail::check(map, world_from_camera, options);
  const Eigen::Vector3d& centre = world_from_camera.translation;
  unprojected nothing{};
  nothing.points.origin = cloud::natural_origin(centre);
  if (map.values.empty()) return nothing;
  const detail::unprojector rows(map, camera, world_from_camera, options);
  const std::size_t n_rows = (map.values.height() + options.stride - 1) / options.stride;
  const auto points_of = [&](const chunk& c) {
    unprojected part = nothing;
    for (std::size_t i = c.begin; i < c.end; ++i) rows.add_row(i * options.stride, part);
    return part;
  };
  return reduce_chunks(n_rows, 32, options.threads, options.control, nothing, points_of,
                       detail::append);
}

}  // namespace aib::sample
