// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/box.hpp>
#include <aib/cloud/cloud.hpp>
#include <aib/cloud/positions.hpp>
#include <aib/core/error.hpp>
#include <aib/core/executor.hpp>
#include <aib/search/buffer.hpp>
#include <aib/search/radix_sort.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace aib::sample {

/// Where the lattice of voxels begins.
enum class voxel_anchor {
  world,   ///< at the origin of the world: one more point moves no other
  open3d,  ///< half a voxel below the cloud's own corner, as Open3D's voxel_down_sample
};

namespace detail {

/// The lattice: which cell a point lies in, counted from the lowest cell of the cloud. Calculated
/// in double.
class voxel_lattice {
 public:
  using cell = std::array<std::uint64_t, 3>;

  voxel_lattice(const cloud::cloud& points, double size, voxel_anchor anchor)
      : points_(points), size_(size) {
    if (!(size > 0 && std::isfinite(size))) {
      throw argument_error(message("sample::voxel: size > 0 expected, found ", size));
    }
    const cloud::box box = cloud::bounds(points);
    if (anchor == voxel_anchor::open3d) anchor_ = box.low.array() - size * 0.5;
    if (box.empty()) return;
    first_ = place_of(box.low);
    const Eigen::Vector3d last = place_of(box.high);
    for (int k = 0; k < 3; ++k) {
      if (!(std::abs(first_[k]) < 0x1p52 && std::abs(last[k]) < 0x1p52 &&
            last[k] - first_[k] < 0x1p31)) {
        throw argument_error(
            message("sample::voxel: size ", size, " is too small for a cloud of ", box.size()[k]));
      }
      const auto cells = static_cast<std::uint64_t>(last[k] - first_[k]) + 1;
      bits_[static_cast<std::size_t>(k)] = static_cast<int>(std::bit_width(cells));
    }
  }

  /// Bits that hold a coordinate of a cell, and one number that is none: all of them set.
  [[nodiscard]] int bits(std::size_t axis) const { return bits_[axis]; }

  /// x, y and z of the cell of point i; all bits set where the point is not finite.
  [[nodiscard]] cell cell_of(std::size_t i) const {
    if (!cloud::is_finite(points_.points[i])) return none();
    const Eigen::Vector3d c = place_of(points_.position(i)) - first_;
    return {static_cast<std::uint64_t>(c.x()), static_cast<std::uint64_t>(c.y()),
            static_cast<std::uint64_t>(c.z())};
  }
  [[nodiscard]] cell none() const { return {ones(bits_[0]), ones(bits_[1]), ones(bits_[2])}; }

  /// Centre of the cell of point i.
  [[nodiscard]] Eigen::Vector3d centre(std::size_t i) const {
    return anchor_.array() + (place_of(points_.position(i)).array() + 0.5) * size_;
  }

 private:
  [[nodiscard]] Eigen::Vector3d place_of(const Eigen::Vector3d& p) const {
    return ((p - anchor_) / size_).array().floor();
  }
  [[nodiscard]] static std::uint64_t ones(int bits) { return (std::uint64_t{1} << bits) - 1; }

  const cloud::cloud& points_;
  double size_;
  Eigen::Vector3d anchor_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d first_ = Eigen::Vector3d::Zero();
  std::array<int, 3> bits_{1, 1, 1};
};

/// The finite points of a cloud, voxel by voxel in the order of the lattice (z, then y, then x);
/// those of a voxel in their own order.
class points_by_voxel {
 public:
  points_by_voxel(const cloud::cloud& points,
                  const voxel_lattice& lattice,
                  unsigned threads,
                  const control& control);

  [[nodiscard]] std::size_t size() const { return starts_.size() - 1; }  ///< of voxels
  [[nodiscard]] std::size_t n_points() const { return starts_.back(); }

  /// Indices of the points of a voxel.
  [[nodiscard]] std::span<const std::uint64_t> operator[](std::size_t voxel) const {
    return index_.span().subspan(starts_[voxel], starts_[voxel + 1] - starts_[voxel]);
  }

 private:
  static constexpr std::size_t chunk_size = std::size_t{1} << 16;

  template <class IsFirst>
  void find_starts(IsFirst&& is_first, unsigned threads, const control& control);

  search::buffer<std::uint64_t> index_;
  std::vector<std::size_t> starts_;
};

/// A cell and a point's index share a word, and one sort does, where both fit 64 bits; else the
/// axes are sorted one by one, the least important first, which is stable.
inline points_by_voxel::points_by_voxel(const cloud::cloud& points,
                                        const voxel_lattice& lattice,
                                        unsigned threads,
                                        const control& control)
    : index_(points.size()) {
  const int index_bits = std::max(1, static_cast<int>(std::bit_width(points.size())));
  const std::uint64_t mask = (std::uint64_t{1} << index_bits) - 1;
  const int cell_bits = lattice.bits(0) + lattice.bits(1) + lattice.bits(2);
  const std::size_t axes = index_bits + cell_bits <= 64 ? 3 : 1;  // that share a word
  for (std::size_t axis = 0; axis < 3; axis += axes) {
    int key_bits = 0;
    for (std::size_t k = axis; k < axis + axes; ++k) key_bits += lattice.bits(k);
    for_each_chunk(points.size(), chunk_size, threads, control, [&](const chunk& c) {
      for (std::size_t w = c.begin; w < c.end; ++w) {
        const std::uint64_t i = axis == 0 ? w : index_[w] & mask;
        const voxel_lattice::cell cell = lattice.cell_of(i);
        std::uint64_t key = 0;
        for (std::size_t k = axis + axes; k-- > axis;) key = key << lattice.bits(k) | cell[k];
        index_[w] = key << index_bits | i;
      }
    });
    search::radix_sort(index_, {index_bits, index_bits + key_bits}, threads, control);
  }
  const auto cell_at = [&](std::size_t w) { return lattice.cell_of(index_[w] & mask); };
  if (axes == 3) {
    find_starts([&](std::size_t w) { return (index_[w] ^ index_[w - 1]) >> index_bits != 0; },
                threads, control);
  } else {
    find_starts([&](std::size_t w) { return cell_at(w) != cell_at(w - 1); }, threads, control);
  }
  if (size() > 0 && cell_at(starts_[size() - 1]) == lattice.none()) starts_.pop_back();
  for_each_chunk(points.size(), chunk_size, threads, control, [&](const chunk& c) {
    for (std::size_t w = c.begin; w < c.end; ++w) index_[w] &= mask;
  });
}

/// `is_first(w)`: whether the point at place w > 0 has another cell than the one before.
template <class IsFirst>
void points_by_voxel::find_starts(IsFirst&& is_first, unsigned threads, const control& control) {
  const std::size_t n = index_.size();
  std::vector<std::size_t> next((n + chunk_size - 1) / chunk_size + 1, 0);
  for_each_chunk(n, chunk_size, threads, control, [&](const chunk& c) {
    std::size_t count = 0;
    for (std::size_t w = c.begin; w < c.end; ++w) count += w == 0 || is_first(w) ? 1 : 0;
    next[c.index + 1] = count;
  });
  for (std::size_t c = 1; c < next.size(); ++c) next[c] += next[c - 1];
  starts_.resize(next.back() + 1);
  for_each_chunk(n, chunk_size, threads, control, [&](const chunk& c) {
    std::size_t* start = starts_.data() + next[c.index];
    for (std::size_t w = c.begin; w < c.end; ++w) {
      if (w == 0 || is_first(w)) *start++ = w;
    }
  });
  starts_.back() = n;
}

}  // namespace detail

}  // namespace aib::sample
