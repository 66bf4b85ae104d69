// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/cloud.hpp>
#include <aib/cloud/compare.hpp>
#include <aib/cloud/distances.hpp>
#include <aib/cloud/free_space.hpp>
#include <aib/cloud/join.hpp>
#include <aib/cloud/select.hpp>
#include <aib/cloud/voxel_shares.hpp>
#include <aib/core/error.hpp>
#include <aib/core/executor.hpp>
#include <aib/core/isa.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

namespace aib::cloud {

/// Whether a scan point at exactly a tolerance from the reconstruction is complete.
enum class eth3d_rule {
  /// As the tool of 2017: yes, but not at the largest tolerance; and voxels calculated in float
  /// where the clouds lie at the world's origin.
  official,
  within,  ///< yes
  below,   ///< no
};

struct eth3d_options {
  std::vector<double> tolerances = {};  ///< in the unit of the clouds
  double voxel = 0.01;                  ///< edge of the voxels over which shares are averaged
  laser_beam beam = {};
  eth3d_rule rule = eth3d_rule::official;
  unsigned threads = 0;  ///< 0: all
  aib::control control = {};
};

/// Scores at one tolerance.
struct eth3d_scores {
  double tolerance;
  double completeness;             ///< share of the scanned surface that was reconstructed
  std::optional<double> accuracy;  ///< share of the reconstruction; none where nothing was observed
  std::optional<double> f_score;   ///< harmonic mean of both; 0 where both are 0
};

struct eth3d_result {
  std::vector<eth3d_scores> scores;       ///< by ascending tolerance
  std::vector<std::size_t> n_unobserved;  ///< points of the reconstruction that nothing is known of
  std::size_t n_reconstruction;           ///< finite points
  std::size_t n_scanned;
};

namespace detail {

inline cloud only_finite(const cloud& c) {
  return select_where(c, [&](std::size_t i) { return is_finite(c.points[i]); });
}

inline cell_rule cells_of(eth3d_rule rule, const cloud& a, const cloud& b) {
  const bool single = rule == eth3d_rule::official && a.origin.isZero(0) && b.origin.isZero(0);
  return single ? cell_rule::single : cell_rule::exact;
}

/// Whether each scan point is complete, from which tolerance on.
inline std::vector<verdict> completeness_verdicts(std::span<const float> distance,
                                                  std::span<const double> tolerances,
                                                  eth3d_rule rule) {
  std::vector<verdict> verdicts;
  for (const float d : distance) {
    const auto first = rule == eth3d_rule::below
                           ? std::upper_bound(tolerances.begin(), tolerances.end(), d)
                           : std::lower_bound(tolerances.begin(), tolerances.end(), d);
    const bool at_largest = rule == eth3d_rule::official && !(d < tolerances.back());
    verdicts.push_back(
        {static_cast<std::uint32_t>(
             at_largest ? tolerances.size() : static_cast<std::size_t>(first - tolerances.begin())),
         true});
  }
  return verdicts;
}

/// Good where any scan says so, else bad where any says so.
inline verdict combined(const verdict& a, const verdict& b) {
  return {std::min(a.first_good, b.first_good), a.observed || b.observed};
}

inline std::vector<verdict> accuracy_verdicts(const cloud& reconstruction,
                                              std::span<const laser_scan> scans,
                                              const eth3d_options& options) {
  std::deque<scanned_space> spaces;
  for (const laser_scan& scan : scans) spaces.emplace_back(scan, options.beam);
  const auto none = static_cast<std::uint32_t>(options.tolerances.size());
  std::vector<verdict> verdicts(reconstruction.size(), {none, false});
  for_each_chunk(
      reconstruction.size(), 1024, options.threads, options.control, [&](const chunk& c) {
        for (std::size_t i = c.begin; i < c.end; ++i) {
          for (const scanned_space& space : spaces) {
            if (verdicts[i].first_good == 0) break;
            verdicts[i] =
                combined(verdicts[i], space.of(reconstruction.position(i), options.tolerances));
          }
        }
      });
  return verdicts;
}

inline std::size_t count_unobserved(std::span<const verdict> verdicts, std::size_t threshold) {
  return static_cast<std::size_t>(
      std::count_if(verdicts.begin(), verdicts.end(),
                    [&](const verdict& v) { return !v.observed && v.first_good > threshold; }));
}

}  // namespace detail

inline namespace AIB_ISA {

/// The scores of the ETH3D benchmark: shares averaged over voxels and not over points, and only
/// what the beams of the scanner observed counts against a reconstruction.
///
/// Accuracy takes a distance of exactly a tolerance as within it.
/// Throws argument_error without positive tolerances, undefined_error where the reconstruction or a
/// scan has no finite point.
/// Source: Schöps et al., CVPR 2017, section 5; github.com/ETH3D/multi-view-evaluation.
[[nodiscard]] inline eth3d_result eth3d(const cloud& reconstruction,
                                        std::span<const laser_scan> scans,
                                        eth3d_options options) {
  auto& tolerances = options.tolerances;
  std::sort(tolerances.begin(), tolerances.end());
  if (tolerances.empty() || !(tolerances.front() > 0)) {
    throw argument_error("cloud::eth3d: positive tolerances expected");
  }
  std::vector<const cloud*> parts;
  for (const laser_scan& scan : scans) parts.push_back(&scan.points);
  const cloud estimate = detail::only_finite(reconstruction);
  const cloud scanned = detail::only_finite(joined(parts));
  const distances missing(scanned, estimate,
                          {.threads = options.threads, .control = options.control});
  const auto complete = detail::completeness_verdicts(missing.values(), tolerances, options.rule);
  const auto accurate = detail::accuracy_verdicts(estimate, scans, options);
  const std::size_t n = tolerances.size();
  const auto cells = detail::cells_of(options.rule, estimate, scanned);
  const auto completeness = voxel_shares(scanned, complete, n, options.voxel, cells);
  const auto accuracy = voxel_shares(estimate, accurate, n, options.voxel, cells);
  eth3d_result result{{}, {}, estimate.size(), scanned.size()};
  for (std::size_t t = 0; t < n; ++t) {
    eth3d_scores s{tolerances[t], *completeness[t], accuracy[t], std::nullopt};
    if (s.accuracy) s.f_score = detail::harmonic_mean(s.completeness, *s.accuracy);
    result.scores.push_back(s);
    result.n_unobserved.push_back(detail::count_unobserved(accurate, t));
  }
  return result;
}

}  // namespace AIB_ISA
}  // namespace aib::cloud
