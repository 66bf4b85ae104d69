// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/cloud/compare.hpp>
#include <aib/core/random.hpp>
#include <aib/mesh/distances.hpp>
#include <aib/sample/voxel.hpp>

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstddef>
#include <cstdint>

using namespace aib;

namespace {

/// A wavy sheet of 60 by 60 with noise and five per cent of strays, in random order.
cloud::cloud sheet(std::size_t n, double noise, std::uint64_t seed) {
  random_engine random(seed);
  cloud::cloud c;
  c.points.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    const bool stray = noise > 0 && random.uniform() < 0.05;
    const double x = random.uniform(0, 60), y = random.uniform(0, 60);
    const double z = stray ? random.uniform(-10, 10) : std::sin(x) + noise * random.normal();
    c.points.emplace_back(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
  }
  return c;
}

void compare(benchmark::State& state) {
  const auto n = static_cast<std::size_t>(state.range(0));
  const cloud::cloud reference = sheet(n, 0, 1), estimate = sheet(n, 0.01, 2);
  for (auto _ : state) {
    benchmark::DoNotOptimize(cloud::compare(estimate, reference, {.tau = {0.02}}).chamfer);
  }
  state.SetItemsProcessed(state.iterations() * 2 * state.range(0));
}
BENCHMARK(compare)->Arg(100'000)->Arg(1'000'000)->Unit(benchmark::kMillisecond)->UseRealTime();

void truncated(benchmark::State& state) {
  const auto n = static_cast<std::size_t>(state.range(0));
  const cloud::cloud reference = sheet(n, 0, 1), estimate = sheet(n, 0.01, 2);
  for (auto _ : state) {
    benchmark::DoNotOptimize(cloud::compare(estimate, reference, {.max_distance = 0.1}).chamfer);
  }
  state.SetItemsProcessed(state.iterations() * 2 * state.range(0));
}
BENCHMARK(truncated)->Arg(1'000'000)->Unit(benchmark::kMillisecond)->UseRealTime();

void voxel(benchmark::State& state) {
  const cloud::cloud c = sheet(static_cast<std::size_t>(state.range(0)), 0.01, 2);
  for (auto _ : state) benchmark::DoNotOptimize(sample::voxel(c, {.size = 0.05}).size());
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(voxel)->Arg(1'000'000)->Unit(benchmark::kMillisecond)->UseRealTime();

/// The sheet as a mesh of 2 n^2 triangles.
mesh::mesh sheet_mesh(std::uint32_t n) {
  mesh::mesh m;
  const float step = 60 / static_cast<float>(n);
  for (std::uint32_t i = 0; i <= n; ++i) {
    for (std::uint32_t j = 0; j <= n; ++j) {
      const float x = static_cast<float>(i) * step;
      m.vertices.emplace_back(x, static_cast<float>(j) * step, std::sin(x));
      if (i == n || j == n) continue;
      const std::uint32_t a = i * (n + 1) + j, b = a + n + 1;
      m.triangles.push_back({a, b, b + 1});
      m.triangles.push_back({a, b + 1, a + 1});
    }
  }
  return m;
}

void to_mesh(benchmark::State& state) {
  const mesh::mesh m = sheet_mesh(150);
  const cloud::cloud c = sheet(static_cast<std::size_t>(state.range(0)), 0.01, 2);
  for (auto _ : state) benchmark::DoNotOptimize(mesh::distances(c, m).mean());
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(to_mesh)->Arg(100'000)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
