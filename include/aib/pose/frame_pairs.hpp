// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/executor.hpp>
#include <aib/core/isa.hpp>
#include <aib/math/rigid3.hpp>
#include <aib/math/rotation.hpp>
#include <aib/pose/angle_bins.hpp>
#include <aib/pose/baselines.hpp>
#include <aib/pose/joint_counts.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <mutex>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace aib::pose {

/// Errors of the relative pose of two frames, in degrees, [0, 180].
struct pair_error {
  double rotation_deg;
  std::optional<double> translation_deg;  ///< between directions; nothing where there is none
};

/// Frames j in [begin, end) that a frame i is paired with.
struct pair_row {
  std::size_t begin;
  std::size_t end;
};

inline namespace AIB_ISA {

/// The relative poses E_i E_j^-1 (camera-from-world) of all pairs of two trajectories, estimate
/// against reference, in a stream: memory grows with the frames, never with the pairs.
///
/// With R the rotation of world_from_camera, C the camera centre, g the reference, p the estimate:
///   rotation      R_ij = R_i^T R_j. The error is the angle of R_p,ij R_g,ij^T, which is that of
///                 A_i^T A_j with the residual A_i = R_p,i R_g,i^T. With unit quaternions a_i of
///                 A_i its half has the cosine |a_i . a_j|: one dot product of four numbers.
///   translation   t_ij = R_i^T (C_j - C_i). The angle between t_p,ij and t_g,ij is that between
///                 A_i^T (C_p,j - C_p,i) and C_g,j - C_g,i: a matrix of frame i, no pair matrix.
/// Neither angle is calculated: sin^2 of it (of its half for rotations) is compared with the sin^2
/// of the edges, see key_table. Results are the same bits for any number of threads.
///
/// A pair has no direction where a baseline is too short for one, see baselines.
class frame_pairs {
 public:
  /// Poses world_from_camera, finite, rotations orthonormal.
  /// Throws argument_error if the lengths differ.
  frame_pairs(std::span<const math::rigid3> estimate, std::span<const math::rigid3> reference);

  [[nodiscard]] std::size_t frames() const { return frames_; }
  [[nodiscard]] const baselines& estimate_baselines() const { return estimate_; }
  [[nodiscard]] const baselines& reference_baselines() const { return reference_; }

  /// Exact errors of one pair.
  [[nodiscard]] pair_error error(std::size_t i, std::size_t j) const;

  /// Counts the pairs of every frame i with the frames of `row(i)` by their errors.
  ///
  /// row   pair_row(std::size_t i), within [0, frames())
  template <class Row>
  [[nodiscard]] joint_counts count_rows(angle_bins rotation,
                                        angle_bins translation,
                                        Row&& row,
                                        unsigned threads = 0,
                                        const control& control = {}) const;

  /// Counts every pair i < j.
  [[nodiscard]] joint_counts count(angle_bins rotation,
                                   angle_bins translation,
                                   unsigned threads = 0,
                                   const control& control = {}) const {
    return count_rows(
        std::move(rotation), std::move(translation),
        [n = frames_](std::size_t i) {
          return pair_row{i + 1, n};
        },
        threads, control);
  }

 private:
  static constexpr std::size_t block = 64;  // pairs that are calculated together, in level 1 cache
  static constexpr std::size_t rows = 16;   // of a chunk

  struct block_keys {
    double rotation[block], direction[block];
    std::uint64_t rotation_cell[block], direction_cell[block];
  };
  /// Cells of directions: those of front_table, those of back_table, one that asks.
  struct cell_tables {
    std::vector<key_table::cell> rotation, direction;
  };

  [[nodiscard]] block_keys keys_of(std::size_t i, std::size_t j) const;
  [[nodiscard]] static cell_tables tables_of(const joint_counts& bins);
  void count_row(std::size_t i,
                 pair_row row,
                 const cell_tables& tables,
                 const joint_counts& bins,
                 std::vector<std::uint32_t>& counts) const;

  std::size_t frames_;
  std::array<std::vector<double>, 4> residual_;           // quaternions a_i
  std::vector<Eigen::Matrix3d> reference_from_estimate_;  // A_i^T
  baselines estimate_, reference_;
};

inline frame_pairs::frame_pairs(std::span<const math::rigid3> estimate,
                                std::span<const math::rigid3> reference)
    : frames_(estimate.size()), estimate_(estimate, block), reference_(reference, block) {
  if (estimate.size() != reference.size()) {
    throw argument_error(message("frame_pairs: as many estimated as reference poses expected, ",
                                 "found ", estimate.size(), " and ", reference.size()));
  }
  for (auto& component : residual_) component.resize(frames_ + block);
  reference_from_estimate_.reserve(frames_);
  for (std::size_t i = 0; i < frames_; ++i) {
    const Eigen::Matrix3d a = estimate[i].rotation * reference[i].rotation.transpose();
    const math::quaternion q = math::quaternion_from(a);
    residual_[0][i] = q.w;
    residual_[1][i] = q.x;
    residual_[2][i] = q.y;
    residual_[3][i] = q.z;
    reference_from_estimate_.push_back(a.transpose());
  }
}

inline pair_error frame_pairs::error(std::size_t i, std::size_t j) const {
  const auto a = [&](std::size_t k) {
    return Eigen::Quaterniond(residual_[0][k], residual_[1][k], residual_[2][k], residual_[3][k]);
  };
  const Eigen::Quaterniond q = a(i).conjugate() * a(j);
  pair_error out{math::degrees(2 * std::atan2(q.vec().norm(), std::abs(q.w()))), std::nullopt};
  const Eigen::Vector3d g = reference_.between(i, j);
  const Eigen::Vector3d p = estimate_.between(i, j);
  if (reference_.has_direction(i, j) && estimate_.has_direction(i, j)) {
    const Eigen::Vector3d moved = reference_from_estimate_[i] * p;
    out.translation_deg = math::degrees(std::atan2(g.cross(moved).norm(), g.dot(moved)));
  }
  return out;
}

/// Keys of frame i with the frames j .. j + block - 1. Loops without branches over a fixed number
/// of pairs, which every compiler turns into vector code.
inline frame_pairs::block_keys frame_pairs::keys_of(std::size_t i, std::size_t j) const {
  block_keys out;
  const double w = residual_[0][i], x = residual_[1][i], y = residual_[2][i], z = residual_[3][i];
  const double *ws = &residual_[0][j], *xs = &residual_[1][j], *ys = &residual_[2][j],
               *zs = &residual_[3][j];
  for (std::size_t k = 0; k < block; ++k) {
    const double cosine = w * ws[k] + x * xs[k] + y * ys[k] + z * zs[k];
    out.rotation[k] = 1 - cosine * cosine;
    out.rotation_cell[k] = key_table::cell_of(out.rotation[k]);
  }
  const Eigen::Matrix3d& m = reference_from_estimate_[i];
  const double m00 = m(0, 0), m01 = m(0, 1), m02 = m(0, 2), m10 = m(1, 0), m11 = m(1, 1),
               m12 = m(1, 2), m20 = m(2, 0), m21 = m(2, 1), m22 = m(2, 2);
  const double gx = reference_.x[i], gy = reference_.y[i], gz = reference_.z[i];
  const double px = estimate_.x[i], py = estimate_.y[i], pz = estimate_.z[i];
  const double *gxs = &reference_.x[j], *gys = &reference_.y[j], *gzs = &reference_.z[j];
  const double *pxs = &estimate_.x[j], *pys = &estimate_.y[j], *pzs = &estimate_.z[j];
  const double g_certain = reference_.certain() * reference_.certain();
  const double p_certain = estimate_.certain() * estimate_.certain();
  constexpr std::uint64_t back = key_table::size(), ask = 2 * back;
  for (std::size_t k = 0; k < block; ++k) {
    const double g0 = gxs[k] - gx, g1 = gys[k] - gy, g2 = gzs[k] - gz;
    const double p0 = pxs[k] - px, p1 = pys[k] - py, p2 = pzs[k] - pz;
    const double u0 = m00 * p0 + m01 * p1 + m02 * p2;
    const double u1 = m10 * p0 + m11 * p1 + m12 * p2;
    const double u2 = m20 * p0 + m21 * p1 + m22 * p2;
    const double gg = g0 * g0 + g1 * g1 + g2 * g2;
    const double pp = p0 * p0 + p1 * p1 + p2 * p2;
    const double dot = g0 * u0 + g1 * u1 + g2 * u2;
    out.direction[k] = 1 - dot * dot / (gg * pp);
    const std::uint64_t cell = key_table::cell_of(out.direction[k]) + (dot < 0 ? back : 0);
    out.direction_cell[k] = ((gg > g_certain) & (pp > p_certain)) ? cell : ask;
  }
  return out;
}

inline frame_pairs::cell_tables frame_pairs::tables_of(const joint_counts& bins) {
  cell_tables out;
  const key_table rotation = rotation_table(bins.rotation());
  const key_table front = front_table(bins.translation()), back = back_table(bins.translation());
  const auto columns = static_cast<std::uint32_t>(bins.columns());
  for (key_table::cell c : rotation.cells())
    out.rotation.push_back({c.edge, {c.bin[0] * columns, c.bin[1] * columns}});
  out.direction = front.cells();
  out.direction.insert(out.direction.end(), back.cells().begin(), back.cells().end());
  out.direction.push_back({std::numeric_limits<double>::quiet_NaN(), {0, 0}});
  return out;
}

inline void frame_pairs::count_row(std::size_t i,
                                   pair_row row,
                                   const cell_tables& tables,
                                   const joint_counts& bins,
                                   std::vector<std::uint32_t>& counts) const {
  const key_table::cell* const rotation = tables.rotation.data();
  const key_table::cell* const direction = tables.direction.data();
  std::uint32_t* const count = counts.data();
  for (std::size_t j = row.begin; j < row.end; j += block) {
    const block_keys keys = keys_of(i, j);
    const std::size_t n = std::min(block, row.end - j);
    for (std::size_t k = 0; k < n; ++k) {
      const key_table::cell& r = rotation[keys.rotation_cell[k]];
      const key_table::cell& t = direction[keys.direction_cell[k]];
      const double past_r = keys.rotation[k] - r.edge, past_t = keys.direction[k] - t.edge;
      if (!(std::abs(past_r) > key_table::doubt) || !(std::abs(past_t) > key_table::doubt))
          [[unlikely]] {
        const pair_error e = error(i, j + k);
        ++count[bins.place(e.rotation_deg, e.translation_deg)];
      } else {
        ++count[r.bin[std::signbit(past_r)] + t.bin[std::signbit(past_t)]];
      }
    }
  }
}

template <class Row>
joint_counts frame_pairs::count_rows(angle_bins rotation,
                                     angle_bins translation,
                                     Row&& row,
                                     unsigned threads,
                                     const control& control) const {
  joint_counts total(std::move(rotation), std::move(translation));
  const cell_tables tables = tables_of(total);
  std::mutex mutex;
  for_each_chunk(frames_, rows, threads, control, [&](const chunk& c) {
    std::vector<std::uint32_t> counts(total.places());
    for (std::size_t i = c.begin; i < c.end; ++i) count_row(i, row(i), tables, total, counts);
    const std::scoped_lock lock(mutex);  // integers: the order of the sums does not matter
    total.add(counts);
  });
  return total;
}

}  // namespace AIB_ISA

}  // namespace aib::pose
