// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/isa.hpp>
#include <aib/depth/error_sums.hpp>
#include <aib/raster/view.hpp>

#include <cstddef>
#include <cstdint>
#include <map>

namespace aib::depth {

/// Sums of the pixels of each label.
using label_sums = std::map<std::uint16_t, error_sums>;

inline label_sums& operator+=(label_sums& total, const label_sums& other) {
  for (const auto& [label, sums] : other) total[label] += sums;
  return total;
}

inline namespace AIB_ISA {

/// What sum_errors gives, for the pixels of each label that occurs, 0 among them.
///
/// labels   h x w: glass, frame, truss ... Throws argument_error if the sizes differ.
template <class Estimate, class Reference>
label_sums sum_errors_by_label(raster::view<const Estimate> estimate,
                               raster::view<const Reference> reference,
                               raster::view<const std::uint16_t> labels,
                               const pixel_rules& rules,
                               raster::view<const std::uint8_t> mask = {}) {
  check_sizes("depth::errors", estimate, reference, mask);
  check_size("depth::errors", estimate, "label image", labels);
  std::map<std::uint16_t, error_adder<>> adders;
  for (std::size_t y = 0; y < labels.height; ++y) {
    const auto row = labels.row(y);
    for (std::size_t first = 0, end = 0; first < row.size(); first = end) {
      while (end < row.size() && row[end] == row[first]) ++end;
      adders.try_emplace(row[first], rules)
          .first->second.add(estimate.row(y).subspan(first, end - first),
                             reference.row(y).subspan(first, end - first),
                             mask.data ? mask.row(y).data() + first : nullptr);
    }
  }
  label_sums sums;
  for (const auto& [label, adder] : adders) sums.emplace(label, adder.result());
  return sums;
}

}  // namespace AIB_ISA

}  // namespace aib::depth
