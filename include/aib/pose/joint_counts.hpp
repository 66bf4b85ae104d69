// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/pose/angle_bins.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace aib::pose {

/// Frame pairs counted by rotation error and by direction error at once, mergeable. Every recall,
/// folded or signed, of one error or of both, is a sum of its cells.
class joint_counts {
 public:
  joint_counts(angle_bins rotation, angle_bins translation)
      : rotation_(std::move(rotation)), translation_(std::move(translation)), counts_(places()) {}

  [[nodiscard]] const angle_bins& rotation() const { return rotation_; }
  [[nodiscard]] const angle_bins& translation() const { return translation_; }

  /// Translation bins, and one column of pairs without a direction.
  [[nodiscard]] std::size_t columns() const { return translation_.size() + 1; }
  [[nodiscard]] std::size_t places() const { return rotation_.size() * columns(); }

  /// Index of the cell of a pair.
  [[nodiscard]] std::size_t place(double rotation_deg,
                                  std::optional<double> translation_deg) const {
    const std::size_t column =
        translation_deg ? translation_.find(*translation_deg) : translation_.size();
    return rotation_.find(rotation_deg) * columns() + column;
  }

  /// Adds counts of the same layout.
  template <class Integer>
  void add(const std::vector<Integer>& counts) {
    for (std::size_t i = 0; i < counts_.size(); ++i) counts_[i] += counts[i];
  }

  /// Throw argument_error if the bins differ.
  joint_counts& operator+=(const joint_counts& other) {
    check(other);
    add(other.counts_);
    return *this;
  }
  /// Takes a subset away.
  joint_counts& operator-=(const joint_counts& subset) {
    check(subset);
    for (std::size_t i = 0; i < counts_.size(); ++i) counts_[i] -= subset.counts_[i];
    return *this;
  }

  /// Pairs in one rotation bin and one column.
  [[nodiscard]] std::uint64_t at(std::size_t rotation, std::size_t column) const {
    return counts_[rotation * columns() + column];
  }

  /// Pairs in rotation bins [0, rotation_end) and columns [column, column_end).
  [[nodiscard]] std::uint64_t sum(std::size_t rotation_end,
                                  std::size_t column,
                                  std::size_t column_end) const {
    std::uint64_t n = 0;
    for (std::size_t r = 0; r < rotation_end; ++r) {
      for (std::size_t c = column; c < column_end; ++c) n += at(r, c);
    }
    return n;
  }

  [[nodiscard]] std::uint64_t pairs() const { return sum(rotation_.size(), 0, columns()); }
  [[nodiscard]] std::uint64_t without_direction() const {
    return sum(rotation_.size(), translation_.size(), columns());
  }

 private:
  void check(const joint_counts& other) const {
    if (other.rotation_.edges_deg() == rotation_.edges_deg() &&
        other.translation_.edges_deg() == translation_.edges_deg())
      return;
    throw argument_error("joint_counts: the bins differ");
  }

  angle_bins rotation_, translation_;
  std::vector<std::uint64_t> counts_;
};

}  // namespace aib::pose
