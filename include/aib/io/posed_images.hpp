// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/message.hpp>
#include <aib/math/camera.hpp>
#include <aib/pose/trajectory.hpp>

#include <cstdint>
#include <vector>

namespace aib::io {

/// Size of images in pixels, for files that do not say it; 0: not known.
struct image_extent {
  std::uint64_t width = 0;
  std::uint64_t height = 0;
};

/// Poses with the intrinsics of each, from a file that has both.
struct posed_images {
  pose::trajectory trajectory = {};
  std::vector<math::camera> cameras = {};  ///< one a pose, or none where the file has none
};

/// Where the intrinsics of some images only are known there are none; a warning says so.
inline void drop_some_cameras(posed_images& images) {
  if (images.cameras.size() == images.trajectory.size()) return;
  images.trajectory.warnings.push_back(message("intrinsics are known for ", images.cameras.size(),
                                               " of ", images.trajectory.size(),
                                               " images: none are given"));
  images.cameras.clear();
}

}  // namespace aib::io
