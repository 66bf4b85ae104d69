// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/pose/associate.hpp>
#include <aib/pose/trajectory.hpp>

#include <cstddef>
#include <span>
#include <string>
#include <unordered_set>
#include <vector>

namespace aib::pose {

struct registration {
  double rate;                       ///< n_registered / n_total
  std::size_t n_registered;          ///< reference frames with a finite pose in the estimate
  std::size_t n_total;               ///< frames of the reference
  std::vector<std::string> missing;  ///< names of the others, in the reference's order
};

/// Share of the reference's frames that have a pose in an estimate, or in any of several
/// sub-models. Frames of the estimate that the reference does not name do not count.
///
/// rules   how names are compared, see associate_options
///
/// Throws argument_error if poses have no names, undefined_error if the reference is empty.
inline registration registration_rate(std::span<const trajectory> estimates,
                                      const trajectory& reference,
                                      const associate_options& rules = {}) {
  if (reference.empty()) throw undefined_error("registration_rate: the reference has no frame");
  std::unordered_set<std::string> posed;
  for (const trajectory& estimate : estimates) {
    if (estimate.names.size() != estimate.size() || reference.names.empty())
      throw argument_error("registration_rate: poses with names expected");
    for (std::size_t i = 0; i < estimate.size(); ++i) {
      if (estimate.world_from_camera[i].is_finite())
        posed.insert(detail::name_key(estimate.names[i], rules));
    }
  }
  registration out{0, 0, reference.size(), {}};
  for (const std::string& name : reference.names) {
    if (posed.contains(detail::name_key(name, rules)))
      ++out.n_registered;
    else
      out.missing.push_back(name);
  }
  out.rate = static_cast<double>(out.n_registered) / static_cast<double>(out.n_total);
  return out;
}

inline registration registration_rate(const trajectory& estimate,
                                      const trajectory& reference,
                                      const associate_options& rules = {}) {
  return registration_rate(std::span(&estimate, 1), reference, rules);
}

/// Index of the sub-model that is scored: most frames, then most points, then the lowest index.
/// Never by score. Throws undefined_error if there is none.
///
/// n_points   one a model, or empty
inline std::size_t largest_model(std::span<const trajectory> models,
                                 std::span<const std::size_t> n_points = {}) {
  if (models.empty()) throw undefined_error("largest_model: no model");
  std::size_t best = 0;
  for (std::size_t i = 1; i < models.size(); ++i) {
    const bool more_points = !n_points.empty() && n_points[i] > n_points[best];
    if (models[i].size() > models[best].size() ||
        (models[i].size() == models[best].size() && more_points))
      best = i;
  }
  return best;
}

}  // namespace aib::pose
