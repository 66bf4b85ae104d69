// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/math/rigid3.hpp>
#include <aib/survey/flight_path.hpp>
#include <aib/survey/lens.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace aib::survey::detail {

/// A path measured in frames: how many frame widths, or heights, the image of a wall moves.
class frame_scale {
 public:
  explicit frame_scale(const flight_path& path) : path_(path) {
    const wall_frame frame = frame_on_wall(path.camera, path.stand_off);
    double sum = 0;
    for (std::size_t l = 0; l < path.legs.size(); ++l) {
      for (std::size_t i = 0; i < n_parts; ++i) {
        parts_.push_back({l, static_cast<double>(i) / n_parts, sum});
        sum += moved(path.legs[l], i, frame);
      }
    }
    total_ = sum;
  }

  [[nodiscard]] double total() const { return total_; }

  /// The pose where the image has moved as far.
  [[nodiscard]] math::rigid3 at(double frames) const {
    const auto behind = std::upper_bound(parts_.begin() + 1, parts_.end(), frames,
                                         [](double f, const part& p) { return f < p.begin; });
    const part& p = *(behind - 1);
    const double end = behind == parts_.end() ? total_ : behind->begin;
    const double share = end > p.begin ? (frames - p.begin) / (end - p.begin) : 0;
    return path_.legs[p.leg].at(p.share + std::clamp(share, 0.0, 1.0) / n_parts);
  }

 private:
  static constexpr std::size_t n_parts = 16;
  struct part {
    std::size_t leg;
    double share;
    double begin;
  };

  double moved(const leg& l, std::size_t i, const wall_frame& frame) const {
    const auto share = [](double k) { return k / n_parts; };
    const auto k = static_cast<double>(i);
    const Eigen::Matrix3d camera_from_world = l.at(share(k + 0.5)).rotation.transpose();
    const Eigen::Vector3d way = l.at(share(k + 1)).translation - l.at(share(k)).translation;
    const double straight = way.norm();
    // A chord is shorter than its arc.
    const double arc = straight > 0 ? l.length() / n_parts / straight : 0;
    const Eigen::Vector3d by = arc * (camera_from_world * way);
    // What a turn moves out of an image leaves at its edge, where it moves fastest.
    const double far = path_.stand_off;
    const double at_side = far + std::pow(frame.width / 2, 2) / far;
    const double at_top = far + std::pow(frame.height / 2, 2) / far;
    const Eigen::Vector3d turn = camera_from_world * l.turn / n_parts;
    // A turn into the way moves the image more. One against it, as round a corner, less; but then
    // another side comes into sight: the way counts.
    const double right = std::abs(by.x()) + std::abs(by.z()), down = std::abs(by.y());
    return std::max(right, std::abs(by.x() + at_side * turn.y())) / frame.width +
           std::max(down, std::abs(by.y() - at_top * turn.x())) / frame.height;
  }

  const flight_path& path_;
  std::vector<part> parts_;
  double total_ = 0;
};

}  // namespace aib::survey::detail
