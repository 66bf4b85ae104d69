// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/align/trajectory.hpp>
#include <aib/io/tum.hpp>
#include <aib/pose/ape.hpp>
#include <aib/pose/associate.hpp>
#include <aib/pose/rpe.hpp>

#include <doctest/doctest.h>

#include "golden.hpp"
#include "synthetic.hpp"
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

using namespace aib;
using pose::delta_unit;
using pose::pose_relation;

namespace test_errors {

namespace {

math::sim3 some_rigid() {
  const math::sim3 t = synthetic::some_sim3();
  return {1, t.rotation, t.translation};
}

constexpr std::pair<const char*, pose_relation> evo_relations[] = {
    {"translation_part", pose_relation::translation},
    {"rotation_part", pose_relation::rotation_part},
    {"full_transformation", pose_relation::full},
    {"rotation_angle_deg", pose_relation::angle_deg},
    {"rotation_angle_rad", pose_relation::angle_rad},
    {"point_distance", pose_relation::point_distance},
    {"point_distance_error_ratio", pose_relation::point_distance_ratio}};

void check_summary(const stats::summary& s, const nlohmann::json& e, pose_relation relation) {
  CHECK(s.count == e.at("count").get<std::uint64_t>());
  const double absolute = relation == pose_relation::angle_deg   ? 2e-6
                          : relation == pose_relation::angle_rad ? 4e-8
                                                                 : 1e-9;
  const std::pair<const char*, double> values[] = {
      {"rmse", s.rmse}, {"mean", s.mean}, {"median", s.median}, {"std", s.std},
      {"min", s.min},   {"max", s.max},   {"sse", s.sse}};
  for (const auto& [name, value] : values) {
    CAPTURE(name);
    const double expected = e.at(name);
    CHECK(std::abs(value - expected) <= 1e-7 * std::abs(expected) + absolute);
  }
}

/// "meters0.5_all_tol0.1" and the like.
pose::rpe_options options_of(const std::string& name) {
  pose::rpe_options o;
  const std::size_t digits = name.find_first_of("0123456789");
  const std::string unit = name.substr(0, digits);
  o.pairs.unit = unit == "frames"   ? delta_unit::frames
                 : unit == "meters" ? delta_unit::m
                                    : delta_unit::deg;
  o.pairs.delta = std::stod(name.substr(digits));
  o.pairs.all_pairs = name.find("_all") != std::string::npos;
  if (name.ends_with("from_reference")) o.from = pose::pairs_from::reference;
  return o;
}

math::sim3 aligned_as(const std::string& name, const pose::association& a) {
  const std::size_t at = name.find("_n");
  const std::size_t n = at == std::string::npos ? 0 : std::stoul(name.substr(at + 2));
  const auto fit = [&](align::align_mode mode, const pose::trajectory& estimate) {
    return align::trajectory(estimate, a.reference, {.fit = {.mode = mode}, .n = n}).transform;
  };
  math::sim3 t;
  if (name.starts_with("se3")) t = fit(align::align_mode::se3, a.estimate);
  if (name.starts_with("sim3")) t = fit(align::align_mode::sim3, a.estimate);
  if (name.starts_with("scale")) t = fit(align::align_mode::scale, a.estimate);
  if (name.ends_with("origin")) t = fit(align::align_mode::first, t * a.estimate) * t;
  return t;
}

}  // namespace

TEST_CASE("evo's APE and RPE, every relation") {
  if (!support::has_shared("ape, rpe")) return;
  const auto folder = support::shared() / "golden";
  for (const auto& c : support::golden_cases("trajectory")) {
    if (!c.at("inputs").contains("est")) continue;
    const std::string id = c.at("id");
    CAPTURE(id);
    const auto json = support::read_json(folder / c.at("expected_file").get<std::string>());
    const auto& expected = json.at("expected");
    const pose::association a =
        pose::associate(io::read_tum(folder / c.at("inputs").at("est").get<std::string>()),
                        io::read_tum(folder / c.at("inputs").at("ref").get<std::string>()),
                        {.by = pose::match_by::stamp,
                         .max_gap_s = expected.at("main_association_max_diff"),
                         .rule = pose::association_rule::evo});
    CHECK(pose::path_lengths(a.reference.world_from_camera).back() ==
          doctest::Approx(expected.at("path_length_ref").get<double>()).epsilon(1e-9));
    for (const auto& [name, e] : expected.at("align").items()) {
      CAPTURE(name);
      const pose::trajectory moved = aligned_as(name, a) * a.estimate;
      for (const auto& [evo_name, relation] : evo_relations) {
        if (!e.at("ape").contains(evo_name)) continue;
        CAPTURE(evo_name);
        check_summary(pose::ape(moved, a.reference, {relation}).summary, e.at("ape").at(evo_name),
                      relation);
      }
      const auto errors = pose::ape(moved, a.reference).errors;
      const auto first = e.at("ape").at("first5_translation_errors").get<std::vector<double>>();
      for (std::size_t i = 0; i < first.size(); ++i)
        CHECK(errors[i] == doctest::Approx(first[i]).epsilon(1e-7));
    }
    for (const std::string alignment : {"unaligned", "sim3"}) {
      const pose::trajectory moved =
          aligned_as(alignment == "sim3" ? "sim3" : "none", a) * a.estimate;
      for (const auto& [name, e] : expected.at("rpe").at(alignment).items()) {
        CAPTURE(name);
        pose::rpe_options options = options_of(name);
        for (const auto& [evo_name, relation] : evo_relations) {
          CAPTURE(evo_name);
          options.relation = relation;
          const auto r = pose::rpe(moved, a.reference, options);
          check_summary(r.summary, e.at(evo_name), relation);
          const auto ids = e.at("first_delta_ids").get<std::vector<std::size_t>>();
          for (std::size_t i = 0; i < ids.size(); ++i) CHECK(r.index[i] == ids[i]);
        }
      }
    }
  }
}

TEST_CASE("a trajectory shifted by (3, 4, 0) is 5 off, and its steps are right") {
  const pose::trajectory reference = synthetic::orbit();
  pose::trajectory estimate = reference;
  for (auto& pose : estimate.world_from_camera) pose.translation += Eigen::Vector3d(3, 4, 0);
  CHECK(pose::ape(estimate, reference).summary.rmse == doctest::Approx(5));
  CHECK(pose::ape(estimate, reference, {pose_relation::full}).summary.max == doctest::Approx(5));
  CHECK(pose::rpe(estimate, reference).summary.max < 1e-12);
}

TEST_CASE("ape keeps under a common rigid motion, rpe under one of either side") {
  const pose::trajectory reference = synthetic::orbit();
  const pose::trajectory estimate =
      synthetic::noisy(reference, {.rotation_deg = 3, .position = 0.1});
  for (const auto& [name, relation] : evo_relations) {
    CAPTURE(name);
    if (relation != pose_relation::point_distance_ratio) {
      CHECK(pose::ape(some_rigid() * estimate, some_rigid() * reference, {relation}).summary.rmse ==
            doctest::Approx(pose::ape(estimate, reference, {relation}).summary.rmse));
    }
    const double rpe = pose::rpe(estimate, reference, {relation}).summary.rmse;
    CHECK(pose::rpe(some_rigid() * estimate, reference, {relation}).summary.rmse ==
          doctest::Approx(rpe));
    CHECK(pose::rpe(estimate, some_rigid() * reference, {relation}).summary.rmse ==
          doctest::Approx(rpe));
  }
}

TEST_CASE("pairs a delta apart") {
  const pose::trajectory t = synthetic::orbit({.frames = 12, .climb = 0});
  const auto pairs = [&](pose::delta_options o) {
    return pose::delta_pairs(t.world_from_camera, o);
  };
  CHECK(pairs({.delta = 5}).size() == 2);
  CHECK(pairs({.delta = 5, .all_pairs = true}).size() == 7);
  // A step turns by a little less than 30 degrees, since the cameras look down upon the middle.
  CHECK(pairs({.delta = 25, .unit = delta_unit::deg}).size() == 11);
  // Two steps on, and two steps short of the whole round.
  CHECK(
      pairs({.delta = 60, .unit = delta_unit::deg, .all_pairs = true, .tolerance = 0.05}).size() ==
      10 + 2);
  CHECK_THROWS_AS(pairs({.delta = 0}), argument_error);
  CHECK_THROWS_AS(pairs({.delta = 1.5}), argument_error);
  CHECK_THROWS_AS(pairs({.delta = 100, .unit = delta_unit::m}), undefined_error);
}

TEST_CASE("frames that are not registered are passed over, none is undefined") {
  const pose::trajectory reference = synthetic::orbit({.frames = 4});
  pose::trajectory estimate = reference;
  estimate.world_from_camera[1].translation[2] = std::numeric_limits<double>::quiet_NaN();
  const auto r = pose::ape(estimate, reference);
  CHECK(r.index == std::vector<std::size_t>{0, 2, 3});
  CHECK(pose::rpe(estimate, reference).index == std::vector<std::size_t>{2, 3});
  CHECK_THROWS_AS(pose::ape({}, {}), undefined_error);
  CHECK_THROWS_AS(pose::rpe({}, {}), undefined_error);
  CHECK_THROWS_AS(pose::ape(estimate, {}), argument_error);
  CHECK_THROWS_AS(pose::ape(estimate, reference, {pose_relation::point_distance_ratio}),
                  argument_error);
  pose::trajectory still = reference;
  for (auto& pose : still.world_from_camera) pose.translation.setZero();
  CHECK_THROWS_AS(pose::rpe(still, still, {pose_relation::point_distance_ratio}), undefined_error);
}

}  // namespace test_errors
