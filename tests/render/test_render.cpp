// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/core/random.hpp>
#include <aib/io/depth.hpp>
#include <aib/io/mesh.hpp>
#include <aib/io/trajectory.hpp>
#include <aib/math/camera.hpp>
#include <aib/math/projection.hpp>
#include <aib/mesh/distances.hpp>
#include <aib/mesh/mesh.hpp>
#include <aib/mesh/ray_surface.hpp>
#include <aib/render/frame.hpp>
#include <aib/render/visible.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <support/shared.hpp>
#include <vector>

using namespace aib;

namespace test_render {

namespace {

/// The cube [-half, half]^3, two triangles a side, labels 0..5: -x, +x, -y, +y, -z, +z.
mesh::mesh cube(float half) {
  mesh::mesh m;
  for (int i = 0; i < 8; ++i) {
    m.vertices.emplace_back((i & 1) ? half : -half, (i & 2) ? half : -half, (i & 4) ? half : -half);
  }
  const std::uint32_t sides[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                     {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (std::uint32_t s = 0; s < 6; ++s) {
    const auto& q = sides[s];
    m.triangles.push_back({q[0], q[1], q[2]});
    m.triangles.push_back({q[0], q[2], q[3]});
    m.labels.insert(m.labels.end(), 2, s);
  }
  return m;
}

/// A closed sphere about the origin, its poles on z.
mesh::mesh sphere(std::uint32_t rows, double radius) {
  mesh::mesh m;
  const std::uint32_t columns = 2 * rows;
  for (std::uint32_t i = 1; i < rows; ++i) {
    for (std::uint32_t j = 0; j < columns; ++j) {
      const double polar = std::numbers::pi * i / rows, turn = 2 * std::numbers::pi * j / columns;
      const Eigen::Vector3d p(std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn),
                              std::cos(polar));
      m.vertices.push_back((radius * p).cast<float>());
    }
  }
  const auto top = static_cast<std::uint32_t>(m.vertices.size()), bottom = top + 1;
  m.vertices.emplace_back(0.0f, 0.0f, static_cast<float>(radius));
  m.vertices.emplace_back(0.0f, 0.0f, static_cast<float>(-radius));
  const auto at = [&](std::uint32_t i, std::uint32_t j) {
    if (i == 0) return top;
    return i == rows ? bottom : (i - 1) * columns + j % columns;
  };
  for (std::uint32_t i = 0; i < rows; ++i) {
    for (std::uint32_t j = 0; j < columns; ++j) {
      if (i > 0) m.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
      if (i + 1 < rows) m.triangles.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return m;
}

math::rigid3 pose_of(const Eigen::Vector3d& centre, const Eigen::Vector3d& axis_angle) {
  return {math::rotation_from(axis_angle), centre};
}

/// The nearest hit by trying every triangle (Moeller and Trumbore 1997), in doubles.
std::optional<double> brute_force(const mesh::mesh& m,
                                  const Eigen::Vector3d& from,
                                  const Eigen::Vector3d& direction) {
  std::optional<double> best;
  for (const auto& [a, b, c] : m.triangles) {
    const Eigen::Vector3d ab = m.position(b) - m.position(a), ac = m.position(c) - m.position(a);
    const Eigen::Vector3d p = direction.cross(ac), to = from - m.position(a), q = to.cross(ab);
    const double det = ab.dot(p), u = to.dot(p) / det, v = direction.dot(q) / det;
    const double distance = ac.dot(q) / det;
    const bool hit = u >= 0 && v >= 0 && u + v <= 1 && distance > 0;
    if (hit && (!best || distance < *best)) best = distance;
  }
  return best;
}

/// Triangles of many sizes anywhere in a cube.
mesh::mesh random_soup(std::size_t n, std::uint64_t seed) {
  mesh::mesh m;
  random_engine random(seed);
  for (std::size_t t = 0; t < n; ++t) {
    const double size = std::pow(10, random.uniform(-2, 0));
    const Eigen::Vector3d at(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d aside(random.normal(), random.normal(), random.normal());
      m.vertices.push_back((at + size / 4 * aside).cast<float>());
    }
    const auto first = static_cast<std::uint32_t>(3 * t);
    m.triangles.push_back({first, first + 1, first + 2});
  }
  return m;
}

/// Cameras of each kind of projection.
std::vector<math::camera> cameras(std::uint64_t w, std::uint64_t h) {
  using math::camera_model;
  const double x = static_cast<double>(w) / 2, y = static_cast<double>(h) / 2, f = 1.4 * x;
  return {math::pinhole(w, h, f, f, x, y),
          {camera_model::opencv, w, h, {f, f, x + 1, y - 2, -0.1, 0.02, 0.001, -0.002}},
          {camera_model::opencv_fisheye, w, h, {x / 2, x / 2, x, y, 0.01, 0, 0, 0}},
          {camera_model::eucm, w, h, {f, f, x, y, 0.6, 1.1}},
          {camera_model::equirectangular, w, h, {2 * x, 2 * y}}};
}

Eigen::Vector2d centre_of(std::size_t x, std::size_t y) {
  return {static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5};
}

}  // namespace

TEST_CASE("inside of a cube every camera sees the distance to its walls, to the last pixel") {
  const mesh::ray_surface surface(cube(2));
  const math::rigid3 pose = pose_of({0.5, -0.25, 1}, {0.3, -0.2, 0.7});
  for (const math::camera& camera : cameras(101, 75)) {
    const auto f = render::cast_frame(surface, render::view_rays(camera), pose);
    for (std::size_t y = 0; y < 75; ++y) {
      for (std::size_t x = 0; x < 101; ++x) {
        const auto ray = math::unproject(camera, centre_of(x, y));
        if (!ray) {
          CHECK(f.range.values(x, y) == 0);
          continue;
        }
        const Eigen::Vector3d d = pose.rotation * *ray;
        Eigen::Index wall = 0;
        const double expected =
            ((2 - pose.translation.array() * d.array().sign()) / d.array().abs()).minCoeff(&wall);
        REQUIRE(static_cast<double>(f.range.values(x, y)) ==
                doctest::Approx(expected).epsilon(3e-7));
        const double planar = expected * ray->z();
        REQUIRE(std::abs(static_cast<double>(f.depth.values(x, y)) - std::max(planar, 0.0)) < 2e-6);
        const std::size_t label = static_cast<std::size_t>(2 * wall + (d[wall] > 0));
        Eigen::Vector3d inwards = Eigen::Vector3d::Zero();
        inwards[wall] = d[wall] > 0 ? -1 : 1;
        const Eigen::Vector3d normal = pose.rotation * f.normals(x, y).cast<double>();
        if (f.labels(x, y) == label) REQUIRE((normal - inwards).norm() < 1e-6);
        CHECK(f.labels(x, y) == label);
      }
    }
  }
}

TEST_CASE("no ray finds a hole in a closed surface") {
  for (const std::uint32_t rows : {3u, 16u, 150u}) {
    const mesh::ray_surface surface(sphere(rows, 1));
    // The axes of the first pose go through a vertex in the middle of a pixel.
    const math::camera camera = math::pinhole(321, 241, 100, 100, 160.5, 120.5);
    const render::view_rays rays(camera);
    for (const math::rigid3& pose : {pose_of({0, 0, 0}, {0, 0, 0}), pose_of({0, 0, 0.5}, {0, 0, 0}),
                                     pose_of({0.2, 0.1, -0.3}, {1, 2, -0.5})}) {
      const auto f = render::cast_frame(surface, rays, pose);
      CHECK(f.n_seen() == 321 * 241);
    }
  }
  const mesh::mesh ball = sphere(16, 1);
  const mesh::ray_surface surface(ball);
  std::size_t n = 0;
  for (const auto& [a, b, c] : ball.triangles) {
    const Eigen::Vector3d from(0.1, 0.2, 0.05);
    const Eigen::Vector3d at_corner = ball.position(a) - from;
    const Eigen::Vector3d at_edge = (ball.position(b) + ball.position(c)) / 2 - from;
    n += surface.first_hit(from, at_corner).has_value();
    n += surface.first_hit(from, at_edge).has_value();
  }
  CHECK(n == 2 * ball.triangles.size());
}

TEST_CASE("both kinds of search find the hits of brute force") {
  const mesh::mesh soup = random_soup(700, 3);
  const mesh::ray_surface surface(soup);
  const math::camera camera = math::pinhole(97, 61, 60, 60, 48, 30);
  const math::rigid3 pose = pose_of({0.1, 0.2, -1.1}, {0.1, -0.1, 0.4});
  const auto map =
      render::depth(surface, render::view_rays(camera), pose, render::depth_kind::range);
  std::size_t n_different = 0, n_hit = 0;
  for (std::size_t y = 0; y < 61; ++y) {
    for (std::size_t x = 0; x < 97; ++x) {
      const Eigen::Vector3d direction = pose.rotation * *math::unproject(camera, centre_of(x, y));
      const double expected = brute_force(soup, pose.translation, direction).value_or(0);
      const auto single = surface.first_hit(pose.translation, direction);
      const double found = static_cast<double>(map.values(x, y));
      n_hit += expected > 0;
      n_different += std::abs(found - expected) > 1e-6 * expected;
      n_different += std::abs((single ? single->distance : 0) - expected) > 1e-9 * expected;
    }
  }
  CHECK(n_hit > 2000);
  CHECK(n_different == 0);
}

TEST_CASE("maps are the same bits for any number of threads, and far from zero") {
  mesh::mesh soup = random_soup(20000, 5);
  const render::view_rays rays(math::pinhole(160, 120, 150, 150, 80, 60));
  const math::rigid3 pose = pose_of({0, 0, -3}, {0, 0, 0});
  const mesh::ray_surface alone(soup, 1), surface(soup, 4);
  const auto one = render::depth(alone, rays, pose, render::depth_kind::planar, {.threads = 1});
  CHECK(one.values == render::depth(surface, rays, pose, {}, {.threads = 3}).values);
  soup.origin = {4.5e5, 5.8e6, 100};
  const math::rigid3 there{pose.rotation, pose.translation + soup.origin};
  CHECK(one.values == render::depth(mesh::ray_surface(soup), rays, there).values);
}

TEST_CASE("a map of another size sees the same field of view") {
  const mesh::ray_surface surface(cube(1));
  const math::camera camera = math::pinhole(200, 100, 150, 150, 100, 50);
  const math::rigid3 pose = pose_of({0, 0, -4}, {0, 0, 0});
  const auto full = render::depth(surface, render::view_rays(camera), pose).values;
  const auto small = render::depth(surface, render::view_rays(camera, 40, 20), pose).values;
  for (std::size_t y = 0; y < 20; ++y)
    for (std::size_t x = 0; x < 40; ++x) CHECK(small(x, y) == full(5 * x + 2, 5 * y + 2));
  CHECK_THROWS_WITH_AS(render::view_rays(math::pinhole(0, 0, 1, 1, 0, 0)),
                       "render: a width of 1 to 32767 pixels expected, found 0", argument_error);
}

TEST_CASE("a surface of nothing is undefined, a broken triangle is left out") {
  mesh::mesh m = cube(1);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  m.vertices.emplace_back(nan, 0.0f, 0.0f);
  m.triangles.push_back({0, 1, 8});
  m.labels.push_back(9);
  CHECK(mesh::ray_surface(m).n_triangles() == 12);
  m.triangles = {{0, 1, 8}};
  CHECK_THROWS_AS(mesh::ray_surface{m}, undefined_error);
  CHECK_THROWS_AS(mesh::ray_surface{mesh::mesh{}}, undefined_error);
  m = cube(1);
  m.labels.assign(12, 70000);
  CHECK_THROWS_AS(static_cast<void>(render::cast_frame(
                      mesh::ray_surface(m), render::view_rays(math::pinhole(8, 8, 8, 8, 4, 4)),
                      pose_of({0, 0, -4}, {0, 0, 0}))),
                  argument_error);
}

TEST_CASE("a wall seen from its edge ends where it ends") {
  mesh::mesh wall;
  wall.vertices = {{0, -1, 2}, {0, 1, 2}, {0, 1, 4}, {0, -1, 4}};
  wall.triangles = {{0, 1, 2}, {0, 2, 3}};
  const mesh::ray_surface surface(wall);
  const render::view_rays rays(math::pinhole(65, 65, 32, 32, 32.5, 32.5));
  const auto map = render::depth(surface, rays, pose_of({0, 0, 0}, {0, 0, 0})).values;
  for (std::size_t y = 0; y < 65; ++y) {
    for (std::size_t x = 0; x < 65; ++x) {
      const double slope = std::abs(static_cast<double>(y) - 32) / 32;
      if (x != 32 || slope > 0.5001) CHECK(map(x, y) == 0);
      if (map(x, y) > 0) CHECK((map(x, y) > 1.99999f && map(x, y) < 4.00001f));
    }
  }
}

TEST_CASE("views see the sides of a cube that are turned to them") {
  const mesh::mesh box = cube(1);
  const mesh::ray_surface surface(box);
  const math::camera camera = math::pinhole(100, 100, 100, 100, 50, 50);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<render::view> views{{camera, pose_of({0, 0, -5}, {0, 0, 0})},
                                        {camera, pose_of({-5, 0, 0}, {0, std::numbers::pi / 2, 0})},
                                        {camera, pose_of({nan, nan, nan}, {0, 0, 0})}};
  cloud::cloud points;
  points.points = {{0, 0, -1}, {-1, 0, 0}, {0, 0, 1}, {-0.999f, 0, -0.999f}, {0, 0, 0}, {0, 9, -1}};
  CHECK(render::n_views(surface, points, views) == std::vector<std::uint32_t>{1, 1, 0, 2, 0, 0});

  points.points = {{0, 0, -1.02f}, {0, 0, -2}, {0, 0, 0.5f}, {0, 0, 3}, {-3, 0.5f, 0}};
  using verdict = render::space_verdict;
  const auto distances = mesh::distances(points, box);
  std::vector<float> apart;
  for (std::size_t i = 0; i < points.size(); ++i) apart.push_back(static_cast<float>(distances[i]));
  CHECK(render::free_space(surface, points, apart, views) ==
        std::vector{verdict::surface, verdict::free, verdict::hidden, verdict::hidden,
                    verdict::free});
  CHECK_THROWS_AS(static_cast<void>(render::free_space(surface, points, {}, views)),
                  argument_error);
}

#ifdef AIB_WITH_EXR
TEST_CASE("depth equals Blender's, but for rays that pass an edge by a 500th of a pixel") {
  if (!support::has_shared("Blender's depth")) return;
  const math::camera camera = math::pinhole(480, 270, 2000.0 / 3, 2000.0 / 3, 240, 135);
  const render::view_rays rays(camera);
  for (const std::string scene : {"crane", "office"}) {
    const auto folder = support::shared() / "scenes" / "gt" / scene;
    const mesh::ray_surface surface(io::read_mesh(folder / "mesh.ply"));
    const auto poses = io::read_trajectory(folder / "poses").world_from_camera;
    std::size_t n_at_edges = 0, n_wrong = 0;
    double worst = 0;
    for (std::size_t i = 0; i < poses.size(); i += 15) {
      const std::string number = std::to_string(1000000 + i).substr(1);
      const auto truth = io::read_depth(folder / "depth" / (number + ".exr")).values;
      const auto found = render::depth(surface, rays, poses[i]).values;
      for (std::size_t y = 0; y < truth.height(); ++y) {
        for (std::size_t x = 0; x < truth.width(); ++x) {
          const double expected = static_cast<double>(truth(x, y));
          const auto error = [&](double depth) {
            return std::abs(depth - expected) / std::max(expected, 1e-9);
          };
          double e = error(static_cast<double>(found(x, y)));
          if (e < 1e-4) {
            worst = std::max(worst, e);
            continue;
          }
          ++n_at_edges;
          for (const double dx : {-0.002, 0.0, 0.002}) {
            for (const double dy : {-0.002, 0.0, 0.002}) {
              const Eigen::Vector2d aside = centre_of(x, y) + Eigen::Vector2d(dx, dy);
              const Eigen::Vector3d ray = *math::unproject(camera, aside);
              const auto hit = surface.first_hit(poses[i].translation, poses[i].rotation * ray);
              e = std::min(e, error(hit ? hit->distance * ray.z() : 0));
            }
          }
          n_wrong += e > 1e-3;
        }
      }
    }
    CHECK(worst < 1e-4);
    CHECK(n_wrong == 0);
    CHECK(n_at_edges < 200);  // of 650 000 pixels
  }
}
#endif

}  // namespace test_render
