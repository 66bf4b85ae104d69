// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/pose/trajectory.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>
#include <queue>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

namespace aib::pose {

enum class match_by { name, stamp, index };

/// How often a pose may be matched.
enum class association_rule {
  one_to_one,
  evo,  ///< each pose of the shorter trajectory takes its nearest stamp, taken or not
};

struct associate_options {
  match_by by = match_by::name;
  double max_gap_s = 0.01;        ///< stamps: largest difference, inclusive
  double offset_s = 0;            ///< stamps: added to those of the estimate
  bool ignore_case = false;       ///< names: IMG_1.jpg is img_1.jpg
  bool ignore_extension = false;  ///< names: 0001.png is 0001.exr
  bool ignore_folder = false;     ///< names: images/0001.png is 0001.png
  association_rule rule = association_rule::one_to_one;
};

/// Poses that belong together, and what was left out.
struct association {
  trajectory estimate;                      ///< in the order of the reference (evo: of the shorter)
  trajectory reference;                     ///< as long
  std::vector<std::size_t> estimate_index;  ///< where each pose stood
  std::vector<std::size_t> reference_index;  ///< where each pose stood
  std::size_t n_matched;
  std::size_t n_estimate_only;   ///< poses of the estimate without a partner
  std::size_t n_reference_only;  ///< poses of the reference without a partner
};

/// Pairs the poses of an estimate with those of a reference: by image name, by the nearest time
/// stamp (closest pairs first, each pose once), or by position in the list.
///
/// Throws argument_error if names (stamps) are missing or not unique under the rules,
/// undefined_error if no pose matches; it says which rule on names would have helped.
association associate(const trajectory& estimate,
                      const trajectory& reference,
                      const associate_options& options = {});

namespace detail {

struct index_pair {
  std::size_t estimate;
  std::size_t reference;
};

inline std::string name_key(std::string_view name, const associate_options& rules) {
  if (rules.ignore_folder) {
    const std::size_t slash = name.find_last_of("/\\");
    if (slash != std::string_view::npos) name.remove_prefix(slash + 1);
  }
  if (rules.ignore_extension) {
    const std::size_t slash = name.find_last_of("/\\"), dot = name.find_last_of('.');
    const std::size_t stem = slash == std::string_view::npos ? 0 : slash + 1;
    if (dot != std::string_view::npos && dot > stem) name = name.substr(0, dot);
  }
  std::string key(name);
  if (rules.ignore_case) {
    for (char& c : key) {
      if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
  }
  return key;
}

inline std::unordered_map<std::string, std::size_t> name_table(std::string_view whose,
                                                               const trajectory& t,
                                                               const associate_options& rules) {
  std::unordered_map<std::string, std::size_t> table;
  for (std::size_t i = 0; i < t.names.size(); ++i) {
    const auto [at, fresh] = table.emplace(name_key(t.names[i], rules), i);
    if (fresh) continue;
    throw argument_error(message("associate: two poses of the ", whose, " have one name: \"",
                                 t.names[at->second], "\" and \"", t.names[i], "\""));
  }
  return table;
}

inline std::vector<index_pair> match_names(const trajectory& estimate,
                                           const trajectory& reference,
                                           const associate_options& options) {
  if (estimate.names.size() != estimate.size() || reference.names.size() != reference.size())
    throw argument_error("associate: by name, but not every pose has one; try stamp or index");
  const auto table = name_table("estimate", estimate, options);
  name_table("reference", reference, options);
  std::vector<index_pair> pairs;
  for (std::size_t r = 0; r < reference.size(); ++r) {
    const auto at = table.find(name_key(reference.names[r], options));
    if (at != table.end()) pairs.push_back({at->second, r});
  }
  return pairs;
}

/// Indices of stamps in ascending order, equal ones in their own order.
inline std::vector<std::size_t> by_stamp(const std::vector<double>& stamps) {
  std::vector<std::size_t> order(stamps.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return stamps[a] < stamps[b]; });
  return order;
}

/// A sorted list whose places are taken one after another.
class free_places {
 public:
  explicit free_places(std::size_t n) : left_(n + 1), right_(n + 1) {
    std::iota(left_.begin(), left_.end(), std::size_t{0});
    std::iota(right_.begin(), right_.end(), std::size_t{0});
  }
  /// Nearest free place at or above i; the length where there is none.
  std::size_t at_or_above(std::size_t i) { return root(right_, i); }
  /// One more than the nearest free place below i; 0 where there is none.
  std::size_t end_below(std::size_t i) { return root(left_, i); }
  void take(std::size_t i) {
    right_[i] = i + 1;
    left_[i + 1] = i;
  }

 private:
  static std::size_t root(std::vector<std::size_t>& parent, std::size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  }
  std::vector<std::size_t> left_, right_;
};

/// Pairs in ascending order of their gap, each stamp once.
inline std::vector<index_pair> match_stamps(const std::vector<double>& estimate,
                                            const std::vector<double>& reference,
                                            const associate_options& options) {
  const std::vector<std::size_t> order = by_stamp(reference);
  struct candidate {
    double gap;
    std::size_t place, estimate;
    bool operator>(const candidate& o) const {
      if (gap != o.gap) return gap > o.gap;
      return place != o.place ? place > o.place : estimate > o.estimate;
    }
  };
  std::priority_queue<candidate, std::vector<candidate>, std::greater<>> nearest;
  free_places places(order.size());
  const auto offer = [&](std::size_t e, std::size_t place) {
    const double gap = std::abs(reference[order[place]] - (estimate[e] + options.offset_s));
    if (gap <= options.max_gap_s) nearest.push({gap, place, e});
  };
  const auto place_of = [&](std::size_t e) {
    const auto at =
        std::lower_bound(order.begin(), order.end(), estimate[e] + options.offset_s,
                         [&](std::size_t r, double stamp) { return reference[r] < stamp; });
    return static_cast<std::size_t>(at - order.begin());
  };
  const auto offer_neighbours = [&](std::size_t e) {
    const std::size_t above = places.at_or_above(place_of(e)),
                      below = places.end_below(place_of(e));
    if (above < order.size()) offer(e, above);
    if (below > 0) offer(e, below - 1);
  };
  for (std::size_t e = 0; e < estimate.size(); ++e) offer_neighbours(e);
  std::vector<bool> matched(estimate.size());
  std::vector<index_pair> pairs;
  while (!nearest.empty()) {
    const candidate c = nearest.top();
    nearest.pop();
    if (matched[c.estimate]) continue;
    if (places.at_or_above(c.place) != c.place) {  // taken meanwhile
      offer_neighbours(c.estimate);
      continue;
    }
    places.take(c.place);
    matched[c.estimate] = true;
    pairs.push_back({c.estimate, order[c.place]});
  }
  std::sort(pairs.begin(), pairs.end(),
            [](const index_pair& a, const index_pair& b) { return a.reference < b.reference; });
  return pairs;
}

/// evo's core/sync.py: every stamp of the shorter list, nearest one of the longer, repetitions
/// kept.
inline std::vector<index_pair> match_stamps_as_evo(const std::vector<double>& estimate,
                                                   const std::vector<double>& reference,
                                                   const associate_options& options) {
  const bool estimate_longer = estimate.size() > reference.size();
  const auto& shorter = estimate_longer ? reference : estimate;
  const auto& longer = estimate_longer ? estimate : reference;
  const double offset = estimate_longer ? options.offset_s : -options.offset_s;
  const std::vector<std::size_t> order = by_stamp(longer);
  std::vector<index_pair> pairs;
  for (std::size_t s = 0; s < shorter.size(); ++s) {
    std::optional<std::size_t> best;
    double best_gap = std::numeric_limits<double>::infinity();
    const auto at =
        std::lower_bound(order.begin(), order.end(), shorter[s] - offset,
                         [&](std::size_t l, double stamp) { return longer[l] < stamp; });
    const auto begin = at - std::min<std::ptrdiff_t>(at - order.begin(), 2);
    const auto end = at + std::min<std::ptrdiff_t>(order.end() - at, 2);
    for (auto l = begin; l != end; ++l) {
      const double gap = std::abs(shorter[s] - (longer[*l] + offset));
      if (gap < best_gap || (gap == best_gap && *l < *best)) {
        best = *l;
        best_gap = gap;
      }
    }
    if (!best || !(best_gap <= options.max_gap_s)) continue;
    pairs.push_back(estimate_longer ? index_pair{*best, s} : index_pair{s, *best});
  }
  return pairs;
}

inline std::vector<index_pair> match_stamps(const trajectory& estimate,
                                            const trajectory& reference,
                                            const associate_options& options) {
  if (estimate.stamps_s.size() != estimate.size() || reference.stamps_s.size() != reference.size())
    throw argument_error("associate: by stamp, but not every pose has one; try name or index");
  for (const auto* stamps : {&estimate.stamps_s, &reference.stamps_s}) {
    for (const double s : *stamps) {
      if (!std::isfinite(s)) throw argument_error("associate: a stamp is not finite");
    }
  }
  return options.rule == association_rule::evo
             ? match_stamps_as_evo(estimate.stamps_s, reference.stamps_s, options)
             : match_stamps(estimate.stamps_s, reference.stamps_s, options);
}

inline std::vector<index_pair> match_indices(std::size_t n) {
  std::vector<index_pair> pairs;
  for (std::size_t i = 0; i < n; ++i) pairs.push_back({i, i});
  return pairs;
}

/// What a user may try who got nothing.
inline std::string advice(const trajectory& estimate,
                          const trajectory& reference,
                          const associate_options& options) {
  if (options.by == match_by::stamp)
    return message("; stamps within ", options.max_gap_s, " s expected");
  if (options.by == match_by::index) return "";
  const std::string names = estimate.empty() || reference.empty()
                                ? ""
                                : message(", \"", estimate.names.front(), "\" in the one, \"",
                                          reference.names.front(), "\" in the other");
  associate_options loose = options;
  loose.ignore_case = loose.ignore_extension = loose.ignore_folder = true;
  std::unordered_map<std::string, std::size_t> table;
  for (const std::string& name : estimate.names) table.emplace(name_key(name, loose), 0);
  std::size_t n = 0;
  for (const std::string& name : reference.names) n += table.count(name_key(name, loose));
  if (n == 0) return names;
  return message(names, "; ignore_folder, ignore_extension and ignore_case would match ", n);
}

inline std::size_t distinct(std::vector<std::size_t> indices) {
  std::sort(indices.begin(), indices.end());
  return static_cast<std::size_t>(std::unique(indices.begin(), indices.end()) - indices.begin());
}

}  // namespace detail

inline association associate(const trajectory& estimate,
                             const trajectory& reference,
                             const associate_options& options) {
  check(estimate);
  check(reference);
  if (!(options.max_gap_s >= 0))
    throw argument_error(message("associate: max_gap >= 0 expected, found ", options.max_gap_s));
  const std::vector<detail::index_pair> pairs =
      options.by == match_by::name ? detail::match_names(estimate, reference, options)
      : options.by == match_by::stamp
          ? detail::match_stamps(estimate, reference, options)
          : detail::match_indices(std::min(estimate.size(), reference.size()));
  if (pairs.empty()) {
    throw undefined_error(message(
        "associate: none of ", estimate.size(), " estimated poses matches one of ",
        reference.size(), " reference poses", detail::advice(estimate, reference, options)));
  }
  std::vector<std::size_t> e, r;
  for (const detail::index_pair& p : pairs) {
    e.push_back(p.estimate);
    r.push_back(p.reference);
  }
  association out{.estimate = select(estimate, e),
                  .reference = select(reference, r),
                  .estimate_index = e,
                  .reference_index = r,
                  .n_matched = pairs.size(),
                  .n_estimate_only = estimate.size() - detail::distinct(e),
                  .n_reference_only = reference.size() - detail::distinct(r)};
  if (options.by == match_by::name) out.estimate.names = out.reference.names;
  return out;
}

}  // namespace aib::pose
