// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/cloud.hpp>
#include <aib/cloud/distances.hpp>
#include <aib/core/error.hpp>
#include <aib/core/isa.hpp>
#include <aib/mesh/distances.hpp>
#include <aib/mesh/mesh.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace aib::mesh {

/// What a reconstruction got right, face by face of the reference. NaN where a face has no point.
struct face_scores {
  std::vector<float> accuracy;      ///< mean distance of the estimated points nearest to the face
  std::vector<float> completeness;  ///< mean distance from samples of the face to the estimate
  std::vector<float> recall;        ///< share of these samples strictly below tau
  std::vector<std::size_t> n_estimate;
  std::vector<std::size_t> n_samples;
};

namespace detail {

/// Means of values by face.
class face_means {
 public:
  explicit face_means(std::size_t n_faces) : sum_(n_faces), n_(n_faces) {}

  void add(std::uint32_t face, double value) {
    if (face >= n_.size() || !std::isfinite(value)) return;
    sum_[face] += value;
    ++n_[face];
  }
  [[nodiscard]] std::vector<float> values() const {
    std::vector<float> mean;
    for (std::size_t f = 0; f < n_.size(); ++f) {
      mean.push_back(n_[f] == 0 ? std::numeric_limits<float>::quiet_NaN()
                                : static_cast<float>(sum_[f] / static_cast<double>(n_[f])));
    }
    return mean;
  }
  [[nodiscard]] const std::vector<std::size_t>& counts() const { return n_; }

 private:
  std::vector<double> sum_;
  std::vector<std::size_t> n_;
};

}  // namespace detail

inline namespace AIB_ISA {

/// Scores of each face, to be written as scalars and colours of the mesh.
///
/// samples   points on the mesh (sample::mesh); each belongs to the face nearest to it
/// tau       threshold of recall
///
/// A point farther than max_distance counts for no face with `drop`, as that far with `clamp`.
/// Throws undefined_error if the estimate or the samples have no finite point or the mesh has no
/// finite triangle.
[[nodiscard]] inline face_scores scores_by_face(const cloud::cloud& estimate,
                                                const mesh& reference,
                                                const cloud::cloud& samples,
                                                double tau,
                                                const cloud::distance_options& options = {}) {
  const surface_index index(reference, options.threads, options.control);
  auto near = closest(estimate, index, options.threads, options.control);
  const cloud::distances to_surface(std::move(near.distance), options);
  const auto sampled = closest(samples, index, options.threads, options.control);
  const cloud::distances to_estimate(samples, estimate, options);
  const std::size_t n = reference.triangles.size();
  detail::face_means accuracy(n), completeness(n), recall(n);
  for (std::size_t i = 0; i < to_surface.size(); ++i) accuracy.add(near.triangle[i], to_surface[i]);
  for (std::size_t i = 0; i < to_estimate.size(); ++i) {
    completeness.add(sampled.triangle[i], to_estimate[i]);
    if (!std::isnan(to_estimate[i])) recall.add(sampled.triangle[i], to_estimate[i] < tau);
  }
  return {accuracy.values(), completeness.values(), recall.values(), accuracy.counts(),
          recall.counts()};
}

/// The label of the face nearest to each point; 0 for a point that is not finite.
/// Throws argument_error if the mesh has no labels.
[[nodiscard]] inline std::vector<std::uint32_t> nearest_labels(const cloud::cloud& points,
                                                               const mesh& surface,
                                                               unsigned threads = 0,
                                                               const control& control = {}) {
  if (surface.labels.size() != surface.triangles.size()) {
    throw argument_error("mesh::nearest_labels: a mesh with labels expected");
  }
  const auto near = closest(points, surface_index(surface, threads, control), threads, control);
  std::vector<std::uint32_t> labels(points.size());
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (near.triangle[i] < surface.labels.size()) labels[i] = surface.labels[near.triangle[i]];
  }
  return labels;
}

}  // namespace AIB_ISA
}  // namespace aib::mesh
