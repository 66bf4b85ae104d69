// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/math/camera.hpp>
#include <aib/math/projection.hpp>
#include <aib/math/rigid3.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>

namespace aib::math {

/// A camera where it stands.
struct view {
  math::camera camera;
  rigid3 world_from_camera;
};

/// Whether a point lies in the image of a view, whatever may be before it. A pose that is not
/// finite sees nothing.
[[nodiscard]] inline bool is_in_image(const view& v, const Eigen::Vector3d& point) {
  const Eigen::Vector3d offset = point - v.world_from_camera.translation;
  const auto pixel = project(v.camera, v.world_from_camera.rotation.transpose() * offset);
  return pixel && pixel->x() >= 0 && pixel->y() >= 0 &&
         pixel->x() <= static_cast<double>(v.camera.width) &&
         pixel->y() <= static_cast<double>(v.camera.height);
}

/// A cone around the image of a view: what lies outside of it need not be projected.
class view_cone {
 public:
  explicit view_cone(const view& v)
      : centre_(v.world_from_camera.translation), axis_(v.world_from_camera.rotation.col(2)) {
    for (const double x : {0.0, 0.5, 1.0}) {
      for (const double y : {0.0, 0.5, 1.0}) {
        const auto ray = unproject(v.camera, {x * static_cast<double>(v.camera.width),
                                              y * static_cast<double>(v.camera.height)});
        cosine_ = std::min(cosine_, ray ? ray->z() - 0.02 : -1);
      }
    }
  }

  [[nodiscard]] bool may_contain(const Eigen::Vector3d& point) const {
    const Eigen::Vector3d offset = point - centre_;
    return axis_.dot(offset) >= cosine_ * offset.norm();
  }

 private:
  Eigen::Vector3d centre_, axis_;
  double cosine_ = 1;
};

}  // namespace aib::math
