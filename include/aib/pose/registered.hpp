// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/math/rigid3.hpp>
#include <aib/pose/trajectory.hpp>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace aib::pose {

/// Throws argument_error unless two trajectories have as many poses and, where both have names, the
/// same names in the same order.
inline void check_associated(std::string_view who,
                             const trajectory& estimate,
                             const trajectory& reference) {
  check(estimate);
  check(reference);
  if (estimate.size() != reference.size()) {
    throw argument_error(message(who, ": ", estimate.size(), " estimated and ", reference.size(),
                                 " reference poses; associate them first"));
  }
  if (estimate.names.empty() || reference.names.empty()) return;
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    if (estimate.names[i] == reference.names[i]) continue;
    throw argument_error(message(who, ": pose ", i, " is \"", estimate.names[i],
                                 "\" in the estimate and \"", reference.names[i],
                                 "\" in the reference; associate them first"));
  }
}

/// The frames that have a finite pose in both of two associated trajectories.
struct registered_frames {
  std::vector<math::rigid3> estimate;   ///< world_from_camera
  std::vector<math::rigid3> reference;  ///< world_from_camera
  std::vector<std::size_t> index;       ///< of each in the trajectories, ascending
};

/// Throws argument_error as check_associated does.
[[nodiscard]] inline registered_frames registered(std::string_view who,
                                                  const trajectory& estimate,
                                                  const trajectory& reference) {
  check_associated(who, estimate, reference);
  registered_frames out;
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    const math::rigid3& e = estimate.world_from_camera[i];
    const math::rigid3& r = reference.world_from_camera[i];
    if (!e.is_finite() || !r.is_finite()) continue;
    out.estimate.push_back(e);
    out.reference.push_back(r);
    out.index.push_back(i);
  }
  return out;
}

/// The name of a frame of two associated trajectories: one of theirs, else its number.
[[nodiscard]] inline std::string frame_name(const trajectory& estimate,
                                            const trajectory& reference,
                                            std::size_t i) {
  if (!reference.names.empty()) return reference.names[i];
  if (!estimate.names.empty()) return estimate.names[i];
  return message(i);
}

}  // namespace aib::pose
