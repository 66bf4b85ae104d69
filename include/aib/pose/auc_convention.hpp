// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/pose/angle_bins.hpp>
#include <aib/pose/joint_counts.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

namespace aib::pose {

/// Whose area under the recall curve. On one trajectory they give from 0.47 to 0.69: the convention
/// is part of the number.
enum class auc_convention {
  paper,                ///< E_i E_j^-1, mean over tau = 1..T of min(RRA, RTA), signed directions
  vggt,                 ///< E_i E_j^-1, max of both errors a pair, folded, last bin closed
  posediffusion,        ///< as vggt with E_j E_i^-1; pi3 as well
  posediffusion_torch,  ///< as posediffusion with T + 1 bins on [0, T]
  da3,                  ///< E_i^-1 E_j from the first camera, else as vggt; depends on that camera
  colmap,  ///< ordered pairs, trapezoids, inclusive, missing frames count as 180 degrees
  exact,   ///< exact area under the recall of the max of both errors, signed
};

inline constexpr std::array<std::string_view, 7> auc_convention_names = {
    "paper", "vggt", "posediffusion", "posediffusion_torch", "da3", "colmap", "exact",
};

[[nodiscard]] constexpr std::string_view name(auc_convention c) {
  return auc_convention_names[static_cast<std::size_t>(c)];
}

/// Whether a convention takes opposite directions for the same.
[[nodiscard]] constexpr bool folds(auc_convention c) {
  return c == auc_convention::vggt || c == auc_convention::posediffusion ||
         c == auc_convention::posediffusion_torch || c == auc_convention::da3;
}

/// Whether a convention's relative pose is E_j E_i^-1: that of the frames in reverse.
[[nodiscard]] constexpr bool reverses(auc_convention c) {
  return c == auc_convention::posediffusion || c == auc_convention::posediffusion_torch;
}

/// Whether a convention is a mean over thresholds, so that counts of pairs suffice.
[[nodiscard]] constexpr bool is_binned(auc_convention c) {
  return c == auc_convention::paper || folds(c);
}

/// Share of pairs by threshold, and its mean.
struct recall {
  double auc = 0;                ///< by the convention
  double auc_signed = 0;         ///< the same with directions over 0..180 degrees
  std::vector<double> rra = {};  ///< at 1, 2, .. max_deg degrees, strictly below
  std::vector<double> rta = {};  ///< folded where the convention folds
};

/// The thresholds of a convention, the bins that they need, and their recalls. `convention` is one
/// that is_binned, `max_deg` in [1, 180].
class recall_thresholds {
 public:
  recall_thresholds(auc_convention convention, unsigned max_deg)
      : convention_(convention), max_deg_(max_deg) {
    if (!is_binned(convention))
      throw argument_error(message("auc: convention ", name(convention), " has no thresholds"));
    if (max_deg < 1 || max_deg > 180)
      throw argument_error(message("auc: max_deg in [1, 180] expected, found ", max_deg));
    for (unsigned k = 1; k <= max_deg; ++k) whole_.push_back({static_cast<double>(k), false});
    averaged_ = convention == auc_convention::posediffusion_torch ? torch(max_deg) : whole_;
    if (folds(convention)) averaged_.back().closed = true;
  }

  [[nodiscard]] angle_bins rotation_bins() const {
    std::vector<double> edges;
    for (const auto* list : {&whole_, &averaged_}) {
      for (const threshold t : *list) edges.push_back(t.edge());
    }
    return angle_bins(std::move(edges));
  }
  [[nodiscard]] angle_bins translation_bins() const {
    std::vector<double> edges;
    for (const auto* list : {&whole_, &averaged_}) {
      for (const threshold t : *list) {
        edges.push_back(t.edge());
        if (t.mirrored() > 0) edges.push_back(t.mirrored());
      }
    }
    return angle_bins(std::move(edges));
  }

  /// Throws undefined_error if no pair has a direction.
  [[nodiscard]] recall of(const joint_counts& counts) const;

 private:
  struct threshold {
    double deg;
    bool closed;  // an error equal to it counts as below

    [[nodiscard]] double edge() const { return closed ? std::nextafter(deg, 360.0) : deg; }
    /// Edge above which a folded error is below.
    [[nodiscard]] double mirrored() const {
      return closed ? 180 - deg : std::nextafter(180 - deg, 360.0);
    }
    [[nodiscard]] bool holds_right_angles() const { return deg > 90 || (closed && deg == 90); }
  };

  static std::vector<threshold> torch(unsigned max_deg) {
    std::vector<threshold> out;
    for (unsigned k = 1; k <= max_deg + 1; ++k)
      out.push_back({static_cast<double>(k) * max_deg / (max_deg + 1), false});
    return out;
  }

  /// Pairs below a threshold in their direction, with rotations in bins [0, rotation_end).
  static std::uint64_t directed(const joint_counts& counts, std::size_t rotation_end, threshold t) {
    return counts.sum(rotation_end, 0, counts.translation().bins_below(t.edge()));
  }
  static std::uint64_t folded(const joint_counts& counts, std::size_t rotation_end, threshold t) {
    if (t.holds_right_angles()) return counts.sum(rotation_end, 0, counts.columns());
    return directed(counts, rotation_end, t) +
           counts.sum(rotation_end, counts.translation().bins_below(t.mirrored()),
                      counts.translation().size());
  }

  auc_convention convention_;
  unsigned max_deg_;
  std::vector<threshold> whole_, averaged_;
};

inline recall recall_thresholds::of(const joint_counts& counts) const {
  const std::uint64_t pairs = counts.pairs();
  if (pairs == counts.without_direction()) {
    throw undefined_error(
        message("auc: none of ", pairs, " pairs has a direction; relative_angles still gives RRA"));
  }
  const auto n = static_cast<double>(pairs);
  const bool folding = folds(convention_);
  const std::size_t all = counts.rotation().size();
  recall out;
  for (const threshold t : whole_) {
    const std::size_t below = counts.rotation().bins_below(t.deg);
    out.rra.push_back(static_cast<double>(counts.sum(below, 0, counts.columns())) / n);
    out.rta.push_back(
        static_cast<double>(folding ? folded(counts, all, t) : directed(counts, all, t)) / n);
  }
  if (convention_ == auc_convention::paper) {
    for (std::size_t k = 0; k < whole_.size(); ++k) out.auc += std::min(out.rra[k], out.rta[k]);
    out.auc_signed = out.auc /= max_deg_;
    return out;
  }
  for (const threshold t : averaged_) {
    const std::size_t below = counts.rotation().bins_below(t.edge());
    out.auc += static_cast<double>(folded(counts, below, t)) / n;
    out.auc_signed += static_cast<double>(directed(counts, below, t)) / n;
  }
  out.auc /= static_cast<double>(averaged_.size());
  out.auc_signed /= static_cast<double>(averaged_.size());
  return out;
}

}  // namespace aib::pose
