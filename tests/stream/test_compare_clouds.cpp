// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/core/random.hpp>
#include <aib/io/ply.hpp>
#include <aib/io/ply_write.hpp>
#include <aib/stream/compare_clouds.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <stop_token>
#include <support/scratch.hpp>
#include <vector>

using namespace aib;

namespace test_compare_clouds {

namespace {

constexpr std::uint64_t little = std::uint64_t{16} << 20;

/// A wavy sheet with noise, strays and a hole.
cloud::cloud sheet(std::size_t n, double noise, std::uint64_t seed) {
  random_engine random(seed);
  cloud::cloud c;
  while (c.points.size() < n) {
    const double x = random.uniform(0, 60), y = random.uniform(0, 60);
    const bool stray = noise > 0 && random.uniform() < 0.02;
    if (noise > 0 && !stray && std::hypot(x - 20, y - 20) < 9) continue;
    const double z = stray ? random.uniform(-30, 60) : std::sin(x) + noise * random.normal();
    c.points.emplace_back(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
  }
  return c;
}

void check_same(const cloud::comparison& a, const cloud::comparison& b) {
  CHECK(a.accuracy == b.accuracy);
  CHECK(a.completeness == b.completeness);
  CHECK(a.accuracy_median == b.accuracy_median);
  CHECK(a.completeness_median == b.completeness_median);
  CHECK(a.accuracy_rmse == b.accuracy_rmse);
  CHECK(a.completeness_rmse == b.completeness_rmse);
  CHECK(a.hausdorff == b.hausdorff);
  CHECK(a.n_estimate == b.n_estimate);
  CHECK(a.n_reference == b.n_reference);
  CHECK(a.n_dropped == b.n_dropped);
  CHECK(a.estimate_beyond == b.estimate_beyond);
  CHECK(a.reference_beyond == b.reference_beyond);
  REQUIRE(a.scores.size() == b.scores.size());
  for (std::size_t i = 0; i < a.scores.size(); ++i) {
    CHECK(a.scores[i].precision == b.scores[i].precision);
    CHECK(a.scores[i].recall == b.scores[i].recall);
  }
}

void check_equal(const cloud::cloud& estimate,
                 const cloud::cloud& reference,
                 const cloud::compare_options& how) {
  const support::scratch scratch;
  const auto e = scratch.folder() / "e.ply", r = scratch.folder() / "r.ply";
  io::write_ply(e, estimate);
  io::write_ply(r, reference);
  check_same(stream::compare_clouds(e, r, {little, scratch.folder(), how}),
             cloud::compare(io::read_ply_cloud(e), io::read_ply_cloud(r), how));
  const auto files = std::filesystem::directory_iterator(scratch.folder());
  CHECK(std::distance(begin(files), end(files)) == 2);
}

}  // namespace

TEST_CASE("clouds in tiles compare as in memory, bit for bit") {
  cloud::cloud estimate = sheet(180'000, 0.02, 1);
  const cloud::cloud reference = sheet(220'001, 0, 2);
  SUBCASE("as they are") { check_equal(estimate, reference, {.tau = {0.05, 0.01, 100}}); }
  SUBCASE("cut off") {
    check_equal(estimate, reference, {.tau = {0.05}, .max_distance = 0.1});
    check_equal(estimate, reference,
                {.max_distance = 0.1, .rule = cloud::maximum_rule::clamp, .threads = 1});
  }
  SUBCASE("with points that are not finite, and in map coordinates") {
    estimate.points[17].x() = std::numeric_limits<float>::quiet_NaN();
    estimate.points[100'000].z() = std::numeric_limits<float>::infinity();
    estimate.origin = {458000.25, 5429000, 160};
    cloud::cloud moved = reference;
    moved.origin = {458000, 5429000, 160};
    check_equal(estimate, moved, {.tau = {0.3}});
  }
}

TEST_CASE("tiles of few, equal or distant points") {
  const cloud::cloud one{.points = {{1, 2, 3}}};
  check_equal(one, sheet(3, 0, 1), {.tau = {1}});
  cloud::cloud same;
  same.points.assign(130'000, {1, 2, 3});
  check_equal(same, same, {.tau = {1}});
  cloud::cloud far = sheet(130'000, 0, 5);
  far.points.emplace_back(1e6f, -1e6f, 1e6f);
  check_equal(far, one, {});
}

TEST_CASE("what cannot be compared is refused, a stop stops, progress ends at 1") {
  const support::scratch scratch;
  const auto e = scratch.folder() / "e.ply", none = scratch.folder() / "none.ply";
  io::write_ply(e, sheet(5000, 0, 1));
  io::write_ply(none, cloud::cloud{.points = {{std::numeric_limits<float>::quiet_NaN(), 0, 0}}});
  CHECK_THROWS_AS((void)stream::compare_clouds(e, none), undefined_error);
  CHECK_THROWS_AS((void)stream::compare_clouds(none, e), undefined_error);
  CHECK_THROWS_AS((void)stream::compare_clouds(e, e, {.memory = 1}), argument_error);
  CHECK_THROWS_AS((void)stream::compare_clouds(e, e, {.folder = scratch.folder() / "x"}), io_error);
  CHECK_THROWS_AS(
      (void)stream::compare_clouds(e, e, {.compare = {.tau = {2}, .max_distance = 1.0}}),
      argument_error);
  const auto text = scratch.file("text.ply",
                                 "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"
                                 "property float y\nproperty float z\nend_header\n1 2 3\n");
  CHECK_THROWS_AS((void)stream::compare_clouds(e, text), format_error);
  double share = 0;
  const auto c = stream::compare_clouds(
      e, e, {.compare = {.control = {.progress = [&](double s) { share = s; }}}});
  CHECK(c.chamfer == 0);
  CHECK(share == 1);
  std::stop_source stop;
  stop.request_stop();
  CHECK_THROWS_AS(
      (void)stream::compare_clouds(e, e, {.compare = {.control = {.stop = stop.get_token()}}}),
      stopped_error);
}

}  // namespace test_compare_clouds
