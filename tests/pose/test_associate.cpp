// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/io/tum.hpp>
#include <aib/pose/associate.hpp>

#include <doctest/doctest.h>

#include "golden.hpp"
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

using namespace aib;
using pose::match_by;

namespace test_associate {

namespace {

pose::trajectory named(std::vector<std::string> names) {
  pose::trajectory t;
  t.world_from_camera.resize(names.size());
  for (std::size_t i = 0; i < names.size(); ++i)
    t.world_from_camera[i].translation[0] = static_cast<double>(i);
  t.names = std::move(names);
  return t;
}

pose::trajectory stamped(std::vector<double> stamps) {
  pose::trajectory t;
  t.world_from_camera.resize(stamps.size());
  t.stamps_s = std::move(stamps);
  return t;
}

}  // namespace

TEST_CASE("names match in the order of the reference, what is left over is counted") {
  const auto a = pose::associate(named({"c", "x", "a"}), named({"a", "b", "c", "d"}));
  CHECK(a.reference.names == std::vector<std::string>{"a", "c"});
  CHECK(a.estimate.names == a.reference.names);
  CHECK(a.estimate_index == std::vector<std::size_t>{2, 0});
  CHECK(a.reference_index == std::vector<std::size_t>{0, 2});
  CHECK(a.n_matched == 2);
  CHECK(a.n_estimate_only == 1);
  CHECK(a.n_reference_only == 2);
}

TEST_CASE("case, extension and folder can be left out of names") {
  const auto estimate = named({"images/IMG.1.PNG", "images/IMG.2.PNG"});
  const auto reference = named({"img.2.exr", "img.1.exr"});
  CHECK_THROWS_WITH_AS(pose::associate(estimate, reference),
                       "associate: none of 2 estimated poses matches one of 2 reference poses, "
                       "\"images/IMG.1.PNG\" in the one, \"img.2.exr\" in the other; "
                       "ignore_folder, ignore_extension and ignore_case would match 2",
                       undefined_error);
  const auto a = pose::associate(
      estimate, reference, {.ignore_case = true, .ignore_extension = true, .ignore_folder = true});
  CHECK(a.estimate_index == std::vector<std::size_t>{1, 0});
  CHECK(a.estimate.names == reference.names);
}

TEST_CASE("a name twice is refused, also when only a rule makes it so") {
  CHECK_THROWS_WITH_AS(pose::associate(named({"a"}), named({"a", "a"})),
                       "associate: two poses of the reference have one name: \"a\" and \"a\"",
                       argument_error);
  CHECK_THROWS_AS(pose::associate(named({"l/a", "r/a"}), named({"a"}), {.ignore_folder = true}),
                  argument_error);
  CHECK_THROWS_AS(pose::associate(stamped({1}), named({"a"})), argument_error);
}

TEST_CASE("stamps: the closest pairs first, each pose once") {
  const auto a = pose::associate(stamped({1.00, 1.01, 2.0, 9.0}), stamped({1.008, 1.998, 5}),
                                 {.by = match_by::stamp, .max_gap_s = 0.02});
  CHECK(a.estimate_index == std::vector<std::size_t>{1, 2});
  CHECK(a.reference_index == std::vector<std::size_t>{0, 1});
  CHECK(a.n_estimate_only == 2);
  CHECK(a.n_reference_only == 1);
}

TEST_CASE("stamps: one that lost its nearest takes the next, equal stamps are taken once each") {
  const auto a = pose::associate(stamped({1.0, 1.0, 1.001}), stamped({1.0, 1.004, 0.997}),
                                 {.by = match_by::stamp, .max_gap_s = 0.005});
  CHECK(a.n_matched == 3);
  CHECK(a.reference_index == std::vector<std::size_t>{0, 1, 2});
}

TEST_CASE("stamps: the greedy match is that of all pairs sorted by their gap") {
  std::vector<double> e, r;
  for (int i = 0; i < 200; ++i) {
    e.push_back(std::fmod(i * 0.7548776662, 1.0));
    r.push_back(std::fmod(i * 0.5698402910, 1.0));
  }
  struct pair {
    double gap;
    std::size_t r, e;
  };
  std::vector<pair> all;
  for (std::size_t i = 0; i < e.size(); ++i) {
    for (std::size_t j = 0; j < r.size(); ++j) {
      if (std::abs(e[i] - r[j]) <= 0.01) all.push_back({std::abs(e[i] - r[j]), j, i});
    }
  }
  std::sort(all.begin(), all.end(), [](const pair& a, const pair& b) { return a.gap < b.gap; });
  std::vector<std::size_t> partner(r.size(), e.size());
  std::vector<bool> taken(e.size());
  for (const pair& p : all) {
    if (taken[p.e] || partner[p.r] != e.size()) continue;
    taken[p.e] = true;
    partner[p.r] = p.e;
  }
  const auto a = pose::associate(stamped(e), stamped(r), {.by = match_by::stamp});
  std::size_t k = 0;
  for (std::size_t j = 0; j < r.size(); ++j) {
    if (partner[j] == e.size()) continue;
    REQUIRE(k < a.n_matched);
    CHECK(a.reference_index[k] == j);
    CHECK(a.estimate_index[k] == partner[j]);
    ++k;
  }
  CHECK(k == a.n_matched);
}

TEST_CASE("stamps that are not finite are refused") {
  CHECK_THROWS_AS(pose::associate(stamped({std::numeric_limits<double>::quiet_NaN()}), stamped({1}),
                                  {.by = match_by::stamp}),
                  argument_error);
}

TEST_CASE("by index the shorter list decides") {
  const auto a = pose::associate(stamped({1, 2, 3}), stamped({7, 8}), {.by = match_by::index});
  CHECK(a.n_matched == 2);
  CHECK(a.n_estimate_only == 1);
}

TEST_CASE("evo's association, repeated") {
  if (!support::has_shared("associate")) return;
  const auto folder = support::shared() / "golden";
  for (const auto& c : support::golden_cases("trajectory")) {
    if (!c.at("inputs").contains("est")) continue;
    const std::string id = c.at("id");
    CAPTURE(id);
    const auto estimate = io::read_tum(folder / c.at("inputs").at("est").get<std::string>());
    const auto reference = io::read_tum(folder / c.at("inputs").at("ref").get<std::string>());
    const auto json = support::read_json(folder / c.at("expected_file").get<std::string>());
    for (const auto& e : json.at("expected").at("association")) {
      const pose::associate_options options{.by = match_by::stamp,
                                            .max_gap_s = e.at("max_diff"),
                                            .offset_s = e.at("offset_2"),
                                            .rule = pose::association_rule::evo};
      if (e.contains("raises")) {
        CHECK_THROWS_AS(pose::associate(estimate, reference, options), undefined_error);
        continue;
      }
      const auto a = pose::associate(estimate, reference, options);
      CHECK(a.n_matched == e.at("matches").get<std::size_t>());
      CHECK(reference.size() - a.n_reference_only == e.at("unique_ref").get<std::size_t>());
      CHECK(estimate.size() - a.n_estimate_only == e.at("unique_est").get<std::size_t>());
      CHECK(a.reference.stamps_s.front() == e.at("first").at(0).get<double>());
      CHECK(a.estimate.stamps_s.front() == e.at("first").at(1).get<double>());
      CHECK(a.reference.stamps_s.back() == e.at("last").at(0).get<double>());
      CHECK(a.estimate.stamps_s.back() == e.at("last").at(1).get<double>());
    }
  }
}

}  // namespace test_associate
