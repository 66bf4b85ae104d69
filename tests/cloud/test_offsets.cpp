// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/cloud/by_label.hpp>
#include <aib/cloud/colored.hpp>
#include <aib/cloud/offsets.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <support/stopped.hpp>
#include <vector>

using namespace aib;

namespace test_offsets {

namespace {

constexpr float none = std::numeric_limits<float>::quiet_NaN();

cloud::cloud floor_with_normals() {
  cloud::cloud c;
  for (int x = 0; x < 10; ++x) {
    c.points.emplace_back(static_cast<float>(x), 0.0f, 0.0f);
    c.normals.emplace_back(0.0f, 0.0f, 1.0f);
    c.labels.push_back(x < 5 ? 1 : 2);
  }
  return c;
}

}  // namespace

TEST_CASE("offsets tell before from behind, along the normal of the nearest point") {
  const cloud::cloud c{.points = {{0, 0, 2}, {3, 0, -1}, {9, 4, 0.5f}, {none, 0, 0}}};
  const auto o = cloud::offsets_along_normals(c, floor_with_normals());
  CHECK(o[0] == 2);
  CHECK(o[1] == -1);
  CHECK(o[2] == 0.5f);  // what lies along the surface does not count
  CHECK(o.n_dropped() == 1);
  CHECK(o.mean() == 0.5);
  CHECK(o.median() == 0.5);
  CHECK(o.mean_absolute() == doctest::Approx(3.5 / 3));
  CHECK(o.deviation() == doctest::Approx(std::sqrt((1.5 * 1.5 + 1.5 * 1.5) / 3)));
  CHECK_THROWS_AS(cloud::offsets_along_normals(c, c), argument_error);
  CHECK_THROWS_AS(cloud::offsets_along_normals(c, cloud::cloud{}), undefined_error);
  CHECK_THROWS_AS((void)cloud::offsets({none}).mean(), undefined_error);
}

TEST_CASE("values have colours on a scale, none is grey") {
  const std::vector<float> values{0, 1, 5, none};
  const auto colors = cloud::colors_of(values, 1);
  CHECK(colors[0] == raster::sequential_color(0));
  CHECK(colors[1] == raster::sequential_color(1));
  CHECK(colors[2] == colors[1]);
  CHECK(colors[3] == cloud::color{128, 128, 128});
  const std::vector<float> both{-1, 0, 1};
  const auto signs = cloud::colors_of(both, 1, cloud::color_scale::diverging);
  CHECK(signs[0] == raster::diverging_color(-1));
  CHECK(signs[1] == raster::diverging_color(0));
  CHECK_THROWS_AS((void)cloud::colors_of(values, 0), argument_error);
  CHECK_THROWS_AS((void)cloud::colored(floor_with_normals(), values, 1), argument_error);
}

TEST_CASE("scores by label are those of the points of the label") {
  const cloud::cloud reference = floor_with_normals();
  const cloud::cloud estimate{.points = {{0, 0, 1}, {1, 0, 1}, {8, 0, 3}}};
  const auto labels = cloud::nearest_labels(estimate, reference);
  CHECK(labels == std::vector<std::uint32_t>{1, 1, 2});
  const auto both = cloud::distances_both_ways(estimate, reference);
  const auto found = cloud::by_label(both, labels, reference.labels);
  REQUIRE(found.size() == 2);
  CHECK(found[0].label == 1);
  CHECK(found[0].to_reference.mean() == 1);
  CHECK(found[1].to_reference.mean() == 3);
  CHECK(found[0].to_estimate.size() == 5);
  const std::vector<double> tau{2.0};
  CHECK(cloud::score(found[0].to_reference, found[0].to_estimate, tau).scores[0].precision == 1);
  CHECK(cloud::score(found[1].to_reference, found[1].to_estimate, tau).scores[0].precision == 0);
  CHECK_THROWS_AS((void)cloud::by_label(both, reference.labels, labels), argument_error);
  CHECK_THROWS_AS((void)cloud::nearest_labels(estimate, estimate), argument_error);
}

TEST_CASE("offsets and labels of the nearest points stop") {
  const auto c = floor_with_normals();
  CHECK_THROWS_AS((void)cloud::offsets_along_normals(c, c, 0, support::stopped()), stopped_error);
  CHECK_THROWS_AS((void)cloud::nearest_labels(c, c, 0, support::stopped()), stopped_error);
}

}  // namespace test_offsets
