// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT

/// time_render [TRIANGLES [THREADS]]   seconds of building the tree of a bumpy ground of about that
///                                     many triangles (1 000 000); full HD depth maps a second of
///                                     frames over it; shadow rays a second
#include <aib/core/random.hpp>
#include <aib/mesh/mesh.hpp>
#include <aib/mesh/ray_surface.hpp>
#include <aib/render/depth.hpp>

#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <string>

using namespace aib;

namespace {

template <class Work>
double seconds(Work work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// A square of 100 x 100, waves and noise of a decimetre on it.
mesh::mesh ground(std::uint32_t side) {
  mesh::mesh m;
  random_engine random(1);
  for (std::uint32_t y = 0; y <= side; ++y) {
    for (std::uint32_t x = 0; x <= side; ++x) {
      const double at_x = 100.0 * x / side - 50, at_y = 100.0 * y / side - 50;
      const double z = 3 * std::sin(at_x / 5) * std::cos(at_y / 7) + 0.02 * random.normal();
      m.vertices.push_back(Eigen::Vector3d(at_x, at_y, z).cast<float>());
    }
  }
  for (std::uint32_t y = 0; y < side; ++y) {
    for (std::uint32_t x = 0; x < side; ++x) {
      const std::uint32_t a = y * (side + 1) + x, b = a + side + 1;
      m.triangles.push_back({a, a + 1, b});
      m.triangles.push_back({a + 1, b + 1, b});
    }
  }
  return m;
}

math::rigid3 pose_of(int frame) {
  const Eigen::Vector3d tilt(2.5 - 0.03 * frame, 0, 0), turn(0, 0, 0.4 * frame);
  return {math::rotation_from(turn) * math::rotation_from(tilt), {2.0 * frame, -1.0 * frame, 30}};
}

}  // namespace

int main(int count, char** words) {
  const double triangles = count > 1 ? std::stod(words[1]) : 1e6;
  const auto threads = static_cast<unsigned>(count > 2 ? std::stoul(words[2]) : 0);
  const mesh::mesh m = ground(static_cast<std::uint32_t>(std::sqrt(triangles / 2)));
  const auto start = std::chrono::steady_clock::now();
  const mesh::ray_surface surface(m, threads);
  const std::chrono::duration<double> built = std::chrono::steady_clock::now() - start;
  std::printf("%zu triangles, tree %.2f s\n", surface.n_triangles(), built.count());

  const render::view_rays rays(math::pinhole(1920, 1080, 8000.0 / 3, 8000.0 / 3, 960, 540));
  constexpr int n_frames = 12;
  std::size_t n_hits = 0;
  const std::clock_t before = std::clock();
  const double spent = seconds([&] {
    for (int i = 0; i < n_frames; ++i) {
      const auto map = render::depth(surface, rays, pose_of(i), {}, {.threads = threads}).values;
      for (const float d : map) n_hits += d > 0;
    }
  });
  const double of_cpu = static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
  std::printf("%.1f full HD depth maps a second, %.3f s of CPU each, %.0f %% hit\n",
              n_frames / spent, of_cpu / n_frames,
              100.0 * static_cast<double>(n_hits) / (n_frames * 1920.0 * 1080.0));

  constexpr int n_rays = 300000;
  std::size_t n_seen = 0;
  random_engine random(2);
  const double alone = seconds([&] {
    for (int i = 0; i < n_rays; ++i) {
      const Eigen::Vector3d from(random.uniform(-40, 40), random.uniform(-40, 40), 20);
      const Eigen::Vector3d to(random.uniform(-40, 40), random.uniform(-40, 40), 0);
      n_seen += surface.sees(from, to, 0);
    }
  });
  std::printf("%.2f million shadow rays a second and thread, %.0f %% free\n", n_rays / alone / 1e6,
              100.0 * static_cast<double>(n_seen) / n_rays);
}
