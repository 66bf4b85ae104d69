// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/align/trajectory.hpp>
#include <aib/io/tum.hpp>
#include <aib/pose/associate.hpp>

#include <doctest/doctest.h>

#include "../pose/golden.hpp"
#include "../pose/synthetic.hpp"
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

using namespace aib;
using align::align_mode;

namespace test_trajectory {

namespace {

double distance(const math::sim3& a, const math::sim3& b) {
  return (a.matrix() - b.matrix()).norm();
}

pose::trajectory in_own_world(const pose::trajectory& reference) {
  return synthetic::some_sim3().inverse() * reference;
}

/// A straight flight along x, cameras looking down, slightly turned in turns.
pose::trajectory straight(std::size_t n, double wobble) {
  pose::trajectory t = synthetic::orbit({.frames = n});
  random_engine random(5);
  for (std::size_t i = 0; i < n; ++i) {
    t.world_from_camera[i].translation = {static_cast<double>(i), 0, 3};
    t.world_from_camera[i].translation += wobble * synthetic::normal3(random);
  }
  return t;
}

}  // namespace

TEST_CASE("each mode finds what it may change") {
  const pose::trajectory reference = synthetic::orbit();
  const math::sim3 truth = synthetic::some_sim3();
  const auto sim3 = align::trajectory(in_own_world(reference), reference);
  CHECK(distance(sim3.transform, truth) < 1e-12);
  CHECK(sim3.rmse < 1e-12);
  CHECK(sim3.n_inliers == 30);
  CHECK(sim3.warnings.empty());

  const math::sim3 rigid{1, truth.rotation, truth.translation};
  for (const auto mode : {align_mode::se3, align_mode::first}) {
    const auto a =
        align::trajectory(rigid.inverse() * reference, reference, {.fit = {.mode = mode}});
    CHECK(distance(a.transform, rigid) < 1e-12);
  }
  const math::sim3 bigger{3, Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero()};
  const auto scale = align::trajectory(bigger.inverse() * reference, reference,
                                       {.fit = {.mode = align_mode::scale}});
  CHECK(distance(scale.transform, bigger) < 1e-12);
}

TEST_CASE("yaw alone turns about the vertical that is given") {
  const pose::trajectory reference = synthetic::orbit();
  for (const Eigen::Vector3d& up : {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0, -2, 0)}) {
    const Eigen::Vector3d turn = 2.1 * up.normalized();
    const math::sim3 truth{1, math::rotation_from(turn), {1, 2, 3}};
    const auto a = align::trajectory(truth.inverse() * reference, reference,
                                     {.fit = {.mode = align_mode::yaw, .up = up}});
    CHECK(distance(a.transform, truth) < 1e-12);
  }
}

TEST_CASE("yaw_scale fits the scale as well and keeps down where it is") {
  const pose::trajectory reference = synthetic::orbit();
  const math::sim3 truth{2.5, math::rotation_from(Eigen::Vector3d(0, 0, 0.7)), {1, 2, 3}};
  const align::trajectory_options options{.fit = {.mode = align_mode::yaw_scale}};
  const auto a = align::trajectory(truth.inverse() * reference, reference, options);
  CHECK(distance(a.transform, truth) < 1e-12);
  CHECK(a.turn->deg < 1e-6);
  CHECK(*a.half_rmse < 1e-12);
  const math::sim3 tilted{0.5, math::rotation_from(Eigen::Vector3d(0.2, 0, 0.7)), {1, 2, 3}};
  const auto b = align::trajectory(tilted * reference, reference, options);
  CHECK(b.transform.rotation(2, 2) == doctest::Approx(1).epsilon(1e-15));
  CHECK(b.rmse > 0.01);
  const auto mirrored = math::rotation_from(Eigen::Vector3d(std::numbers::pi, 0, 0));
  pose::trajectory ladder = straight(20, 0);
  for (auto& pose : ladder.world_from_camera) {
    pose.translation.z() = 3 * pose.translation.x();
    pose.translation.y() = 0;
  }
  CHECK_THROWS_AS(align::trajectory(math::sim3{.rotation = mirrored} * ladder, ladder, options),
                  undefined_error);
}

TEST_CASE("a climb beside the vertical leaves the turn about it free, and yaw says so") {
  pose::trajectory reference;
  for (int i = 0; i < 30; ++i) {
    math::rigid3 pose;
    pose.translation = {0.01 * (i % 3), 0.01 * (i % 2), 1.0 * i};
    reference.world_from_camera.push_back(pose);
  }
  const auto a = align::trajectory(synthetic::noisy(reference, {.position = 0.02}), reference,
                                   {.fit = {.mode = align_mode::yaw}});
  CHECK(a.turn->deg > 5);
  REQUIRE(a.warnings.size() == 1);
  CHECK(a.warnings[0].find("the turn about (0, 0, 1)") == 0);
}

TEST_CASE("half of the poses are scored under a fit to the other half") {
  const pose::trajectory reference = synthetic::orbit({.frames = 40});
  const pose::trajectory estimate = synthetic::noisy(reference, {.position = 0.05});
  const auto a = align::trajectory(estimate, reference);
  CHECK(*a.half_rmse > a.rmse);
  CHECK(*a.half_rmse < 2 * a.rmse);
  CHECK(!align::trajectory(estimate, reference, {.n = 3}).half_rmse);  // two poses tell no fit
}

TEST_CASE("yaw works along a straight level flight, where a similarity is refused") {
  const pose::trajectory reference = straight(20, 0);
  const math::sim3 truth{1, math::rotation_from(Eigen::Vector3d(0, 0, 0.7)), {1, 2, 3}};
  const pose::trajectory estimate = truth.inverse() * reference;
  CHECK(
      distance(align::trajectory(estimate, reference, {.fit = {.mode = align_mode::yaw}}).transform,
               truth) < 1e-12);
  CHECK_THROWS_AS(align::trajectory(estimate, reference), undefined_error);
}

TEST_CASE("orientations tell the turn about a straight flight") {
  const pose::trajectory reference = straight(20, 0);
  const auto a =
      align::trajectory(in_own_world(reference), reference, {.fit = {.rotation_weight = 1}});
  CHECK(distance(a.transform, synthetic::some_sim3()) < 1e-10);
  CHECK(a.warnings.empty());
  CHECK(!a.turn);
  const auto rigid = align::trajectory(reference, reference,
                                       {.fit = {.mode = align_mode::se3, .rotation_weight = 1}});
  CHECK(distance(rigid.transform, {}) < 1e-12);
}

TEST_CASE("a nearly straight flight is warned about, with the axis and the error") {
  const pose::trajectory reference = straight(40, 0.005);
  const auto a = align::trajectory(synthetic::noisy(in_own_world(reference), {.position = 0.02}),
                                   reference, {.stand_off = 10});
  REQUIRE(a.warnings.size() == 1);
  CHECK(a.warnings[0].find("the turn about (1, 0, 0)") != std::string::npos);
  CHECK(a.condition > 100);
  CHECK(a.turn->deg > 10);
  CHECK(a.turn->error == doctest::Approx(20 * std::sin(math::radians(a.turn->deg) / 2)));
}

TEST_CASE("the foretold error of the turn is the one that comes out") {
  const pose::trajectory reference = straight(60, 0.3);
  double sum = 0, foretold = 0;
  constexpr int runs = 50;
  for (int seed = 1; seed <= runs; ++seed) {
    const auto a = align::trajectory(
        synthetic::noisy(reference, {.position = 0.1, .seed = static_cast<std::uint64_t>(seed)}),
        reference);
    const Eigen::Vector3d turn = math::axis_angle_from(a.transform.rotation);
    sum += std::pow(math::degrees(turn[0]), 2);
    foretold += std::pow(a.turn->deg, 2);
  }
  CHECK(std::sqrt(sum / foretold) == doctest::Approx(1).epsilon(0.25));
}

TEST_CASE("outliers are taken out by their distance from the median position") {
  const pose::trajectory reference = synthetic::orbit();
  pose::trajectory estimate = in_own_world(reference);
  estimate.world_from_camera[4].translation += Eigen::Vector3d(100, 0, 0);
  estimate.world_from_camera[9].translation += Eigen::Vector3d(0, -500, 0);
  const auto plain = align::trajectory(estimate, reference);
  CHECK(plain.transform.scale < 0.5);
  REQUIRE(!plain.warnings.empty());
  CHECK(plain.warnings.back().find("outliers rule the fit") != std::string::npos);
  for (const align::outlier_options& o :
       {align::outlier_options{.factor = 3}, align::outlier_options{.distance = 30}}) {
    const auto a = align::trajectory(estimate, reference, {.outliers = o});
    CHECK(distance(a.transform, synthetic::some_sim3()) < 1e-12);
    CHECK(a.outliers == std::vector<std::size_t>{4, 9});
    CHECK(a.n_inliers == 28);
  }
}

TEST_CASE("robust mode finds the transform of the majority, the same one each time") {
  const pose::trajectory reference = synthetic::orbit();
  pose::trajectory estimate = synthetic::noisy(in_own_world(reference), {.position = 0.001});
  random_engine random(3);
  for (std::size_t i = 0; i < 12; ++i)
    estimate.world_from_camera[2 * i].translation += 0.5 * synthetic::normal3(random);
  for (const double distance_given : {0.0, 0.02}) {
    const align::trajectory_options options{.robust =
                                                align::ransac_options{.distance = distance_given}};
    const auto a = align::trajectory(estimate, reference, options);
    CHECK(a.transform.scale == doctest::Approx(1.7).epsilon(0.01));
    CHECK(a.n_inliers <= 20);
    CHECK(a.n_inliers >= 14);
    CHECK(distance(align::trajectory(estimate, reference, options).transform, a.transform) == 0);
  }
}

TEST_CASE("robust mode keeps every pose that is exact to rounding") {
  const pose::trajectory reference = synthetic::orbit({.frames = 8});
  pose::trajectory estimate = in_own_world(reference);
  estimate.world_from_camera[7].translation.z() += 100;
  const auto a = align::trajectory(estimate, reference, {.robust = align::ransac_options{}});
  CHECK(a.n_inliers == 7);
  CHECK(a.outliers == std::vector<std::size_t>{7});
}

TEST_CASE("poses that are not finite are passed over, and nothing is undefined") {
  const pose::trajectory reference = synthetic::orbit();
  pose::trajectory estimate = in_own_world(reference);
  for (std::size_t i = 0; i < 10; ++i)
    estimate.world_from_camera[i].rotation(0, 0) = std::numeric_limits<double>::quiet_NaN();
  CHECK(align::trajectory(estimate, reference).n_inliers == 20);
  const auto first = align::trajectory(estimate, reference, {.fit = {.mode = align_mode::first}});
  CHECK(first.n_inliers == 20);
  CHECK_THROWS_AS(align::trajectory({}, {}), undefined_error);
  CHECK_THROWS_AS(align::trajectory(estimate, {}), argument_error);
  for (const std::size_t n : {1u, 2u}) {
    const pose::trajectory few = synthetic::orbit({.frames = n});
    CHECK_THROWS_AS(align::trajectory(few, few), undefined_error);
    CHECK_THROWS_AS(align::trajectory(few, few, {.robust = align::ransac_options{}}),
                    undefined_error);
  }
}

TEST_CASE("evo's alignments, outlier removal and batches") {
  if (!support::has_shared("align")) return;
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
    const auto check_transform = [](const math::sim3& t, const nlohmann::json& e) {
      CHECK(std::abs(t.scale - e.at("s").get<double>()) <= 1e-7 * t.scale);
      CHECK((t.rotation - support::matrix3(e.at("R"))).norm() <= 1e-7);
      CHECK((t.translation - support::vector3(e.at("t"))).norm() <=
            1e-7 * (1 + t.translation.norm()));
    };
    for (const auto& [name, e] : expected.at("align").items()) {
      CAPTURE(name);
      if (!e.at("alignment").is_object() || !e.at("alignment").contains("R")) continue;
      const std::size_t n =
          name.find("_n") == std::string::npos ? 0 : std::stoul(name.substr(name.find("_n") + 2));
      const auto mode = name.starts_with("se3") ? align_mode::se3 : align_mode::sim3;
      check_transform(
          align::trajectory(a.estimate, a.reference, {.fit = {.mode = mode}, .n = n}).transform,
          e.at("alignment"));
    }
    for (const auto& [name, e] : expected.at("outlier_removal").items()) {
      CAPTURE(name);
      const double factor = std::stod(name.substr(4));
      const auto r = align::trajectory(a.estimate, a.reference, {.outliers = {.factor = factor}});
      CHECK(r.n_inliers == e.at("kept").get<std::size_t>());
      CHECK(r.outliers == e.at("removed_indices").get<std::vector<std::size_t>>());
      check_transform(r.transform, e.at("alignment"));
      CHECK(r.rmse == doctest::Approx(e.at("ate_rmse_kept").get<double>()).epsilon(1e-7));
    }
  }
}

}  // namespace test_trajectory
