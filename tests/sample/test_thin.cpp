// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/cloud/neighbours.hpp>
#include <aib/core/random.hpp>
#include <aib/sample/eliminate.hpp>
#include <aib/sample/mesh.hpp>
#include <aib/sample/thin.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <support/stopped.hpp>

using namespace aib;

namespace test_thin {

namespace {

mesh::mesh square() {
  mesh::mesh m;
  m.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  m.triangles = {{0, 1, 2}, {0, 2, 3}};
  m.labels = {4, 5};
  return m;
}

/// The least distance between two points.
double closest_pair(const cloud::cloud& c) {
  const cloud::neighbours search(c);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < c.size(); ++i) {
    least = std::min(least, search.nearest(c.position(i), 2)[1].distance);
  }
  return least;
}

}  // namespace

TEST_CASE("thinned points keep their distance, and nothing is left without one") {
  cloud::cloud many = sample::mesh(square(), {.n = 20000}).points;
  many.points[7].x() = std::numeric_limits<float>::quiet_NaN();
  const auto few = sample::thin(many, {.spacing = 0.05});
  CHECK(closest_pair(few) > 0.05);
  CHECK(cloud::distances(many, few).max() <= 0.05);
  CHECK(few.labels.size() == few.size());
  CHECK(sample::thin(many, {.spacing = 0.05}).points == few.points);
  CHECK(sample::thin(many, {.spacing = 0.05, .seed = 2}).points != few.points);
  CHECK(sample::thin({.points = {{0, 0, 0}, {0, 0, 0}}}, {.spacing = 1e-3}).size() == 1);
  CHECK(sample::thin({}, {.spacing = 1}).empty());
  CHECK_THROWS_AS((void)sample::thin(many, {}), argument_error);
}

TEST_CASE("a Poisson-disk sample of n points is n points, spread evenly") {
  using enum sample::spread;
  const auto even = sample::mesh(square(), {.n = 500, .method = poisson});
  const auto random = sample::mesh(square(), {.n = 500});
  CHECK(even.points.size() == 500);
  const double widest = std::sqrt(2 / (std::sqrt(3.0) * 500));  // of a hexagonal lattice
  CHECK(closest_pair(even.points) > 0.6 * widest);
  CHECK(closest_pair(random.points) < 0.2 * widest);
  CHECK(even.floor < 0.9 * random.floor);
  CHECK(even.points.labels.size() == 500);
  CHECK(sample::mesh(square(), {.per_area = 200.0, .method = poisson}).points.size() == 200);
  CHECK(sample::mesh(square(), {.n = 500, .method = poisson, .threads = 1}).points.points ==
        even.points.points);
}

TEST_CASE("a Poisson-disk sample of a spacing has none nearer") {
  const auto s = sample::mesh(square(), {.spacing = 0.04, .method = sample::spread::poisson});
  CHECK(closest_pair(s.points) > 0.04);
  CHECK(s.density == static_cast<double>(s.points.size()));
  CHECK(s.density > 0.6 / (0.04 * 0.04));
}

TEST_CASE("elimination refuses what it cannot do and leaves few points alone") {
  const cloud::cloud c{.points = {{0, 0, 0}, {1, 0, 0}}};
  CHECK(sample::eliminate(c, {.n = 5, .area = 1}).size() == 2);
  CHECK_THROWS_AS((void)sample::eliminate(c, {.n = 1}), argument_error);
  CHECK_THROWS_AS((void)sample::eliminate(c, {.area = 1}), argument_error);
  CHECK_THROWS_AS(sample::mesh(square(), {.spacing = -1.0, .method = sample::spread::poisson}),
                  argument_error);
  CHECK_THROWS_AS(sample::mesh(square(), {.method = sample::spread::poisson}), argument_error);
}

TEST_CASE("sampling stops") {
  const auto points = sample::mesh(square(), {.n = 100}).points;
  const auto how = support::stopped();
  CHECK_THROWS_AS((void)sample::mesh(square(), {.n = 100, .control = how}), stopped_error);
  CHECK_THROWS_AS((void)sample::thin(points, {.spacing = 1, .control = how}), stopped_error);
  CHECK_THROWS_AS((void)sample::eliminate(points, {.n = 9, .area = 1, .control = how}),
                  stopped_error);
}

}  // namespace test_thin
