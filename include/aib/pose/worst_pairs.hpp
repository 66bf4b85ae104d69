// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/core/executor.hpp>
#include <aib/pose/frame_pairs.hpp>
#include <aib/pose/registered.hpp>
#include <aib/pose/trajectory.hpp>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace aib::pose {

struct worst_pairs_options {
  std::size_t n = 10;    ///< how many
  unsigned threads = 0;  ///< 0: all
  struct control control = {};
};

struct worst_pair {
  std::string first, second;  ///< names, or numbers where there are none
  double rotation_deg;
  std::optional<double> translation_deg;  ///< signed direction; nothing where there is none
};

/// The pairs of frames with the largest error, rotation or direction, in descending order.
/// Throws argument_error if the trajectories are not associated.
inline std::vector<worst_pair> worst_pairs(const trajectory& estimate,
                                           const trajectory& reference,
                                           const worst_pairs_options& options = {}) {
  const registered_frames frames = registered("worst_pairs", estimate, reference);
  const frame_pairs pairs(frames.estimate, frames.reference);
  struct found {
    double error;
    std::size_t i, j;
    pair_error angles;
    bool operator<(const found& o) const {
      if (error != o.error) return error > o.error;
      return i != o.i ? i < o.i : j < o.j;
    }
  };
  const auto keep_worst = [&](std::vector<found>& list) {
    const std::size_t n = std::min(options.n, list.size());
    std::partial_sort(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(n), list.end());
    list.resize(n);
  };
  const auto worst = reduce_chunks<std::vector<found>>(
      pairs.frames(), 64, options.threads, options.control, std::vector<found>(),
      [&](const chunk& c) {
        std::vector<found> list;
        for (std::size_t i = c.begin; i < c.end; ++i) {
          for (std::size_t j = i + 1; j < pairs.frames(); ++j) {
            const pair_error e = pairs.error(i, j);
            list.push_back({std::max(e.rotation_deg, e.translation_deg.value_or(0)), i, j, e});
            if (list.size() >= 2 * options.n + 1000) keep_worst(list);
          }
          keep_worst(list);
        }
        return list;
      },
      [&](std::vector<found> a, std::vector<found> b) {
        a.insert(a.end(), b.begin(), b.end());
        keep_worst(a);
        return a;
      });
  std::vector<worst_pair> out;
  for (const found& f : worst) {
    out.push_back({frame_name(estimate, reference, frames.index[f.i]),
                   frame_name(estimate, reference, frames.index[f.j]), f.angles.rotation_deg,
                   f.angles.translation_deg});
  }
  return out;
}

}  // namespace aib::pose
