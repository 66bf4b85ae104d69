// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/cloud.hpp>
#include <aib/cloud/compare.hpp>
#include <aib/cloud/distances.hpp>
#include <aib/cloud/neighbours.hpp>
#include <aib/cloud/positions.hpp>
#include <aib/core/error.hpp>
#include <aib/core/executor.hpp>
#include <aib/core/isa.hpp>

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

namespace aib::cloud {

/// The label of the nearest point of a labelled cloud for each point of another; 0 for a point that
/// is not finite.
/// Throws argument_error if the reference has no labels, undefined_error if it has no finite point.
[[nodiscard]] inline std::vector<std::uint32_t> nearest_labels(const cloud& points,
                                                               const cloud& labelled,
                                                               unsigned threads = 0,
                                                               const control& control = {}) {
  if (labelled.labels.size() != labelled.size()) {
    throw argument_error("cloud::nearest_labels: a reference with labels expected");
  }
  const neighbours search(labelled, control);
  if (search.size() == 0) {
    throw undefined_error(message("cloud::nearest_labels: no finite point in the reference (",
                                  labelled.size(), " points)"));
  }
  std::vector<std::uint32_t> labels(points.size());
  for_each_chunk(points.size(), 1024, threads, control, [&](const chunk& c) {
    for (std::size_t i = c.begin; i < c.end; ++i) {
      if (!is_finite(points.points[i])) continue;
      labels[i] = labelled.labels[search.nearest(points.position(i), 1).front().index];
    }
  });
  return labels;
}

inline namespace AIB_ISA {

/// The distances of one label: of the points of the estimate that belong to it, and of those of the
/// reference. Either may be empty.
struct label_distances {
  std::uint32_t label;
  distances to_reference;
  distances to_estimate;
};

/// Distances in both directions, label by label in ascending order, for `score` to be taken of
/// each. What a search found stays as it is: the nearest point may have another label.
///
/// estimate_labels, reference_labels   one a point of the estimate, of the reference
///
/// Throws argument_error where labels and distances differ in number.
[[nodiscard]] inline std::vector<label_distances> by_label(
    const two_way_distances& both,
    std::span<const std::uint32_t> estimate_labels,
    std::span<const std::uint32_t> reference_labels,
    const distance_options& options = {}) {
  struct values {
    std::vector<float> estimate, reference;
  };
  const auto check = [](const distances& d, std::span<const std::uint32_t> labels) {
    if (d.size() == labels.size()) return;
    throw argument_error(message("cloud::by_label: a label for each of ", d.size(),
                                 " distances expected, found ", labels.size()));
  };
  check(both.to_reference, estimate_labels);
  check(both.to_estimate, reference_labels);
  std::map<std::uint32_t, values> found;
  for (std::size_t i = 0; i < estimate_labels.size(); ++i) {
    found[estimate_labels[i]].estimate.push_back(both.to_reference[i]);
  }
  for (std::size_t i = 0; i < reference_labels.size(); ++i) {
    found[reference_labels[i]].reference.push_back(both.to_estimate[i]);
  }
  std::vector<label_distances> labels;
  for (auto& [label, v] : found) {
    labels.push_back({label, distances(std::move(v.estimate), options),
                      distances(std::move(v.reference), options)});
  }
  return labels;
}

}  // namespace AIB_ISA
}  // namespace aib::cloud
