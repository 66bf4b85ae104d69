// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/core/random.hpp>
#include <aib/math/rotation.hpp>
#include <aib/pose/trajectory.hpp>
#include <aib/raster/color.hpp>
#include <aib/stream/noisy_image.hpp>
#include <aib/survey/perturb.hpp>
#include <aib/survey/sensor_noise.hpp>

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <support/scratch.hpp>
#include <vector>

using namespace aib;

namespace test_noise {

namespace {

struct moments {
  double mean = 0, variance = 0;
};

template <class Values>
moments moments_of(const Values& values) {
  double sum = 0, squares = 0, n = 0;
  for (const auto v : values) {
    sum += static_cast<double>(v);
    ++n;
  }
  for (const auto v : values) squares += std::pow(static_cast<double>(v) - sum / n, 2);
  return {sum / n, squares / n};
}

pose::trajectory flight(std::size_t n, double frames_a_second) {
  pose::trajectory t;
  for (std::size_t i = 0; i < n; ++i) {
    const double s = static_cast<double>(i) / frames_a_second;
    t.world_from_camera.push_back(
        {math::rotation_from(Eigen::Vector3d(0.3, 0.01 * s, 0.1)), {2 * s, std::sin(s), 10}});
    t.stamps_s.push_back(s);
    t.names.push_back(std::to_string(i));
  }
  return t;
}

}  // namespace

TEST_CASE("counts have mean and variance of a Poisson distribution") {
  for (const double mean : {0.3, 5.0, 29.9, 30.1, 80.0, 5000.0}) {
    std::vector<double> counts;
    for (std::uint64_t i = 0; i < 40000; ++i) {
      random_engine random(random_bits(11, i));
      counts.push_back(survey::poisson(random, mean));
    }
    const moments m = moments_of(counts);
    const double deviation = std::sqrt(mean / 40000);
    CHECK(std::abs(m.mean - mean) < 4.5 * deviation);
    CHECK(m.variance == doctest::Approx(mean).epsilon(0.04));
  }
  random_engine random(1);
  CHECK(survey::poisson(random, 0) == 0);
}

TEST_CASE("noise of a gray card has the variance a x + b, and is clipped") {
  using gray16 = raster::image<std::uint16_t>;
  for (const double x : {0.02, 0.2, 0.6}) {
    const gray16 card(200, 200, static_cast<std::uint16_t>(std::lround(65535 * x)));
    for (const auto& [a, b] : {std::array{2e-4, 2e-6}, {1e-3, 0.0}, {0.0, 1e-4}}) {
      const auto noisy = survey::sensor_noise<std::uint16_t>(
          card, {.a = a, .b = b, .transfer = survey::transfer::linear});
      const moments m = moments_of(noisy);
      CHECK(m.mean / 65535 == doctest::Approx(x).epsilon(0.01));
      CHECK(m.variance / 65535 / 65535 == doctest::Approx(a * x + b).epsilon(0.05));
    }
  }
  const gray16 dark(50, 50, std::uint16_t{0});
  const auto noisy =
      survey::sensor_noise<std::uint16_t>(dark, {.b = 1e-4, .transfer = survey::transfer::linear});
  const auto zeros = std::count(noisy.begin(), noisy.end(), 0);
  CHECK(zeros > 1000);  // half of them lie below 0
  CHECK(zeros < 1500);
}

TEST_CASE("without noise an image stays as it is, in 8 bits and 16") {
  raster::color_image colors(16, 16);
  for (std::size_t i = 0; i < colors.size(); ++i) {
    const auto v = static_cast<std::uint8_t>(i);
    colors.data()[i] = {v, static_cast<std::uint8_t>(255 - v), 128};
  }
  CHECK(survey::sensor_noise<raster::rgb>(colors, {.a = 0, .b = 0}) == colors);
  raster::image<std::array<std::uint16_t, 3>> deep(256, 256);
  for (std::size_t i = 0; i < deep.size(); ++i) deep.data()[i].fill(static_cast<std::uint16_t>(i));
  CHECK(survey::sensor_noise<std::array<std::uint16_t, 3>>(deep, {.a = 0, .b = 0}) == deep);
  CHECK_THROWS_AS(static_cast<void>(survey::sensor_noise<raster::rgb>(colors, {.a = -1})),
                  argument_error);
}

TEST_CASE("noise belongs to seed, frame and pixel, not to order or threads") {
  const raster::color_image card(40, 30, {90, 120, 30});
  const auto noisy = [&](std::uint64_t seed, std::uint64_t frame, unsigned threads) {
    return survey::sensor_noise<raster::rgb>(
        card, {.a = 1e-3, .seed = seed, .frame = frame, .threads = threads});
  };
  const auto third = noisy(1, 3, 1);
  CHECK(noisy(1, 2, 4) != third);
  CHECK(noisy(2, 3, 4) != third);
  CHECK(noisy(1, 3, 4) == third);
}

TEST_CASE("nothing wrong with telemetry changes nothing") {
  const auto truth = flight(20, 5);
  const auto told = survey::perturb(truth, {});
  CHECK(told.names == truth.names);
  CHECK(told.stamps_s == truth.stamps_s);
  for (std::size_t i = 0; i < 20; ++i) {
    CHECK(told.world_from_camera[i].translation == truth.world_from_camera[i].translation);
    CHECK(told.world_from_camera[i].rotation == truth.world_from_camera[i].rotation);
  }
}

TEST_CASE("biases are what they say") {
  const auto truth = flight(20, 5);
  const auto told = survey::perturb(
      truth, {.position_bias = {1, 2, 3}, .yaw_bias = 0.2, .lever_arm = {0, 0, 0.5}});
  for (std::size_t i = 0; i < 20; ++i) {
    const auto &a = truth.world_from_camera[i], &b = told.world_from_camera[i];
    const Eigen::Vector3d expected =
        a.translation + Eigen::Vector3d(1, 2, 3) + 0.5 * a.rotation.col(2);
    CHECK((b.translation - expected).norm() < 1e-12);
    const Eigen::Vector3d turn = math::axis_angle_from(b.rotation * a.rotation.transpose());
    CHECK((turn - Eigen::Vector3d(0, 0, 0.2)).norm() < 1e-9);
  }
  const auto tilted = survey::perturb(truth, {.gimbal_bias = {0.1, 0, 0}});
  const auto& a = truth.world_from_camera[7].rotation;
  const Eigen::Vector3d own =
      math::axis_angle_from(a.transpose() * tilted.world_from_camera[7].rotation);
  CHECK((own - Eigen::Vector3d(0.1, 0, 0)).norm() < 1e-9);
}

TEST_CASE("a time offset tells the pose of another time") {
  const auto truth = flight(30, 5);
  const auto told = survey::perturb(truth, {.time_offset = 0.2});
  for (std::size_t i = 0; i + 1 < 30; ++i) {
    const Eigen::Vector3d gap =
        told.world_from_camera[i].translation - truth.world_from_camera[i + 1].translation;
    CHECK(gap.norm() < 1e-9);
  }
  const auto half = survey::perturb(truth, {.time_offset = 0.1});
  const Eigen::Vector3d middle =
      (truth.world_from_camera[3].translation + truth.world_from_camera[4].translation) / 2;
  CHECK((half.world_from_camera[3].translation - middle).norm() < 1e-9);
}

TEST_CASE("deviations, walks and gaps have the size that they are told") {
  const std::size_t n = 6000;
  const auto truth = flight(n, 4);
  const auto told = survey::perturb(
      truth, {.position_noise = {0.5, 0.1, 0}, .dropout = 0.2, .dropout_length = 5});
  std::vector<double> x, y;
  std::size_t n_gaps = 0, n_missing = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const bool missing = !told.world_from_camera[i].is_finite();
    n_missing += missing;
    n_gaps += missing && (i == 0 || told.world_from_camera[i - 1].is_finite());
    if (missing) continue;
    const Eigen::Vector3d e =
        told.world_from_camera[i].translation - truth.world_from_camera[i].translation;
    x.push_back(e.x());
    y.push_back(e.y());
    CHECK(std::abs(e.z()) < 1e-12);
  }
  CHECK(std::sqrt(moments_of(x).variance) == doctest::Approx(0.5).epsilon(0.05));
  CHECK(std::sqrt(moments_of(y).variance) == doctest::Approx(0.1).epsilon(0.05));
  CHECK(static_cast<double>(n_missing) / n == doctest::Approx(0.2).epsilon(0.15));
  CHECK(static_cast<double>(n_missing) / static_cast<double>(n_gaps) ==
        doctest::Approx(5).epsilon(0.15));

  const auto walk = survey::perturb(truth, {.position_walk = 0.3});
  std::vector<double> steps;
  for (std::size_t i = 4; i < n; i += 4) {
    const auto error = [&](std::size_t k) -> Eigen::Vector3d {
      return walk.world_from_camera[k].translation - truth.world_from_camera[k].translation;
    };
    for (int a = 0; a < 3; ++a) steps.push_back(error(i)[a] - error(i - 4)[a]);
  }
  CHECK(std::sqrt(moments_of(steps).variance) == doctest::Approx(0.3).epsilon(0.05));  // a second
}

TEST_CASE("errors of one kind stay the same when another is added") {
  const auto truth = flight(50, 5);
  const auto plain = survey::perturb(truth, {.seed = 4, .yaw_noise = 0.1});
  const auto more =
      survey::perturb(truth, {.seed = 4, .position_walk = 1, .yaw_noise = 0.1, .dropout = 0.3});
  for (std::size_t i = 0; i < 50; ++i)
    CHECK(plain.world_from_camera[i].rotation == more.world_from_camera[i].rotation);
  CHECK_THROWS_AS(static_cast<void>(survey::perturb(truth, {.dropout = 1.5})), argument_error);
  CHECK_THROWS_AS(static_cast<void>(survey::perturb(truth, {.position_walk = -1})), argument_error);
}

TEST_CASE("intrinsics drift by shares of the focal length") {
  const math::camera truth = math::pinhole(100, 80, 90, 95, 50, 40);
  const auto biased = survey::perturb_camera(truth, 3, {.focal_bias = 0.1});
  CHECK(biased[2].fx() == doctest::Approx(99));
  CHECK(biased[2].fy() == doctest::Approx(104.5));
  CHECK(biased[2].cx() == 50);
  std::vector<double> f;
  for (const auto& c : survey::perturb_camera(truth, 4000, {.focal_noise = 0.02}))
    f.push_back(c.fx() / 90);
  CHECK(std::sqrt(moments_of(f).variance) == doctest::Approx(0.02).epsilon(0.05));
  const auto walk = survey::perturb_camera(truth, 100, {.focal_walk = 0.01});
  CHECK(walk[0].fx() == 90);
  CHECK(walk[99].fx() != 90);
  const math::camera sphere{math::camera_model::equirectangular, 8, 4, {8, 4}};
  CHECK_THROWS_AS(static_cast<void>(survey::perturb_camera(sphere, 1, {})), argument_error);
}

}  // namespace test_noise

#ifdef AIB_WITH_PNG
TEST_CASE("a PNG of 16 bits stays one, another has 8") {
  const support::scratch scratch;
  const auto in = scratch.folder() / "in.png", out = scratch.folder() / "out.png";
  using deep = std::array<std::uint16_t, 3>;
  const raster::image<deep> card(20, 10, deep{1000, 30000, 65535});
  io::write_image<deep>(in, card.view());
  CHECK(io::read_png_color16(in) == card);
  stream::noisy_image(in, out, {.a = 0, .b = 0});
  CHECK(io::read_png_color16(out) == card);
  stream::noisy_image(in, out, {.seed = 5});
  CHECK(io::read_png_header(out).bits == 16);
  CHECK(io::read_png_color16(out) == survey::sensor_noise<deep>(card.view(), {.seed = 5}));
  io::write_image<raster::rgb>(in, raster::color_image(20, 10, {9, 8, 7}).view());
  stream::noisy_image(in, out);
  CHECK(io::read_png_header(out).bits == 8);
}
#endif
