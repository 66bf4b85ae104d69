// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/compare.hpp>
#include <aib/core/error.hpp>
#include <aib/core/executor.hpp>
#include <aib/core/isa.hpp>
#include <aib/search/nearest.hpp>
#include <aib/stream/partition.hpp>
#include <aib/stream/spill.hpp>
#include <aib/stream/stored_distances.hpp>
#include <aib/stream/tiled_cloud.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace aib::stream {

struct compare_clouds_options {
  std::uint64_t memory = std::uint64_t{2} << 30;  ///< bytes that the search may take
  std::filesystem::path folder = {};  ///< for what is spilled; the system's temporary one
  cloud::compare_options compare = {};
};

inline namespace AIB_ISA {

namespace tiles {

/// Bytes that a point of a slice takes, as a query and as a target: itself, its index, its tree and
/// what sorting takes.
inline constexpr std::uint64_t bytes_a_point = 140;

/// More tiles would take too many open files; they are then searched in slices.
inline constexpr int most_cuts = 7;

/// Searches the queries of one cloud in the tiles of another.
class search_pass {
 public:
  search_pass(tiled_cloud& targets,
              std::size_t slice,
              float squared_bound,
              const compare_clouds_options& options)
      : targets_(targets), slice_(slice), bound_(squared_bound), options_(options) {}

  /// Squared distance of each query: tiles that may have something nearer, nearest tile first.
  [[nodiscard]] std::vector<float> nearest(std::span<const Eigen::Vector3f> queries) {
    std::vector<float> best(queries.size(), bound_);
    float_box box;
    for (const Eigen::Vector3f& q : queries) box.add(triple(q));
    for (const std::size_t t : by_distance(box)) visit(targets_.tiles[t], queries, best);
    return best;
  }

  static point triple(const Eigen::Vector3f& p) { return {p.x(), p.y(), p.z()}; }

 private:
  /// Tiles that have points, from the one whose box is nearest to the middle of a box.
  [[nodiscard]] std::vector<std::size_t> by_distance(const float_box& box) const {
    point middle;
    for (std::size_t k = 0; k < 3; ++k) middle[k] = box.low[k] / 2 + box.high[k] / 2;
    std::vector<std::pair<float, std::size_t>> order;
    for (std::size_t t = 0; t < targets_.tiles.size(); ++t) {
      const tile& candidate = targets_.tiles[t];
      if (candidate.points.size() > 0)
        order.emplace_back(candidate.box.squared_distance(middle), t);
    }
    std::sort(order.begin(), order.end());
    std::vector<std::size_t> index;
    for (const auto& [distance, t] : order) index.push_back(t);
    return index;
  }

  void visit(tile& target, std::span<const Eigen::Vector3f> queries, std::vector<float>& best) {
    std::vector<std::uint32_t> asked;
    std::vector<Eigen::Vector3f> asking;
    float_box box;
    float farthest = 0;
    for (std::size_t i = 0; i < queries.size(); ++i) {
      if (!(target.box.squared_distance(triple(queries[i])) < best[i])) continue;
      asked.push_back(static_cast<std::uint32_t>(i));
      asking.push_back(queries[i]);
      box.add(triple(queries[i]));
      farthest = std::max(farthest, best[i]);
    }
    if (asked.empty()) return;
    std::vector<Eigen::Vector3f> points;
    for (std::uint64_t first = 0; first < target.points.size(); first += slice_) {
      read(target, first, slice_, points);
      std::erase_if(points, [&](const Eigen::Vector3f& p) {
        return !(box.squared_distance(triple(p)) < farthest);  // nearer to none
      });
      if (points.empty()) continue;
      const auto found = search(asking, points);
      for (std::size_t i = 0; i < asked.size(); ++i)
        best[asked[i]] = std::min(best[asked[i]], found[i]);
    }
  }

  [[nodiscard]] std::vector<float> search(std::span<const Eigen::Vector3f> queries,
                                          std::span<const Eigen::Vector3f> points) const {
    const aib::search::curve order = aib::search::common_curve(queries, points);
    const unsigned threads = options_.compare.threads;
    const control stop{.stop = options_.compare.control.stop};
    const aib::search::box_tree a(queries, order, threads, stop);
    const aib::search::box_tree b(points, order, threads, stop);
    return aib::search::nearest_squared(
        a, b, {.squared_bound = bound_, .threads = threads, .control = stop});
  }

 public:
  /// Up to `most` points of a tile from `first` on.
  static void read(tile& t,
                   std::uint64_t first,
                   std::size_t most,
                   std::vector<Eigen::Vector3f>& points) {
    const auto n = static_cast<std::size_t>(std::min<std::uint64_t>(t.points.size() - first, most));
    std::vector<point> triples(n);
    t.points.read(first, triples);
    points.resize(n);
    for (std::size_t i = 0; i < n; ++i) points[i] = {triples[i][0], triples[i][1], triples[i][2]};
  }

 private:
  tiled_cloud& targets_;
  std::size_t slice_;
  float bound_;
  const compare_clouds_options& options_;
};

/// Distances that come tile by tile, put in the order of the file.
inline stored_distances in_file_order(tiled_cloud& queries,
                                      spill<float>& by_tile,
                                      const compare_clouds_options& options,
                                      const cloud::distance_options& how) {
  constexpr std::size_t block = 4096;
  struct cursor {
    std::uint64_t next, end;
    std::vector<float> values;
    std::size_t at = 0;
  };
  std::vector<cursor> cursors;
  std::uint64_t first = 0;
  for (const tile& t : queries.tiles) {
    cursors.push_back({first, first + t.points.size(), {}});
    first += t.points.size();
  }
  const auto take = [&](cursor& c) {
    if (c.at == c.values.size()) {
      c.values.resize(static_cast<std::size_t>(std::min<std::uint64_t>(block, c.end - c.next)));
      by_tile.read(c.next, c.values);
      c.next += c.values.size();
      c.at = 0;
    }
    return c.values[c.at++];
  };
  stored_distances stored(options.folder, how);
  std::vector<std::uint16_t> tile_of;
  for (std::uint64_t i = 0; i < queries.tile_of.size(); i += tile_of.size()) {
    demand_go(options.compare.control);
    tile_of.resize(static_cast<std::size_t>(
        std::min<std::uint64_t>(queries.tile_of.size() - i, cloud::detail::value_chunk)));
    queries.tile_of.read(i, tile_of);
    for (const std::uint16_t t : tile_of) {
      stored.append(t == tiled_cloud::nowhere ? std::numeric_limits<float>::quiet_NaN()
                                              : std::sqrt(take(cursors[t])));
    }
  }
  stored.finish();
  return stored;
}

/// How far the searches of both directions are.
struct progress {
  const control& watched;
  std::uint64_t total;
  std::uint64_t done = 0;

  void add(std::uint64_t n) {
    done += n;
    if (watched.progress) watched.progress(static_cast<double>(done) / static_cast<double>(total));
  }
};

inline stored_distances distances(tiled_cloud& queries,
                                  tiled_cloud& targets,
                                  std::size_t slice,
                                  const compare_clouds_options& options,
                                  const cloud::distance_options& how,
                                  progress& progress) {
  search_pass search(targets, slice, cloud::detail::squared_bound(how), options);
  spill<float> by_tile(options.folder);
  std::vector<Eigen::Vector3f> points;
  for (tile& t : queries.tiles) {
    for (std::uint64_t first = 0; first < t.points.size(); first += points.size()) {
      search_pass::read(t, first, slice, points);
      by_tile.append(std::span<const float>(search.nearest(points)));
      progress.add(points.size());
    }
  }
  return in_file_order(queries, by_tile, options, how);
}

inline void demand_points(const tiled_cloud& c, const char* which, const cloud_file& file) {
  if (c.n_finite > 0) return;
  throw undefined_error(message("stream::compare_clouds: no finite point in the ", which,
                                " cloud (", file.size, " points)"));
}

}  // namespace tiles

/// Compares clouds that need not fit in memory: what cloud::compare says of the same files, bit for
/// bit.
///
/// estimate, reference   binary PLY files
///
/// Both are cut into tiles by planes and spilled; a tile is searched in its counterpart, and its
/// points near enough to another tile in that as well. Spilled files have no names: nothing stays
/// behind, whatever happens. Disk: about 44 bytes a point of both.
///
/// Throws undefined_error if either cloud has no finite point, argument_error if a tau is above
/// max_distance or memory below 16 MB, format_error where a file is no binary PLY.
[[nodiscard]] inline cloud::comparison compare_clouds(const std::filesystem::path& estimate,
                                                      const std::filesystem::path& reference,
                                                      compare_clouds_options options = {}) {
  constexpr std::uint64_t least = 16 << 20;
  if (options.memory < least) {
    throw argument_error(message("stream::compare_clouds: memory of ", least,
                                 " bytes or more expected, found ", options.memory));
  }
  if (options.folder.empty()) options.folder = std::filesystem::temp_directory_path();
  const cloud::compare_options& c = options.compare;
  const cloud::distance_options how{
      .max_distance = c.max_distance, .rule = c.rule, .threads = c.threads, .control = c.control};
  cloud::detail::check_maximum(how);
  for (const double tau : c.tau) cloud::detail::check_tau(tau, how);
  const cloud_file e = open_cloud(estimate, c.control), r = open_cloud(reference, c.control);
  const auto slice = static_cast<std::size_t>(options.memory / 2 / tiles::bytes_a_point);
  const auto needed = static_cast<int>(std::bit_width(std::max(e.size, r.size) / slice));
  std::vector<point> sample;
  constexpr std::uint64_t sampled = 100'000;
  add_sample(e, r.origin, sampled, c.control, sample);
  add_sample(r, r.origin, sampled, c.control, sample);
  const partition cuts(std::move(sample), std::min(tiles::most_cuts, needed));
  tiled_cloud est(e, r.origin, cuts, options.folder, c.control);
  tiled_cloud ref(r, r.origin, cuts, options.folder, c.control);
  tiles::demand_points(est, "estimated", e);
  tiles::demand_points(ref, "reference", r);
  tiles::progress progress{c.control, est.n_finite + ref.n_finite};
  const auto to_reference = tiles::distances(est, ref, slice, options, how, progress);
  const auto to_estimate = tiles::distances(ref, est, slice, options, how, progress);
  return cloud::score(to_reference, to_estimate, c.tau);
}

}  // namespace AIB_ISA
}  // namespace aib::stream
