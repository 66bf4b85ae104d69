// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/core/random.hpp>
#include <aib/search/nearest.hpp>

#include <Eigen/Core>
#include <doctest/doctest.h>
#include <nanoflann.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

using namespace aib;
using points = std::vector<Eigen::Vector3f>;

namespace test_nearest {

namespace {

std::vector<float> brute_force(const points& from, const points& to) {
  std::vector<float> squared;
  for (const Eigen::Vector3f& p : from) {
    float best = std::numeric_limits<float>::infinity();
    for (const Eigen::Vector3f& q : to) {
      const float x = p.x() - q.x(), y = p.y() - q.y(), z = p.z() - q.z();
      best = std::min(best, (x * x + y * y) + z * z);
    }
    squared.push_back(best);
  }
  return squared;
}

/// What nanoflann asks of points.
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

std::vector<float> by_nanoflann(const points& from, const points& to) {
  using metric = nanoflann::L2_Simple_Adaptor<float, adaptor>;
  const adaptor target{to};
  const nanoflann::KDTreeSingleIndexAdaptor<metric, adaptor, 3, std::uint32_t> tree(3, target,
                                                                                    {10});
  std::vector<float> squared(from.size());
  for (std::size_t i = 0; i < from.size(); ++i) {
    std::uint32_t index = 0;
    tree.knnSearch(from[i].data(), 1, &index, &squared[i]);
  }
  return squared;
}

std::vector<float> tree_search(const points& from,
                               const points& to,
                               const search::nearest_options& options = {}) {
  const search::curve order = search::common_curve(from, to);
  const search::box_tree a(from, order, options.threads);
  const search::box_tree b(to, order, options.threads);
  return search::nearest_squared(a, b, options);
}

points make(std::size_t n, const std::function<Eigen::Vector3f(std::size_t)>& point) {
  points out;
  for (std::size_t i = 0; i < n; ++i) out.push_back(point(i));
  return out;
}

Eigen::Vector3f random_point(random_engine& random, double size) {
  const auto coordinate = [&] { return static_cast<float>(random.uniform(-size, size)); };
  const float x = coordinate(), y = coordinate(), z = coordinate();
  return {x, y, z};
}

points uniform(std::size_t n, double size, std::uint64_t seed) {
  random_engine random(seed);
  return make(n, [&](std::size_t) { return random_point(random, size); });
}

/// A wavy sheet, as a scanned surface is.
points sheet(std::size_t n, double noise, std::uint64_t seed) {
  random_engine random(seed);
  return make(n, [&](std::size_t) {
    const double u = random.uniform(-3, 3), v = random.uniform(-3, 3);
    const double w = std::sin(u) + noise * random.normal();
    return Eigen::Vector3f(static_cast<float>(u), static_cast<float>(v), static_cast<float>(w));
  });
}

points lattice(int side, float shift) {
  return make(static_cast<std::size_t>(side * side * side), [&](std::size_t i) {
    const int k = static_cast<int>(i);
    return Eigen::Vector3f(static_cast<float>(k % side) + shift,
                           static_cast<float>(k / side % side),
                           static_cast<float>(k / side / side));
  });
}

void check_equal(const points& a, const points& b) {
  CHECK(tree_search(a, b) == brute_force(a, b));
  CHECK(tree_search(b, a) == brute_force(b, a));
}

}  // namespace

TEST_CASE("nearest neighbours equal brute force bit for bit, whatever the number of points") {
  for (const std::size_t n : {1u, 2u, 15u, 16u, 17u, 127u, 128u, 129u, 255u, 256u, 257u, 3000u}) {
    CAPTURE(n);
    check_equal(uniform(n, 5, n), uniform(777, 5, 1));
  }
}

TEST_CASE("nearest neighbours equal brute force on surfaces, with strays and holes") {
  const points reference = sheet(6000, 0, 1);
  points estimate = sheet(5000, 0.01, 2);
  for (int i = 0; i < 300; ++i) estimate.push_back(uniform(1, 8, static_cast<std::uint64_t>(i))[0]);
  check_equal(estimate, reference);
  std::erase_if(estimate, [](const Eigen::Vector3f& p) { return p.x() > 0 && p.y() > 0; });
  check_equal(estimate, reference);
}

TEST_CASE("points very far away change nothing for the others") {
  points estimate = sheet(4000, 0.01, 3);
  for (int i = 0; i < 20; ++i) {
    estimate.push_back(Eigen::Vector3f(1e5f, -2e5f, 3e5f) * static_cast<float>(i + 1));
  }
  estimate.push_back({3e38f, -3e38f, 3e38f});
  check_equal(estimate, sheet(4000, 0, 4));
}

TEST_CASE("ties, duplicates and degenerate clouds") {
  SUBCASE("a lattice against itself moved by half a cell") {
    check_equal(lattice(14, 0), lattice(14, 0.5f));
  }
  SUBCASE("a cloud against itself") {
    const points p = sheet(3000, 0.1, 5);
    const auto squared = tree_search(p, p);
    CHECK(std::all_of(squared.begin(), squared.end(), [](float d) { return d == 0; }));
  }
  SUBCASE("all points equal") { check_equal(points(2000, {1, 2, 3}), points(300, {1, 2, 4})); }
  SUBCASE("on a line") {
    random_engine random(9);
    const auto on_line = [&](std::size_t) {
      return Eigen::Vector3f(static_cast<float>(random.uniform(0, 100)), 0, 0);
    };
    check_equal(make(3000, on_line), make(2000, on_line));
  }
  SUBCASE("duplicates among others") {
    points p = sheet(1000, 0, 6);
    p.insert(p.end(), 5000, p[17]);
    check_equal(p, sheet(1500, 0, 7));
  }
  SUBCASE("clouds far apart") {
    points p = sheet(2000, 0, 8);
    for (auto& q : p) q.x() += 1000;
    check_equal(p, sheet(2000, 0, 9));
  }
}

TEST_CASE("the same bits for any number of threads") {
  const points a = sheet(40000, 0.02, 10);
  const points b = sheet(30000, 0, 11);
  const auto one = tree_search(a, b, {.threads = 1});
  CHECK(one == tree_search(a, b, {.threads = 2}));
  CHECK(one == tree_search(a, b, {.threads = 5}));
}

TEST_CASE("a bounded search gives the bound where nothing is nearer") {
  const points a = uniform(3000, 5, 12);
  const points b = uniform(500, 5, 13);
  const float bound = 0.3f;
  auto expected = brute_force(a, b);
  for (float& d : expected) d = std::min(d, bound);
  CHECK(tree_search(a, b, {.squared_bound = bound}) == expected);
}

TEST_CASE("the tree costs at most 20 bytes a point") {
  const points p = uniform(100000, 1, 14);
  const search::box_tree tree(p, search::common_curve(p, p));
  CHECK(tree.bytes() <= 20 * p.size());
}

TEST_CASE("nearest neighbours equal nanoflann's, many points, also in map coordinates") {
  points estimate = sheet(30000, 0.01, 12);
  const points reference = sheet(40000, 0, 13);
  for (int i = 0; i < 1500; ++i)
    estimate.push_back(uniform(1, 8, static_cast<std::uint64_t>(i))[0]);
  CHECK(tree_search(estimate, reference) == by_nanoflann(estimate, reference));
  CHECK(tree_search(reference, estimate) == by_nanoflann(reference, estimate));
  const Eigen::Vector3f utm(458000, 5429000, 160);  // in float: many ties, half a metre apart
  points far_estimate = estimate, far_reference = reference;
  for (auto& p : far_estimate) p += utm;
  for (auto& p : far_reference) p += utm;
  CHECK(tree_search(far_estimate, far_reference) == by_nanoflann(far_estimate, far_reference));
}

}  // namespace test_nearest
