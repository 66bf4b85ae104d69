// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/align/icp.hpp>
#include <aib/cloud/transform.hpp>
#include <aib/core/random.hpp>
#include <aib/io/ply.hpp>

#include <doctest/doctest.h>

#include <support/shared.hpp>
#include <support/stopped.hpp>

#ifdef AIB_WITH_JSON
#include <nlohmann/json.hpp>
#endif

#include <cmath>
#include <filesystem>
#include <fstream>

using namespace aib;

namespace test_icp {

namespace {

/// Points on a wavy sheet with its normals.
cloud::cloud sheet(std::size_t n, std::uint64_t seed) {
  random_engine random(seed);
  cloud::cloud c;
  for (std::size_t i = 0; i < n; ++i) {
    const double x = random.uniform(-2, 2), y = random.uniform(-2, 2);
    const double z = 0.5 * std::sin(2 * x) * std::cos(y);
    c.points.emplace_back(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
    const double dx = std::cos(2 * x) * std::cos(y), dy = -0.5 * std::sin(2 * x) * std::sin(y);
    const Eigen::Vector3d normal = Eigen::Vector3d(-dx, -dy, 1).normalized();
    c.normals.emplace_back(normal.cast<float>());
  }
  return c;
}

const math::sim3 small_motion{
    1, math::rotation_from(Eigen::Vector3d(0.02, -0.03, 0.04)), {0.03, 0.02, -0.01}};

double difference(const math::sim3& a, const math::sim3& b) {
  return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff();
}

}  // namespace

TEST_CASE("a moved copy is brought back by points and by planes") {
  const cloud::cloud reference = sheet(5000, 1);
  const cloud::cloud estimate = small_motion.inverse() * reference;
  const auto points = align::icp(estimate, reference, {.max_distance = {0.5}});
  CHECK(difference(points.transform, small_motion) < 1e-5);
  CHECK(points.fitness == 1);
  CHECK(points.converged);
  const auto planes =
      align::icp(estimate, reference, {.max_distance = {0.5}, .metric = align::icp_metric::plane});
  CHECK(difference(planes.transform, small_motion) < 1e-5);
  CHECK(planes.n_iterations < points.n_iterations);
}

TEST_CASE("planes bring another sampling of the surface into place") {
  const auto r = align::icp(small_motion.inverse() * sheet(4000, 2), sheet(20000, 3),
                            {.max_distance = {0.5, 0.1}, .metric = align::icp_metric::plane});
  CHECK(difference(r.transform, small_motion) < 2e-3);
}

TEST_CASE("scale is found where it is asked for, in map coordinates as well") {
  cloud::cloud reference = sheet(5000, 4);
  reference.origin = {458000, 5429000, 100};
  const math::sim3 to_local{1, Eigen::Matrix3d::Identity(), -reference.origin};
  math::sim3 motion = small_motion;
  motion.scale = 1.02;
  const math::sim3 in_world = to_local.inverse() * motion * to_local;
  const cloud::cloud estimate = in_world.inverse() * reference;
  const auto r = align::icp(estimate, reference, {.max_distance = {0.5}, .with_scale = true});
  CHECK(r.transform.scale == doctest::Approx(1.02).epsilon(1e-5));
  CHECK(r.rmse < 1e-3);
  const auto one = align::icp(estimate, reference, {.max_distance = {0.5}, .threads = 1});
  const auto three = align::icp(estimate, reference, {.max_distance = {0.5}, .threads = 3});
  CHECK(one.transform.matrix() == three.transform.matrix());
}

TEST_CASE("what cannot be registered is refused") {
  const cloud::cloud a = sheet(100, 5);
  cloud::cloud far = a;
  far.origin = {1000, 0, 0};
  CHECK_THROWS_AS(static_cast<void>(align::icp(a, a, {})), argument_error);
  CHECK_THROWS_AS(static_cast<void>(align::icp(a, a, {.max_distance = {0}})), argument_error);
  CHECK_THROWS_AS(static_cast<void>(align::icp(a, far, {.max_distance = {1}})), undefined_error);
  CHECK_THROWS_AS(static_cast<void>(align::icp({}, a, {.max_distance = {1}})), undefined_error);
  cloud::cloud bare = a;
  bare.normals.clear();
  CHECK_THROWS_AS(static_cast<void>(align::icp(
                      a, bare, {.max_distance = {1}, .metric = align::icp_metric::plane})),
                  argument_error);
}

#ifdef AIB_WITH_JSON
TEST_CASE("icp ends where Open3D's ends") {
  if (!support::has_shared("icp golden")) return;
  const auto golden = support::shared() / "golden";
  for (const auto& entry : std::filesystem::directory_iterator(golden / "cloud")) {
    if (entry.path().extension() != ".json") continue;
    std::ifstream stream(entry.path());
    const auto file = nlohmann::json::parse(stream);
    const auto read = [&](const char* which) {
      return io::read_ply_cloud(golden / file["inputs"][which].get<std::string>());
    };
    for (const auto& expected : file["expected"]["icp_open3d"]) {
      CAPTURE(entry.path().filename().string());
      const auto r = align::icp(read("est"), read("gt"),
                                {.max_distance = {expected["max_correspondence_distance"]},
                                 .with_scale = expected["with_scaling"]});
      const Eigen::Matrix4d found = r.transform.matrix();
      double worst = 0;
      for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) {
          const double value =
              expected["T"][static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
          worst = std::max(worst, std::abs(found(i, j) - value));
        }
      }
      CHECK(worst <= 1e-4);
      CHECK(r.fitness == doctest::Approx(expected["fitness"].get<double>()).epsilon(1e-9));
      CHECK(r.rmse == doctest::Approx(expected["inlier_rmse"].get<double>()).epsilon(1e-3));
    }
  }
}
#endif

TEST_CASE("icp stops, and tells how far it is") {
  const auto reference = sheet(500, 1);
  CHECK_THROWS_AS(
      (void)align::icp(reference, reference, {.max_distance = {1}, .control = support::stopped()}),
      stopped_error);
  std::vector<double> shares;
  (void)align::icp(
      reference, reference,
      {.max_distance = {1}, .control = {.progress = [&](double s) { shares.push_back(s); }}});
  CHECK(shares.size() >= 2);
  CHECK(shares.back() == 1);
}

}  // namespace test_icp
