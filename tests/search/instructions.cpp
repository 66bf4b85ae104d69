// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT

// instructions aib|nanoflann|none: makes two clouds of 100 000 points, finds nearest neighbours in
// both directions with one thread, prints the sum of the distances. Run by instructions.py.
#include <aib/core/random.hpp>
#include <aib/search/nearest.hpp>

#include <Eigen/Core>
#include <nanoflann.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

namespace {

using points = std::vector<Eigen::Vector3f>;

/// A wavy sheet of 60 by 60 with noise and five per cent of strays, in random order.
points sheet(std::size_t n, double noise, std::uint64_t seed) {
  aib::random_engine random(seed);
  points p;
  for (std::size_t i = 0; i < n; ++i) {
    const bool stray = noise > 0 && random.uniform() < 0.05;
    const double x = random.uniform(0, 60), y = random.uniform(0, 60);
    const double z = stray ? random.uniform(-10, 10) : std::sin(x) + noise * random.normal();
    p.emplace_back(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
  }
  return p;
}

double sum_of_roots(const std::vector<float>& squared) {
  double sum = 0;
  for (const float d : squared) sum += std::sqrt(d);
  return sum;
}

double by_aib(const points& a, const points& b) {
  const auto order = aib::search::common_curve(a, b);
  const aib::search::box_tree a_tree(a, order, 1), b_tree(b, order, 1);
  return sum_of_roots(aib::search::nearest_squared(a_tree, b_tree, {.threads = 1})) +
         sum_of_roots(aib::search::nearest_squared(b_tree, a_tree, {.threads = 1}));
}

struct adaptor {
  const points& p;
  [[nodiscard]] std::size_t kdtree_get_point_count() const { return p.size(); }
  [[nodiscard]] float kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return p[i][static_cast<Eigen::Index>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

double one_way(const points& from, const points& to) {
  using metric = nanoflann::L2_Simple_Adaptor<float, adaptor>;
  const adaptor target{to};
  const nanoflann::KDTreeSingleIndexAdaptor<metric, adaptor, 3, std::uint32_t> tree(3, target,
                                                                                    {10});
  std::vector<float> squared(from.size());
  for (std::size_t i = 0; i < from.size(); ++i) {
    std::uint32_t index = 0;
    tree.knnSearch(from[i].data(), 1, &index, &squared[i]);
  }
  return sum_of_roots(squared);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  const points a = sheet(100'000, 0.01, 1), b = sheet(100'000, 0, 2);
  double sum = 0;
  if (what == "aib") sum = by_aib(a, b);
  if (what == "nanoflann") sum = one_way(a, b) + one_way(b, a);
  std::printf("%.6f\n", sum);
}
