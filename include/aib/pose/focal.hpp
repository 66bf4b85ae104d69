// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/math/camera.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace aib::pose {

/// The camera that a view was estimated with and the one that took it.
struct camera_pair {
  math::camera estimate;
  math::camera reference;
};

/// What a mean is taken over.
enum class focal_over {
  views,    ///< each registered image counts
  cameras,  ///< each different pair of cameras counts once
};

struct focal_error_result {
  double mre;                ///< mean relative error, a share
  std::size_t n;             ///< views or cameras averaged
  std::vector<double> each;  ///< relative error of each
};

[[nodiscard]] inline bool same_camera(const math::camera& a, const math::camera& b) {
  return a.model == b.model && a.width == b.width && a.height == b.height &&
         a.parameters == b.parameters;
}

/// Focal length of a camera as it would be for an image of another size: fx goes with the width, fy
/// with the height; their mean. Pixels. Throws argument_error where a model has no focal length.
inline double focal_at_size(const math::camera& c, std::uint64_t width, std::uint64_t height) {
  const auto ratio = [](std::uint64_t to, std::uint64_t from) {
    return to == 0 || from == 0 ? 1 : static_cast<double>(to) / static_cast<double>(from);
  };
  return (c.fx() * ratio(width, c.width) + c.fy() * ratio(height, c.height)) / 2;
}

/// Mean of |f - f_ref| / f_ref over views. The estimate's focal lengths are rescaled to the
/// reference's image size (sizes of 0 are unknown: taken for equal), fx and fy averaged.
///
/// Throws undefined_error if there is no view, argument_error where a model has no focal length,
/// one is not finite or that of a reference not positive.
inline focal_error_result focal_error(std::span<const camera_pair> views,
                                      focal_over over = focal_over::views) {
  focal_error_result out{0, 0, {}};
  std::vector<const camera_pair*> counted;
  for (const camera_pair& view : views) {
    const auto is_view = [&](const camera_pair* c) {
      return same_camera(c->estimate, view.estimate) && same_camera(c->reference, view.reference);
    };
    if (over == focal_over::cameras) {
      if (std::any_of(counted.begin(), counted.end(), is_view)) continue;
      counted.push_back(&view);
    }
    const math::camera& ref = view.reference;
    const double f_ref = (ref.fx() + ref.fy()) / 2;
    const double f = focal_at_size(view.estimate, ref.width, ref.height);
    if (!std::isfinite(f) || !(f_ref > 0 && std::isfinite(f_ref))) {
      throw argument_error(message("focal_error: finite focal lengths, of a reference > 0, ",
                                   "expected, found ", f, " against ", f_ref));
    }
    out.each.push_back(std::abs(f - f_ref) / f_ref);
    out.mre += out.each.back();
  }
  out.n = out.each.size();
  if (out.n == 0) throw undefined_error("focal_error: no view");
  out.mre /= static_cast<double>(out.n);
  return out;
}

}  // namespace aib::pose
