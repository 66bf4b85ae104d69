// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/math/rigid3.hpp>

#include <algorithm>
#include <cmath>

namespace aib::support {

/// The largest difference of two numbers of the matrices; infinite where one is not finite.
inline double distance(const math::rigid3& a, const math::rigid3& b) {
  if (!a.is_finite() || !b.is_finite()) return HUGE_VAL;
  double largest = 0;
  for (Eigen::Index r = 0; r < 3; ++r) {
    largest = std::max(largest, std::abs(a.translation[r] - b.translation[r]));
    for (Eigen::Index c = 0; c < 3; ++c)
      largest = std::max(largest, std::abs(a.rotation(r, c) - b.rotation(r, c)));
  }
  return largest;
}

}  // namespace aib::support
