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
  const std::size_t n_wanted = std::min(options.n, pairs.frames() * pairs.frames());
  struct found {
    double error;
    std::size_t i, j;
    bool operator<(const found& o) const {
      if (error != o.error) return error > o.error;
      return i != o.i ? i < o.i : j < o.j;
    }
  };
  const auto keep_worst = [&](std::vector<found>& list) {
    const std::size_t n = std::min(n_wanted, list.size());
    std::partial_sort(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(n), list.end());
    list.resize(n);
  };
  const auto worst = reduce_chunks<std::vector<found>>(
      pairs.frames(), 64, options.threads, options.control, std::vector<found>(),
      [&](const chunk& c) {
        std::vector<found> list;
        double least = -1;  // of the worst so far, once there are enough
        for (std::size_t i = c.begin; i < c.end; ++i) {
          const auto add = [&](std::size_t j, double rotation, double translation) {
            const double error = translation > rotation ? translation : rotation;  // NaN: rotation
            if (!(error > least)) return;
            list.push_back({error, i, j});
            if (list.size() < 2 * n_wanted + 100) return;
            keep_worst(list);
            least = list.empty() ? least : list.back().error;
          };
          pairs.for_each_error(i, {i + 1, pairs.frames()}, add);
        }
        keep_worst(list);
        return list;
      },
      [&](std::vector<found> a, const std::vector<found>& b) {
        a.insert(a.end(), b.begin(), b.end());
        keep_worst(a);
        return a;
      });
  std::vector<worst_pair> out;
  for (const found& f : worst) {
    const pair_error e = pairs.error(f.i, f.j);
    out.push_back({frame_name(estimate, reference, frames.index[f.i]),
                   frame_name(estimate, reference, frames.index[f.j]), e.rotation_deg,
                   e.translation_deg});
  }
  return out;
}

}  // namespace aib::pose
