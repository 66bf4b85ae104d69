// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/core/random.hpp>
#include <aib/io/waypoints.hpp>
#include <aib/math/geodesy.hpp>
#include <aib/mesh/distances.hpp>
#include <aib/mesh/mesh.hpp>
#include <aib/mesh/ray_surface.hpp>
#include <aib/survey/facade.hpp>
#include <aib/survey/fly.hpp>
#include <aib/survey/linear.hpp>
#include <aib/survey/measure.hpp>
#include <aib/survey/orbit.hpp>
#include <aib/survey/outline.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>
#include <support/scratch.hpp>
#include <vector>

using namespace aib;

namespace test_flight {

namespace {

/// A box along the axes from corner to corner, faces outwards; labels 0 walls, 1 top and bottom.
mesh::mesh box(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  mesh::mesh m;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d p((i & 1) ? high.x() : low.x(), (i & 2) ? high.y() : low.y(),
                            (i & 4) ? high.z() : low.z());
    m.vertices.push_back(p.cast<float>());
  }
  const std::uint32_t sides[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                     {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (std::uint32_t s = 0; s < 6; ++s) {
    const auto& q = sides[s];
    m.triangles.push_back({q[0], q[1], q[2]});
    m.triangles.push_back({q[0], q[2], q[3]});
    m.labels.insert(m.labels.end(), 2, s / 4);
  }
  m.label_names = {"wall", "flat"};
  return m;
}

std::vector<math::view> views_of(const survey::flight_plan& plan) {
  std::vector<math::view> views;
  for (const math::rigid3& pose : plan.trajectory.world_from_camera)
    views.push_back({plan.camera, pose});
  return views;
}

double angle_between(const math::rigid3& a, const math::rigid3& b) {
  return math::rotation_angle(a.rotation * b.rotation.transpose());
}

/// The walls of a prism, both sides of which count.
mesh::mesh walls_of(const std::vector<Eigen::Vector2d>& corners, double height) {
  mesh::mesh m;
  const auto n = static_cast<std::uint32_t>(corners.size());
  for (const Eigen::Vector2d& c : corners) {
    m.vertices.push_back(Eigen::Vector3d(c.x(), c.y(), 0).cast<float>());
    m.vertices.push_back(Eigen::Vector3d(c.x(), c.y(), height).cast<float>());
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t a = 2 * i, b = 2 * ((i + 1) % n);
    m.triangles.push_back({a, b, b + 1});
    m.triangles.push_back({a, b + 1, a + 1});
  }
  return m;
}

double distance_to(const std::vector<Eigen::Vector2d>& corners, const Eigen::Vector3d& p) {
  return survey::detail::distance_to_edges(p.head<2>(), corners);
}

const std::vector<Eigen::Vector2d> l_shape{{0, 0}, {20, 0}, {20, 10}, {10, 10}, {10, 20}, {0, 20}};

/// A court of a width, open to the right.
std::vector<Eigen::Vector2d> u_shape(double width) {
  return {{0, 0},         {20, 0},         {20, 5},          {6, 5},
          {6, 5 + width}, {20, 5 + width}, {20, 10 + width}, {0, 10 + width}};
}

const mesh::mesh office = box({-15, -10, 0}, {15, 10, 15});

survey::flight_path office_path(double stand_off) {
  return survey::facade(survey::footprint_of(office), {.path = {.stand_off = stand_off}});
}

}  // namespace

TEST_CASE("a lens of 50 mm before 36 mm sees 0.72 x 0.405 of the distance") {
  const math::camera c = survey::camera_of({});
  CHECK(c.fx() == doctest::Approx(8000.0 / 3));
  CHECK(survey::frame_on_wall(c, 10).width == doctest::Approx(7.2));
  CHECK(survey::frame_on_wall(c, 10).height == doctest::Approx(4.05));
  CHECK(survey::ground_sampling(c, 4) == doctest::Approx(0.0015));
  CHECK_THROWS_AS(static_cast<void>(survey::camera_of({.focal_mm = 0})), argument_error);
}

TEST_CASE("a footprint is the convex hull, anticlockwise") {
  const auto plan = survey::footprint_of(office);
  CHECK(plan.corners == std::vector<Eigen::Vector2d>{{-15, -10}, {15, -10}, {15, 10}, {-15, 10}});
  CHECK(plan.low == 0);
  CHECK(plan.high == 15);
  CHECK_THROWS_AS(static_cast<void>(survey::footprint_of(office, {7})), undefined_error);
  CHECK(survey::anticlockwise({{0, 0}, {0, 1}, {1, 0}}).front() == Eigen::Vector2d(1, 0));
  CHECK_THROWS_AS(static_cast<void>(survey::anticlockwise({{0, 0}, {4, 4}, {4, 0}, {0, 3}})),
                  argument_error);  // crosses itself
  CHECK_THROWS_AS(
      static_cast<void>(survey::anticlockwise({{0, 0}, {4, 0}, {4, 4}, {2, 0}, {0, 4}})),
      argument_error);  // touches itself
  CHECK_THROWS_AS(static_cast<void>(survey::anticlockwise({{0, 0}, {4, 0}, {4, 4}, {0, 0}})),
                  argument_error);  // an edge without a length
  CHECK_THROWS_AS(static_cast<void>(survey::labels_of({"glass"}, {"glas"})), argument_error);
}

TEST_CASE("a path has no jump in place or view, and reverses to itself") {
  const auto orbit =
      survey::orbit({.path = {.stand_off = 5}, .radius = 20, .low = 2, .high = 8, .look_at = 5});
  const auto mast = survey::linear({.path = {.stand_off = 4},
                                    .from = {0, 0, 0},
                                    .to = {0, 0, 30},
                                    .views = {{0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {1, 0, 0}},
                                    .width = 3,
                                    .radius = 1});
  for (const auto& path : {office_path(6), orbit, mast, survey::join({office_path(6), mast})}) {
    const double n = 2000;
    for (double i = 0; i < n; ++i) {
      const auto a = path.at(i / n), b = path.at((i + 1) / n);
      REQUIRE((b.translation - a.translation).norm() < 1.01 * path.length() / n + 1e-9);
      REQUIRE(angle_between(a, b) < 0.5);
      const auto mirrored = path.reversed().at(1 - i / n);
      REQUIRE((mirrored.translation - a.translation).norm() < 1e-6);
      REQUIRE(angle_between(mirrored, a) < 1e-6);
    }
  }
  CHECK(mast.n_rows == 8);
}

TEST_CASE("rows lie on the offset of the footprint and look at it at right angles") {
  const auto path = office_path(6);
  for (double i = 0; i <= 500; ++i) {
    const auto pose = path.at(i / 500);
    const Eigen::Vector3d near = pose.translation.cwiseMax(Eigen::Vector3d(-15, -10, 0))
                                     .cwiseMin(Eigen::Vector3d(15, 10, 15));
    CHECK((pose.translation - near).norm() == doctest::Approx(6));
    CHECK((pose.rotation.col(2) - (near - pose.translation) / 6).norm() < 1e-9);
    CHECK(pose.rotation(2, 0) == doctest::Approx(0));  // the horizon is level
    CHECK(pose.rotation(2, 1) < 0);                    // up is up
  }
}

TEST_CASE("rows keep the stand-off from walls that turn inwards, and see all of them") {
  const double stand_off = 3, height = 1.5;
  for (const auto& corners : {l_shape, u_shape(9), u_shape(6.5)}) {
    const mesh::mesh walls = walls_of(corners, height);
    const mesh::surface_index distance(walls);
    const mesh::ray_surface sight(walls);
    const survey::flight_space space{distance, sight};
    const auto path = survey::facade({corners, 0, height}, {.path = {.stand_off = stand_off}});
    const double n = std::ceil(path.length() / 0.1);
    for (double i = 0; i < n; ++i) {
      const auto a = path.at(i / n), b = path.at((i + 1) / n);
      REQUIRE(distance_to(corners, a.translation) > stand_off - 1e-6);
      REQUIRE((b.translation - a.translation).norm() < 1.01 * path.length() / n);
      REQUIRE(angle_between(a, b) < 0.5);
      REQUIRE(std::abs(a.rotation(2, 0)) < 1e-9);  // the horizon is level
    }
    const auto plan = survey::fly(
        path, {.min_distance = 0.99 * stand_off, .clearance = survey::clearance_rule::refuse},
        &space);
    const auto report = survey::measure(views_of(plan), walls, sight, {.samples = 1000});
    CHECK(report.seen_by(1) == 1);
    CHECK(report.seen_within(math::radians(46)) == 1);  // in an inner corner 45 degrees
    std::vector<double> overlap;                        // where the camera turns into a corner
    for (std::size_t i = 0; i + 1 < plan.trajectory.size(); ++i) {
      const auto& a = plan.trajectory.world_from_camera[i];
      const auto& b = plan.trajectory.world_from_camera[i + 1];
      const Eigen::Vector3d next = a.rotation.transpose() * b.rotation.col(2);
      const Eigen::Vector3d way = a.rotation.transpose() * (b.translation - a.translation);
      if (next.x() * way.x() > 1e-9) overlap.push_back(report.overlap[i]);
    }
    std::sort(overlap.begin(), overlap.end());
    CHECK(overlap.size() > 8);
    CHECK(overlap[overlap.size() / 2] > plan.overlap - 0.03);
    CHECK(overlap.front() > plan.overlap - 0.1);
  }
}

TEST_CASE("the way round any footprint closes, goes round once and keeps the stand-off") {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    random_engine random(seed);
    const double n = std::floor(random.uniform(3, 16)), stand_off = random.uniform(0.2, 8);
    std::vector<Eigen::Vector2d> corners;
    for (double i = 0; i < n; ++i) {
      const double angle = 2 * std::numbers::pi * (i + 0.3 * random.uniform()) / n;
      corners.push_back(random.uniform(2, 20) * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
    }
    const auto around = survey::outline(corners, stand_off);
    double turned = 0;
    Eigen::Vector3d last = around.back().way.at(1).translation;
    for (const auto& piece : around) {
      REQUIRE((piece.way.at(0).translation - last).norm() < 1e-6);
      for (double share = 0; share <= 1; share += 0.125) {
        const Eigen::Vector3d next = piece.way.at(share).translation;
        REQUIRE(distance_to(corners, next) > stand_off - 1e-6);
        turned += std::atan2(last.cross(next).z(), last.dot(next));
        last = next;
      }
    }
    REQUIRE(turned == doctest::Approx(2 * std::numbers::pi));
  }
}

TEST_CASE("an opening that is too narrow to fly into is passed by") {
  const auto corners = u_shape(4);
  const auto path = survey::facade({corners, 0, 1}, {.path = {.stand_off = 3}});
  double deepest = HUGE_VAL;  // before the middle of the opening
  for (double i = 0; i <= 20000; ++i) {
    const Eigen::Vector3d p = path.at(i / 20000).translation;
    REQUIRE(distance_to(corners, p) > 3 - 1e-6);
    if (p.x() > 0 && std::abs(p.y() - 7) < 0.01) deepest = std::min(deepest, p.x());
  }
  CHECK(std::abs(deepest - (20 + std::sqrt(9.0 - 4.0))) < 0.01);
  const survey::facade_options inner{.path = {.stand_off = 3}, .sides = {{3, 3}}};
  CHECK_THROWS_AS(static_cast<void>(survey::facade({corners, 0, 1}, inner)), argument_error);
}

TEST_CASE("some sides of a footprint are flown from the first to the last of them") {
  const auto path =
      survey::facade({l_shape, 0, 0.5}, {.path = {.stand_off = 2}, .sides = {{2, 3}}});
  CHECK((path.at(0).translation.head<2>() - Eigen::Vector2d(20, 12)).norm() < 1e-9);
  CHECK((path.at(1).translation.head<2>() - Eigen::Vector2d(12, 20)).norm() < 1e-9);
  CHECK(path.length() == doctest::Approx(16));
  CHECK(path.n_rows == 1);
}

TEST_CASE("a pitch looks down at the same rows from higher up") {
  const double pitch = 0.3;
  const auto rows =
      survey::facade(survey::footprint_of(office), {.path = {.stand_off = 6, .pitch = pitch}});
  const auto pass =
      survey::linear({.path = {.stand_off = 6, .pitch = pitch},
                      .from = {-9, -10, rows.at(0).translation.z() - 6 * std::tan(pitch)},
                      .to = {9, -10, rows.at(0).translation.z() - 6 * std::tan(pitch)},
                      .views = {{0, 1, 0}}});
  for (const auto& path : {rows, pass}) {
    const auto pose = path.at(0.001);
    CHECK(pose.rotation(2, 2) == doctest::Approx(-std::sin(pitch)));
    CHECK(pose.translation.z() ==
          doctest::Approx(survey::frame_on_wall(path.camera, 6).height / 2 + 6 * std::tan(pitch)));
    CHECK(pose.translation.y() == doctest::Approx(-16));
  }
}

TEST_CASE("as many frames as are asked for, evenly") {
  for (const std::size_t n : {4763u, 642u, 1074u, 2u}) {
    const auto plan = survey::fly(office_path(5.6), {.frames = n});
    CHECK(plan.trajectory.size() == n);
    CHECK(plan.trajectory.names.size() == n);
    CHECK(plan.step * static_cast<double>(n - 1) == doctest::Approx(plan.length));
  }
  const auto plan = survey::fly(office_path(5.6), {.overlap = 0.8});
  CHECK(plan.overlap >= 0.8);
  CHECK(survey::fly(office_path(5.6), {.frames = plan.trajectory.size()}).overlap ==
        doctest::Approx(plan.overlap));
  CHECK(plan.trajectory.names[12] == "000012.png");
  const auto circle = survey::orbit({.path = {.stand_off = 8}, .radius = 8});
  const auto closed = survey::fly(circle, {.frames = 10});
  CHECK(angle_between(closed.trajectory.world_from_camera.front(),
                      closed.trajectory.world_from_camera.back()) ==
        doctest::Approx(2 * std::numbers::pi / 10));
  CHECK_THROWS_AS(static_cast<void>(survey::fly(circle, {.overlap = 1})), argument_error);
  CHECK_THROWS_AS(static_cast<void>(survey::fly(circle, {.frames = 0})), argument_error);
}

TEST_CASE("planned and measured overlap are within 3 percentage points on a wall") {
  const mesh::mesh wall = box({-20, 0, 0}, {20, 1, 6});
  const mesh::ray_surface surface(wall);
  for (const double overlap : {0.6, 0.8, 0.9}) {
    const auto pass = survey::linear(
        {.path = {.stand_off = 5}, .from = {-12, 0, 3}, .to = {12, 0, 3}, .views = {{0, 1, 0}}});
    const auto plan = survey::fly(pass, {.overlap = overlap});
    const auto report = survey::measure(views_of(plan), wall, surface, {.samples = 200});
    for (const double measured : report.overlap) CHECK(std::abs(measured - plan.overlap) < 0.03);
    CHECK(std::abs(plan.overlap - overlap) < 0.03);
  }
  // Rows overlap as planned as well: fly up and down.
  const auto climb = survey::linear(
      {.path = {.stand_off = 5}, .from = {0, 0, 1.5}, .to = {0, 0, 4.5}, .views = {{0, 1, 0}}});
  const auto plan = survey::fly(climb, {.overlap = 0.75});
  for (const double measured :
       survey::measure(views_of(plan), wall, surface, {.samples = 200}).overlap)
    CHECK(std::abs(measured - plan.overlap) < 0.03);
}

TEST_CASE("a flight round the walls sees them from everywhere, and nothing of roof and floor") {
  const mesh::ray_surface surface(office);
  const auto plan = survey::fly(office_path(12), {.overlap = 0.7});
  const auto report = survey::measure(views_of(plan), office, surface,
                                      {.labels = {0}, .samples = 2000, .columns = 64, .rows = 5});
  CHECK(report.area == doctest::Approx(2 * 50 * 15));
  CHECK(report.seen_by(1) == 1);
  CHECK(report.seen_by(3) > 0.99);
  CHECK(report.seen_within(0.5) == 1);
  CHECK(report.seen_by(1000) == 0);
  for (const float gsd : report.gsd) CHECK(gsd >= 0.99f * static_cast<float>(plan.gsd));
  // Along the walls as planned; round the corners the camera looks at the same edge for longer, but
  // one wall hides behind the other.
  const auto& poses = plan.trajectory.world_from_camera;
  for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
    if (poses[i].translation.z() != poses[i + 1].translation.z()) continue;
    const bool straight = angle_between(poses[i], poses[i + 1]) < 1e-9;
    const bool at_end = straight && (std::abs(std::abs(poses[i].translation.x()) - 15) < 9 ||
                                     std::abs(std::abs(poses[i].translation.y()) - 10) < 9);
    if (straight && !at_end) CHECK(std::abs(report.overlap[i] - plan.overlap) < 0.03);
    CHECK(report.overlap[i] > plan.overlap - 0.15);
  }
  const auto flat = survey::measure(views_of(plan), office, surface,
                                    {.labels = {1}, .samples = 500, .columns = 4, .rows = 2});
  CHECK(flat.seen_by(1) < 0.01);
  CHECK(flat.gsd.empty());
  CHECK(std::isnan(flat.overlap.front()));
  const auto alone = survey::measure(views_of(plan), office, surface,
                                     {.samples = 500, .columns = 4, .rows = 2, .threads = 1});
  const auto many = survey::measure(views_of(plan), office, surface,
                                    {.samples = 500, .columns = 4, .rows = 2, .threads = 3});
  CHECK(alone.overlap == many.overlap);
  CHECK(alone.gsd == many.gsd);
  CHECK(alone.seen_by(2) == many.seen_by(2));
}

TEST_CASE("frames keep away from what stands in their way, or the plan says what does") {
  mesh::mesh with_pillar = office;
  const mesh::mesh pillar = box({-1, -17, 0}, {1, -16.5, 20});
  for (const auto& [a, b, c] : pillar.triangles)
    with_pillar.triangles.push_back({a + 8, b + 8, c + 8});
  with_pillar.vertices.insert(with_pillar.vertices.end(), pillar.vertices.begin(),
                              pillar.vertices.end());
  with_pillar.labels.clear();
  const mesh::surface_index distance(with_pillar);
  const mesh::ray_surface sight(with_pillar);
  const survey::flight_space space{distance, sight};
  const auto path = office_path(5);
  const auto pushed = survey::fly(path, {.min_distance = 2}, &space);
  CHECK(pushed.n_pushed > 0);
  CHECK(pushed.largest_push < 2.1);
  CHECK(*pushed.min_distance >= 1.5);
  for (const math::rigid3& pose : pushed.trajectory.world_from_camera) {
    const Eigen::Vector3d near = pose.translation.cwiseMax(Eigen::Vector3d(-1, -17, 0))
                                     .cwiseMin(Eigen::Vector3d(1, -16.5, 20));
    CHECK((pose.translation - near).norm() >= 2);
  }
  using survey::clearance_rule;
  CHECK_THROWS_AS(static_cast<void>(survey::fly(
                      path, {.min_distance = 2, .clearance = clearance_rule::refuse}, &space)),
                  undefined_error);
  CHECK(survey::fly(path, {.min_distance = 1, .clearance = clearance_rule::refuse}, &space)
            .n_pushed == 0);
  CHECK_THROWS_AS(static_cast<void>(survey::fly(path, {.min_distance = 2})), argument_error);
}

TEST_CASE("the camera aims along the normal, no faster than the gimbal turns") {
  // A roof of 45 degrees, passed by a camera that the path lets look level.
  mesh::mesh roof;
  roof.vertices = {{-50, 0, 0}, {50, 0, 0}, {50, 20, 20}, {-50, 20, 20}};
  roof.triangles = {{0, 1, 2}, {0, 2, 3}};
  const mesh::surface_index distance(roof);
  const mesh::ray_surface sight(roof);
  const survey::flight_space space{distance, sight};
  const auto path =
      survey::along({{-20, -2, 8}, {20, -2, 8}}, {{0, 1, 0}, {0, 1, 0}}, {.stand_off = 8});
  using survey::aim_rule;
  const auto plan = survey::fly(path, {.frames = 50, .aim = aim_rule::normal}, &space);
  const Eigen::Vector3d against = Eigen::Vector3d(0, 1, -1).normalized();
  for (const math::rigid3& pose : plan.trajectory.world_from_camera)
    CHECK((pose.rotation.col(2) - against).norm() < 1e-6);
  CHECK(plan.n_gimbal_limited == 0);

  const auto turning =
      survey::along({{-20, -9, 8}, {0, -9, 8}, {0.1, -9, 8}, {20, -9, 8}},
                    {{0, 1, 0}, {0, 1, 0}, {1, 1, 0}, {1, 1, 0}}, {.stand_off = 9});
  const double rate = 0.2;
  using survey::gimbal_rule;
  const auto fly = [&](gimbal_rule gimbal) {
    return survey::fly(turning, {.frames = 200, .speed = 2, .gimbal_rate = rate, .gimbal = gimbal});
  };
  const auto slow = fly(gimbal_rule::slow), lagging = fly(gimbal_rule::lag);
  for (const auto& plan_of_rule : {slow, lagging}) {
    const auto& t = plan_of_rule.trajectory;
    for (std::size_t i = 1; i < t.size(); ++i) {
      const double time = t.stamps_s[i] - t.stamps_s[i - 1];
      CHECK(angle_between(t.world_from_camera[i - 1], t.world_from_camera[i]) <=
            rate * time + 1e-6);
    }
    CHECK(angle_between(t.world_from_camera.back(), turning.at(1)) < 1e-6);
    CHECK(plan_of_rule.n_gimbal_limited > 5);
    CHECK(plan_of_rule.view_lag.size() == t.size());
  }
  // 45 degrees in 0.1 m, which would take 0.05 s.
  const double delay = std::numbers::pi / 4 / rate - 0.05;
  CHECK(slow.gimbal_delay_s == doctest::Approx(delay).epsilon(0.05));
  CHECK(slow.duration_s == doctest::Approx(20 + delay).epsilon(0.01));
  CHECK(*std::max_element(slow.view_lag.begin(), slow.view_lag.end()) == 0);
  CHECK(lagging.gimbal_delay_s == 0);
  CHECK(lagging.duration_s == doctest::Approx(20));
  CHECK(*std::max_element(lagging.view_lag.begin(), lagging.view_lag.end()) > 0.6);
  for (std::size_t i = 0; i < slow.trajectory.size(); ++i) {
    CHECK(angle_between(slow.trajectory.world_from_camera[i],
                        lagging.trajectory.world_from_camera[i]) ==
          doctest::Approx(lagging.view_lag[i]));
  }
}

TEST_CASE("frames are nearer to each other where the camera turns into its way") {
  // A turn that adds to the way moves the image as much again; at its edge, which is 0.36 of the
  // distance aside, by so much of the square more.
  const double turn = 0.3, length = turn * 5;
  const auto turning =
      survey::along({{0, 0, 0}, {length, 0, 0}}, {{0, 1, 0}, {std::sin(turn), std::cos(turn), 0}},
                    {.stand_off = 5});
  const auto straight =
      survey::along({{0, 0, 0}, {length, 0, 0}}, {{0, 1, 0}, {0, 1, 0}}, {.stand_off = 5});
  const double n = static_cast<double>(survey::fly(straight, {.overlap = 0.99}).trajectory.size());
  const auto n_turning = survey::fly(turning, {.overlap = 0.99}).trajectory.size();
  CHECK(static_cast<double>(n_turning) / n == doctest::Approx(2 + 0.36 * 0.36).epsilon(0.02));
}

TEST_CASE("a report tells how far views are from facing the surface") {
  const mesh::mesh wall = box({-20, 0, 0}, {20, 1, 6});
  const mesh::ray_surface surface(wall);
  const math::camera camera = survey::camera_of({});
  std::vector<math::view> views;
  for (const double angle : {0.0, 0.2, 3.1})
    views.push_back({camera, {survey::looking({std::sin(angle), std::cos(angle), 0}), {0, -5, 3}}});
  const auto report = survey::measure(views, wall, surface, {.samples = 10});
  REQUIRE(report.off_normal.size() == 3);
  CHECK(report.off_normal[0] == doctest::Approx(0));
  CHECK(report.off_normal[1] == doctest::Approx(0.2));
  CHECK(std::isnan(report.off_normal[2]));
}

}  // namespace test_flight

TEST_CASE("local places become places on the ellipsoid and back") {
  // Poles and equator: the axes of WGS84.
  CHECK(math::earth_from({0, 0, 0}).x() == doctest::Approx(6378137));
  CHECK(math::earth_from({std::numbers::pi / 2, 0, 0}).z() == doctest::Approx(6356752.314245));
  const math::geodetic munich{math::radians(48.1), math::radians(11.5), 520};
  const Eigen::Vector3d local(300, -200, 40);
  const math::geodetic there = math::geodetic_from_local(local, munich);
  // Along a meridian and a parallel, by the radii of curvature there.
  const double sine = std::sin(munich.latitude), e2 = math::wgs84::eccentricity2;
  const double normal = math::wgs84::major / std::sqrt(1 - e2 * sine * sine);
  const double meridian = normal * (1 - e2) / (1 - e2 * sine * sine);
  CHECK((there.latitude - munich.latitude) * (meridian + 520) ==
        doctest::Approx(-200).epsilon(1e-3));
  CHECK((there.longitude - munich.longitude) * (normal + 520) * std::cos(munich.latitude) ==
        doctest::Approx(300).epsilon(1e-3));
  CHECK(there.altitude == doctest::Approx(560.01).epsilon(1e-5));
  const math::geodetic again = math::geodetic_from(math::earth_from(there));
  CHECK(std::abs(again.latitude - there.latitude) < 1e-15);
  CHECK(std::abs(again.altitude - there.altitude) < 1e-8);
}

TEST_CASE("waypoints tell place, heading and pitch in three formats") {
  const support::scratch scratch;
  const auto plan = survey::fly(
      survey::along({{0, 0, 10}, {10, 0, 10}}, {{1, 0, 0}, {1, 0, -1}}, {.stand_off = 5}),
      {.frames = 3, .gimbal_rate = 9});
  const io::waypoint_options how{.origin = {math::radians(48.0), math::radians(11.0), 500}};
  const auto points = io::waypoints(plan.trajectory, how);
  REQUIRE(points.size() == 3);
  CHECK(points[0].latitude == doctest::Approx(48));
  CHECK(points[0].altitude == doctest::Approx(510));
  CHECK(points[0].heading == doctest::Approx(90));
  CHECK(std::abs(points[1].pitch + 22.5) < 10);
  CHECK(points[2].pitch == doctest::Approx(-45));
  const auto text_of = [&](const char* name) {
    io::write_waypoints(scratch.folder() / name, plan.trajectory, how);
    return io::read_file(scratch.folder() / name);
  };
  const auto count = [](const std::string& text, const std::string& part) {
    std::size_t n = 0;
    for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
    return n;
  };
  CHECK(count(text_of("w.csv"), "\n") == 4);
  CHECK(count(text_of("w.kml"), "<Placemark>") == 4);
  const std::string mission = text_of("w.plan");
  CHECK(count(mission, "\"command\": 16,") == 3);
  CHECK(count(mission, "\"command\": 2000,") == 3);
  CHECK(count(mission, "{") == count(mission, "}"));
  CHECK_THROWS_AS(text_of("w.txt"), argument_error);
  CHECK_THROWS_AS(io::write_waypoints(scratch.folder() / "w.csv", {}, how), argument_error);
}
