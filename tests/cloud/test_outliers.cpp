// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/cloud/normals.hpp>
#include <aib/cloud/outliers.hpp>
#include <aib/core/random.hpp>
#include <aib/io/ply.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <support/shared.hpp>
#include <support/stopped.hpp>
#include <vector>

using namespace aib;

namespace test_outliers {

namespace {

/// A sheet z = x / 2 with labels 0, one point far above it with label 1, and one that is not
/// finite.
cloud::cloud tilted_sheet() {
  random_engine random(1);
  cloud::cloud c;
  for (int i = 0; i < 3000; ++i) {
    const float x = static_cast<float>(random.uniform()), y = static_cast<float>(random.uniform());
    c.points.emplace_back(x, y, x / 2);
    c.labels.push_back(0);
  }
  c.points.emplace_back(0.5f, 0.5f, 5.0f);
  c.labels.push_back(1);
  c.points.emplace_back(0.5f, std::numeric_limits<float>::quiet_NaN(), 0.0f);
  c.labels.push_back(2);
  return c;
}

}  // namespace

TEST_CASE("a point far from its neighbours goes") {
  const auto is_sheet = [](std::uint32_t label) { return label == 0; };
  const auto statistical = cloud::without_statistical_outliers(tilted_sheet(), {.ratio = 5});
  CHECK(statistical.size() > 2900);
  CHECK(std::all_of(statistical.labels.begin(), statistical.labels.end(), is_sheet));
  const auto radius = cloud::without_radius_outliers(tilted_sheet(), {.radius = 0.1});
  CHECK(radius.size() == 3000);
  CHECK(std::all_of(radius.labels.begin(), radius.labels.end(), is_sheet));
  CHECK_THROWS_AS(static_cast<void>(cloud::without_radius_outliers(tilted_sheet(), {})),
                  argument_error);
}

TEST_CASE("a random subset has the asked size and order, and depends on the seed alone") {
  const auto c = tilted_sheet();
  const auto a = cloud::random_subset(c, 100, 3);
  CHECK(a.size() == 100);
  CHECK(a.labels == cloud::random_subset(c, 100, 3).labels);
  CHECK(a.points[0] == cloud::random_subset(c, 100, 3).points[0]);
  CHECK(a.points[0] != cloud::random_subset(c, 100, 4).points[0]);
  CHECK(cloud::random_subset(c, 1'000'000).size() == c.size());
}

TEST_CASE("normals stand on the surface and agree over two samplings of it") {
  auto c = tilted_sheet();
  c.points.resize(3000);
  c.labels.clear();
  const auto with = cloud::with_normals(c);
  const Eigen::Vector3f up = Eigen::Vector3f(-0.5f, 0, 1).normalized();
  for (const auto& n : with.normals) CHECK(std::abs(n.dot(up)) > 0.9999f);
  const auto agreement = cloud::normal_consistency(with, with);
  CHECK(agreement.estimate_mean == doctest::Approx(1));
  CHECK(agreement.reference_median == doctest::Approx(1));
  CHECK_THROWS_AS(static_cast<void>(cloud::normal_consistency(c, with)), argument_error);
}

TEST_CASE("statistical outliers are those that Open3D removes") {
  if (!support::has_shared("outlier golden")) return;
  const auto golden = support::shared() / "golden" / "cloud";
  struct expected {
    std::string file;
    std::size_t kept_20_2;
    std::size_t kept_16_1;
  };
  for (const auto& e : {expected{"bunny_noisy_half_est.ply", 15366, 15331},
                        expected{"bunny_moved_est.ply", 9833, 8808},
                        expected{"slac_fragment_000.ply", 4854, 4336}}) {
    CAPTURE(e.file);
    const auto c = io::read_ply_cloud(golden / e.file);
    CHECK(cloud::without_statistical_outliers(c, {.neighbours = 20, .ratio = 2}).size() ==
          e.kept_20_2);
    CHECK(cloud::without_statistical_outliers(c, {.neighbours = 16, .ratio = 1}).size() ==
          e.kept_16_1);
  }
}

TEST_CASE("work on neighbours stops") {
  const auto c = tilted_sheet();
  const auto how = support::stopped();
  CHECK_THROWS_AS((void)cloud::neighbours(c, how), stopped_error);
  CHECK_THROWS_AS((void)cloud::with_normals(c, {.control = how}), stopped_error);
  CHECK_THROWS_AS((void)cloud::without_statistical_outliers(c, {.control = how}), stopped_error);
  CHECK_THROWS_AS((void)cloud::without_radius_outliers(c, {.radius = 1, .control = how}),
                  stopped_error);
  const auto with_normals = cloud::with_normals(c);
  CHECK_THROWS_AS((void)cloud::normal_consistency(with_normals, with_normals, 0, how),
                  stopped_error);
}

}  // namespace test_outliers
