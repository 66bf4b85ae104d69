// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/box.hpp>
#include <aib/stats/quantiles.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace aib::cloud {

/// What points near a position are counted from: 0 where floats hold it well (|coordinate| < 1024),
/// else the position in whole units.
[[nodiscard]] inline Eigen::Vector3d natural_origin(const Eigen::Vector3d& centre) {
  if (centre.cwiseAbs().maxCoeff() < 1024) return Eigen::Vector3d::Zero();
  return centre.array().round();
}

/// Finds what the points of a cloud are counted from: 0 where all coordinates are below 1024, else
/// the middle of their box in whole units.
///
/// A box longer than 4096 may be due to a few strays, and floats counted from its middle would not
/// hold the others: there it is the natural origin of the medians of the coordinates, of about a
/// thousand points taken evenly.
class origin_finder {
 public:
  /// n   how many positions will be added
  explicit origin_finder(std::size_t n) : step_(n / 1024 + 1) {}

  /// The next position. One that is not finite has no part in the origin.
  void add(const Eigen::Vector3d& p) {
    const bool sampled = until_sample_ == 0;
    until_sample_ = sampled ? step_ - 1 : until_sample_ - 1;
    if (!p.allFinite()) return;
    all_.add(p);
    if (sampled || sample_.empty()) sample_.push_back(p);
  }

  [[nodiscard]] Eigen::Vector3d result() const {
    if (all_.empty()) return Eigen::Vector3d::Zero();
    if (all_.size().maxCoeff() > 4096) return natural_origin(median());
    const bool near = all_.low.minCoeff() > -1024 && all_.high.maxCoeff() < 1024;
    return near ? Eigen::Vector3d(0, 0, 0) : Eigen::Vector3d(all_.centre().array().round());
  }

 private:
  [[nodiscard]] Eigen::Vector3d median() const {
    std::vector<double> coordinates(sample_.size());
    Eigen::Vector3d middle;
    for (Eigen::Index k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < sample_.size(); ++i) coordinates[i] = sample_[i][k];
      middle[k] = stats::quantile_in_place<double>(coordinates, 0.5, stats::quantile_rule::lower);
    }
    return middle;
  }

  std::size_t step_;
  std::size_t until_sample_ = 0;
  box all_;
  std::vector<Eigen::Vector3d> sample_;
};

}  // namespace aib::cloud
