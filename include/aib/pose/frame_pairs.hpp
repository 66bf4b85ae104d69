// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/executor.hpp>
#include <aib/core/isa.hpp>
#include <aib/core/simd.hpp>
#include <aib/math/angle_of.hpp>
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
/// of the edges, see key_table. Some rows of pairs are counted side by side, so that what they read
/// stays in the nearest cache. Results are the same bits for any number of threads.
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

  /// Calls `visit` with the errors of frame i and those of a row, ascending: the numbers of `error`
  /// up to rounding, many at once.
  ///
  /// visit   void(std::size_t j, double rotation_deg, double translation_deg), the latter NaN where
  ///         there is no direction
  template <class Visit>
  void for_each_error(std::size_t i, pair_row row, Visit&& visit) const;

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
  /// Squared sines and cosines of errors, of rotations of half the angle, both times a length.
  struct block_errors {
    double rotation_sine2[block], rotation_cosine[block], sine2[block], cosine[block];
    bool has_direction[block];
  };
  /// Where a pair counts, by the cells of its keys. Cells of directions: those of front, those of
  /// back, no_direction.
  struct place_tables {
    explicit place_tables(const joint_counts& bins);
    key_table rotation, front, back;
    std::vector<std::uint32_t> direction_cells;
  };
  static constexpr std::uint64_t no_direction = 2 * key_table::size();

  [[nodiscard]] block_keys keys_of(std::size_t i, std::size_t j) const;
  [[nodiscard]] block_errors errors_of(std::size_t i, std::size_t j) const;
  /// Where the pair of i and j + k counts whose keys lie in the cell of an edge.
  [[nodiscard]] std::size_t place(std::size_t i,
                                  std::size_t j,
                                  std::size_t k,
                                  const block_keys& keys,
                                  const place_tables& tables,
                                  const joint_counts& bins) const;
  /// Counts frame i with those of its row in [j, j + block).
  void count_block(std::size_t i,
                   std::size_t j,
                   pair_row row,
                   const place_tables& tables,
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
    const std::uint64_t cell =
        key_table::cell_of(out.direction[k]) + (dot < 0 ? key_table::size() : 0);
    out.direction_cell[k] = ((gg > g_certain) & (pp > p_certain)) ? cell : no_direction;
  }
  return out;
}

inline frame_pairs::place_tables::place_tables(const joint_counts& bins)
    : rotation(rotation_table(bins.rotation(), bins.columns())),
      front(front_table(bins.translation())),
      back(back_table(bins.translation())),
      direction_cells(front.cells()) {
  direction_cells.insert(direction_cells.end(), back.cells().begin(), back.cells().end());
  direction_cells.push_back(key_table::edge);
}

inline std::size_t frame_pairs::place(std::size_t i,
                                      std::size_t j,
                                      std::size_t k,
                                      const block_keys& keys,
                                      const place_tables& tables,
                                      const joint_counts& bins) const {
  const std::uint64_t cell = keys.direction_cell[k];
  if (cell < no_direction) {
    const key_table& directions = cell < key_table::size() ? tables.front : tables.back;
    const auto rotation = tables.rotation.find(keys.rotation[k]);
    const auto direction = directions.find(keys.direction[k]);
    if (rotation && direction) return *rotation + *direction;
  }
  const pair_error e = error(i, j + k);
  return bins.place(e.rotation_deg, e.translation_deg);
}

inline void frame_pairs::count_block(std::size_t i,
                                     std::size_t j,
                                     pair_row row,
                                     const place_tables& tables,
                                     const joint_counts& bins,
                                     std::vector<std::uint32_t>& counts) const {
  const std::size_t begin = std::max(row.begin, j), end = std::min(row.end, j + block);
  if (begin >= end) return;
  const block_keys keys = keys_of(i, j);
  const std::uint32_t* const rotation = tables.rotation.cells().data();
  const std::uint32_t* const direction = tables.direction_cells.data();
  std::uint32_t* const count = counts.data();
  for (std::size_t k = begin - j; k < end - j; ++k) {
    std::size_t at = rotation[keys.rotation_cell[k]] + direction[keys.direction_cell[k]];
    if (at >= key_table::edge) [[unlikely]]
      at = place(i, j, k, keys, tables, bins);
    ++count[at];
  }
}

/// Not from 1 - cos^2: cross products and the vector of the quaternion keep small angles.
inline frame_pairs::block_errors frame_pairs::errors_of(std::size_t i, std::size_t j) const {
  block_errors out;
  const double w = residual_[0][i], x = residual_[1][i], y = residual_[2][i], z = residual_[3][i];
  const double *ws = &residual_[0][j], *xs = &residual_[1][j], *ys = &residual_[2][j],
               *zs = &residual_[3][j];
  for (std::size_t k = 0; k < block; ++k) {
    const double vx = w * xs[k] - x * ws[k] - (y * zs[k] - z * ys[k]);
    const double vy = w * ys[k] - y * ws[k] - (z * xs[k] - x * zs[k]);
    const double vz = w * zs[k] - z * ws[k] - (x * ys[k] - y * xs[k]);
    out.rotation_sine2[k] = vx * vx + vy * vy + vz * vz;
    out.rotation_cosine[k] = std::abs(w * ws[k] + x * xs[k] + y * ys[k] + z * zs[k]);
  }
  const Eigen::Matrix3d& m = reference_from_estimate_[i];
  const double g_certain = reference_.certain() * reference_.certain();
  const double p_certain = estimate_.certain() * estimate_.certain();
  for (std::size_t k = 0; k < block; ++k) {
    const double g0 = reference_.x[j + k] - reference_.x[i];
    const double g1 = reference_.y[j + k] - reference_.y[i];
    const double g2 = reference_.z[j + k] - reference_.z[i];
    const double p0 = estimate_.x[j + k] - estimate_.x[i];
    const double p1 = estimate_.y[j + k] - estimate_.y[i];
    const double p2 = estimate_.z[j + k] - estimate_.z[i];
    const double u0 = m(0, 0) * p0 + m(0, 1) * p1 + m(0, 2) * p2;
    const double u1 = m(1, 0) * p0 + m(1, 1) * p1 + m(1, 2) * p2;
    const double u2 = m(2, 0) * p0 + m(2, 1) * p1 + m(2, 2) * p2;
    const double c0 = g1 * u2 - g2 * u1, c1 = g2 * u0 - g0 * u2, c2 = g0 * u1 - g1 * u0;
    out.sine2[k] = c0 * c0 + c1 * c1 + c2 * c2;
    out.cosine[k] = g0 * u0 + g1 * u1 + g2 * u2;
    out.has_direction[k] =
        (g0 * g0 + g1 * g1 + g2 * g2 > g_certain) & (p0 * p0 + p1 * p1 + p2 * p2 > p_certain);
  }
  return out;
}

template <class Visit>
void frame_pairs::for_each_error(std::size_t i, pair_row row, Visit&& visit) const {
  double rotation[block], translation[block];
  for (std::size_t j = row.begin; j < row.end; j += block) {
    const block_errors errors = errors_of(i, j);
    for (std::size_t k = 0; k < block; k += f64x4::width) {
      const auto angle = [&](const double* cosine, const double* sine2) {
        return math::angle_of(f64x4::load(cosine + k), sqrt(f64x4::load(sine2 + k)));
      };
      angle(errors.rotation_cosine, errors.rotation_sine2).store(rotation + k);
      angle(errors.cosine, errors.sine2).store(translation + k);
    }
    for (std::size_t k = 0; k < std::min(block, row.end - j); ++k) {
      double translation_deg = math::degrees(translation[k]);
      if (!errors.has_direction[k]) {
        translation_deg =
            error(i, j + k).translation_deg.value_or(std::numeric_limits<double>::quiet_NaN());
      }
      visit(j + k, math::degrees(2 * rotation[k]), translation_deg);
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
  const place_tables tables(total);
  std::mutex mutex;
  for_each_chunk(frames_, rows, threads, control, [&](const chunk& c) {
    std::array<pair_row, rows> row_of;
    pair_row all{frames_, 0};
    for (std::size_t i = c.begin; i < c.end; ++i) {
      const pair_row r = row_of[i - c.begin] = row(i);
      all = {std::min(all.begin, r.begin), std::max(all.end, r.end)};
    }
    std::vector<std::uint32_t> counts(total.places());
    for (std::size_t j = all.begin; j < all.end; j += block) {
      for (std::size_t i = c.begin; i < c.end; ++i)
        count_block(i, j, row_of[i - c.begin], tables, total, counts);
    }
    const std::scoped_lock lock(mutex);  // integers: the order of the sums does not matter
    total.add(counts);
  });
  return total;
}

}  // namespace AIB_ISA

}  // namespace aib::pose
