// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/cloud/distances.hpp>

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <typeinfo>
#include <vector>

using namespace aib;

namespace test_distances {

namespace {

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

cloud::cloud of(std::vector<Eigen::Vector3f> points) { return {.points = std::move(points)}; }

}  // namespace

TEST_CASE("distances keep the order of the points and are summed up") {
  const auto a = of({{0, 0, 0}, {0, 3, 4}, {1, 0, 0}, {0, 0, 2}});
  const cloud::distances d(a, of({{0, 0, 0}}));
  CHECK(std::vector<float>(d.values().begin(), d.values().end()) == std::vector<float>{0, 5, 1, 2});
  CHECK(d.mean() == 2);
  CHECK(d.median() == 1.5);
  CHECK(d.max() == 5);
  CHECK(d.rmse() == doctest::Approx(std::sqrt(30 / 4.0)));
  CHECK(d.quantile(0) == 0);
  CHECK(d.quantile(1) == 5);
}

TEST_CASE("a share counts what is strictly below") {
  const auto a = of({{0.25f, 0, 0}, {0.5f, 0, 0}});
  const cloud::distances d(a, of({{0, 0, 0}}));
  CHECK(d.share_below(0.25) == 0);
  CHECK(d.share_below(0.2500001) == 0.5);
  CHECK(d.share_below(1) == 1);
}

TEST_CASE("points that are not finite are dropped and counted") {
  const auto a = of({{1, 0, 0}, {not_a_number, 0, 0}, {3, 0, 0}});
  const auto b = of({{0, 0, 0}, {0, std::numeric_limits<float>::infinity(), 0}});
  const cloud::distances d(a, b);
  CHECK(d.n_dropped() == 1);
  CHECK(d.n_finite() == 2);
  CHECK(std::isnan(d[1]));
  CHECK(d[2] == 3);
  CHECK(d.mean() == 2);
  CHECK(d.median() == 2);
  CHECK(d.share_below(2) == 0.5);
}

TEST_CASE("beyond the maximum a distance is dropped or clamped, as asked") {
  const auto a = of({{1, 0, 0}, {2, 0, 0}, {5, 0, 0}, {not_a_number, 0, 0}});
  const auto b = of({{0, 0, 0}});
  SUBCASE("drop") {
    const cloud::distances d(a, b, {.max_distance = 2});
    CHECK(d.mean() == 1);
    CHECK(d.max() == 1);
    CHECK(d.median() == 1);
    CHECK(d.n_beyond() == 2);
    CHECK(d.share_beyond() == doctest::Approx(2 / 3.0));
    CHECK(d.share_below(1.5) == doctest::Approx(1 / 3.0));
  }
  SUBCASE("clamp") {
    const cloud::distances d(a, b, {.max_distance = 2, .rule = cloud::maximum_rule::clamp});
    CHECK(d.mean() == doctest::Approx(5 / 3.0));
    CHECK(d.max() == 2);
    CHECK(d.median() == 2);
    CHECK(d.n_beyond() == 2);
  }
  SUBCASE("nothing is left") {
    const cloud::distances d(a, b, {.max_distance = 0.5});
    CHECK_THROWS_WITH_AS(static_cast<void>(d.mean()),
                         "cloud::distances: no distance to take the mean of (4 points, 1 not "
                         "finite, 3 beyond max_distance)",
                         undefined_error);
    CHECK(d.share_beyond() == 1);
  }
  CHECK_THROWS_AS(cloud::distances(a, b, {.max_distance = 0}), argument_error);
  const cloud::distances near(a, b, {.max_distance = 1});
  CHECK_THROWS_AS(static_cast<void>(near.share_below(2)), argument_error);
}

TEST_CASE("a distance to or from nothing is undefined") {
  const auto a = of({{1, 0, 0}});
  CHECK_THROWS_WITH_AS(cloud::distances(of({}), a),
                       "cloud::distances: no finite point in the first cloud (0 points, 0 not "
                       "finite)",
                       undefined_error);
  CHECK_THROWS_WITH_AS(cloud::distances(a, of({{not_a_number, 0, 0}})),
                       "cloud::distances: no finite point in the second cloud (1 points, 1 not "
                       "finite)",
                       undefined_error);
}

TEST_CASE("clouds of different origins meet in double") {
  cloud::cloud a = of({{0.25f, 0, 0}});
  a.origin = {458074, 5429380, 162};
  cloud::cloud b = of({{0, 0, 0.5f}});
  b.origin = {458074.5, 5429380, 162};
  const double expected = std::sqrt(0.25 * 0.25 + 0.5 * 0.5);
  CHECK(cloud::distances(a, b).mean() == doctest::Approx(expected).epsilon(1e-7));
}

TEST_CASE("ranges of foreign points become clouds") {
  const std::vector<std::array<double, 3>> p{{458074.25, 5429380.5, 162},
                                             {458075.25, 5429380.5, 162}};
  const cloud::cloud c = cloud::from_points(p);
  CHECK(c.position(0) == Eigen::Vector3d(458074.25, 5429380.5, 162));
  CHECK(c.position(1) == Eigen::Vector3d(458075.25, 5429380.5, 162));
  CHECK(cloud::from_points(std::vector<Eigen::Vector3f>{{1, 2, 3}}).origin ==
        Eigen::Vector3d(0, 0, 0));
}

TEST_CASE("a few strays, however far, do not blur the other points") {
  for (const Eigen::Vector3d& place :
       {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(4.5e5, 5.4e6, 100)}) {
    std::vector<Eigen::Vector3d> positions;
    for (int i = 0; i < 5000; ++i) positions.push_back(place + Eigen::Vector3d(0.01 * i, 7.123, 2));
    for (const double far : {1e5, -1e9, 1e15}) positions.insert(positions.begin(), {far, far, 0});
    positions.push_back({NAN, 0, 0});
    const cloud::cloud c = cloud::from_points(positions);
    for (std::size_t i = 3; i + 1 < c.size(); ++i)
      REQUIRE((c.position(i) - positions[i]).norm() < 1e-5);
    CHECK(c.position(2).x() == doctest::Approx(1e5));
  }
}

TEST_CASE("shares below many thresholds are those below each") {
  const cloud::cloud from{.points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {5, 0, 0}}};
  const cloud::cloud to{.points = {{0, 0, 0}}};
  const cloud::distances d(from, to);
  const std::vector<double> tau{2, 0.5, 9, 1, 2};
  CHECK(d.shares_below(tau) == std::vector<double>{0.5, 0.25, 1, 0.25, 0.5});
  for (const double t : tau) CHECK(d.share_below(t) == d.shares_below(std::span(&t, 1))[0]);
  const auto counts = d.histogram(4, 4);
  CHECK(counts.counts() == std::vector<std::uint64_t>{1, 1, 1, 0});
  CHECK(counts.above() == 1);
}

TEST_CASE("what searches is named after the instruction set, for units of different ones") {
  const std::string name = typeid(cloud::distances).name();
  CHECK(name.find(instruction_set) != std::string::npos);
}

}  // namespace test_distances
