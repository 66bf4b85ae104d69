// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/box.hpp>
#include <aib/cloud/cloud.hpp>
#include <aib/cloud/positions.hpp>
#include <aib/cloud/select.hpp>
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
#include <utility>
#include <vector>

namespace aib::sample {

/// Where the lattice of voxels begins.
enum class voxel_anchor {
  world,   ///< at the origin of the world: one more point moves no other
  open3d,  ///< half a voxel below the cloud's own corner, as Open3D's voxel_down_sample
};

/// The one point that stands for a voxel.
enum class voxel_pick {
  mean,     ///< mean of its points
  centre,   ///< centre of the voxel
  nearest,  ///< that of its points which is nearest to their mean
};

struct voxel_options {
  double size = 0;  ///< edge of a voxel, in the unit of the cloud
  voxel_anchor anchor = voxel_anchor::world;
  voxel_pick pick = voxel_pick::mean;
  unsigned threads = 0;  ///< 0: all
};

/// One point for each voxel that has any, in the order of the lattice. Normal, colour and label are
/// those of the voxel's point nearest to the chosen one. Points that are not finite are left out.
///
/// The cell of a point is calculated in double. The same for any number of threads.
/// Throws argument_error if size is not positive or far too small for the cloud.
[[nodiscard]] cloud::cloud voxel(const cloud::cloud& points, const voxel_options& options);

namespace detail {

/// The lattice: which cell a point lies in, counted from the lowest cell of the cloud.
class voxel_lattice {
 public:
  voxel_lattice(const cloud::cloud& points, const voxel_options& options)
      : points_(points), size_(options.size) {
    if (!(options.size > 0 && std::isfinite(options.size))) {
      throw argument_error(message("sample::voxel: size > 0 expected, found ", options.size));
    }
    const cloud::box box = cloud::bounds(points);
    anchor_.setZero();
    if (options.anchor == voxel_anchor::open3d) anchor_ = box.low.array() - size_ * 0.5;
    if (box.empty()) return;
    const Eigen::Vector3d low = cell_of(box.low), high = cell_of(box.high);
    first_ = low;
    for (int k = 0; k < 3; ++k) {
      if (!(std::abs(low[k]) < 0x1p52 && std::abs(high[k]) < 0x1p52 && high[k] - low[k] < 0x1p31)) {
        throw argument_error(
            message("sample::voxel: size ", size_, " is too small for a cloud of ", box.size()[k]));
      }
      const auto cells = static_cast<std::uint64_t>(high[k] - low[k]) + 1;
      bits_[static_cast<std::size_t>(k)] = static_cast<int>(std::bit_width(cells));
    }
  }

  /// Bits that the cells take on an axis.
  [[nodiscard]] int bits(std::size_t axis) const { return bits_[axis]; }

  [[nodiscard]] std::array<std::uint64_t, 3> cell(std::size_t i) const {
    const Eigen::Vector3d c = cell_of(points_.position(i)) - first_;
    return {static_cast<std::uint64_t>(c.x()), static_cast<std::uint64_t>(c.y()),
            static_cast<std::uint64_t>(c.z())};
  }

  /// Centre of the cell of point i.
  [[nodiscard]] Eigen::Vector3d centre(std::size_t i) const {
    const Eigen::Vector3d c = cell_of(points_.position(i));
    return anchor_.array() + (c.array() + 0.5) * size_;
  }

 private:
  [[nodiscard]] Eigen::Vector3d cell_of(const Eigen::Vector3d& p) const {
    return ((p - anchor_) / size_).array().floor();
  }

  const cloud::cloud& points_;
  double size_;
  Eigen::Vector3d anchor_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d first_ = Eigen::Vector3d::Zero();
  std::array<int, 3> bits_{};
};

/// Finite points sorted by their cell (z, then y, then x), then index: one radix sort an axis, the
/// least important axis first, each stable.
inline search::buffer<std::uint64_t> sort_by_cell(const cloud::cloud& points,
                                                  const voxel_lattice& lattice,
                                                  unsigned threads) {
  const int index_bits = std::max(1, static_cast<int>(std::bit_width(points.size())));
  const std::uint64_t mask = (std::uint64_t{1} << index_bits) - 1;
  std::vector<std::uint64_t> finite;
  finite.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (cloud::is_finite(points.points[i])) finite.push_back(i);
  }
  search::buffer<std::uint64_t> words(finite.size());
  std::copy(finite.begin(), finite.end(), words.data());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for_each_chunk(words.size(), 1 << 16, threads, {}, [&](const chunk& c) {
      for (std::size_t w = c.begin; w < c.end; ++w) {
        const std::uint64_t i = words[w] & mask;
        words[w] = lattice.cell(i)[axis] << index_bits | i;
      }
    });
    search::radix_sort(words, {index_bits, index_bits + lattice.bits(axis)}, threads);
  }
  for (std::size_t w = 0; w < words.size(); ++w) words[w] &= mask;
  return words;
}

/// Where each voxel's points begin in the sorted list, and at the end its length.
inline std::vector<std::size_t> voxel_starts(const search::buffer<std::uint64_t>& sorted,
                                             const voxel_lattice& lattice) {
  std::vector<std::size_t> starts;
  std::array<std::uint64_t, 3> last{};
  for (std::size_t w = 0; w < sorted.size(); ++w) {
    const auto cell = lattice.cell(sorted[w]);
    if (w == 0 || cell != last) starts.push_back(w);
    last = cell;
  }
  starts.push_back(sorted.size());
  return starts;
}

/// Index of the point nearest to a position, the first among equals.
inline std::size_t nearest_of(const cloud::cloud& points,
                              std::span<const std::uint64_t> index,
                              const Eigen::Vector3d& to) {
  return *std::min_element(index.begin(), index.end(), [&](std::uint64_t a, std::uint64_t b) {
    return (points.position(a) - to).squaredNorm() < (points.position(b) - to).squaredNorm();
  });
}

/// Mean position of some points.
inline Eigen::Vector3d mean_of(const cloud::cloud& points, std::span<const std::uint64_t> index) {
  Eigen::Vector3d sum(0, 0, 0);
  for (const std::uint64_t i : index) sum += points.points[i].cast<double>();
  return points.origin + sum / static_cast<double>(index.size());
}

}  // namespace detail

inline cloud::cloud voxel(const cloud::cloud& points, const voxel_options& options) {
  const unsigned threads = options.threads == 0 ? available_threads() : options.threads;
  const detail::voxel_lattice lattice(points, options);
  const auto sorted = detail::sort_by_cell(points, lattice, threads);
  const auto starts = detail::voxel_starts(sorted, lattice);
  const std::size_t n = starts.size() - 1;
  std::vector<std::size_t> source(n);
  std::vector<Eigen::Vector3d> position(n);
  for_each_chunk(n, 4096, threads, {}, [&](const chunk& c) {
    for (std::size_t v = c.begin; v < c.end; ++v) {
      const auto members = sorted.span().subspan(starts[v], starts[v + 1] - starts[v]);
      const bool centre = options.pick == voxel_pick::centre;
      position[v] = centre ? lattice.centre(members.front()) : detail::mean_of(points, members);
      source[v] = detail::nearest_of(points, members, position[v]);
    }
  });
  cloud::cloud picked = cloud::select(points, source);
  if (options.pick == voxel_pick::nearest) return picked;
  cloud::placed_points placed =
      cloud::place(n, [&](std::size_t v) -> const Eigen::Vector3d& { return position[v]; });
  picked.origin = placed.origin;
  picked.points = std::move(placed.points);
  return picked;
}

}  // namespace aib::sample
