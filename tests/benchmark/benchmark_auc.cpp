// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT

// AUC over all frame pairs. 4763 frames are 11.34 million pairs, 20000 are 200 million. The second
// number is the threads. peers_auc.sh times scripts of numpy and torch beside it.
#include <aib/core/isa.hpp>
#include <aib/core/random.hpp>
#include <aib/math/rotation.hpp>
#include <aib/pose/auc.hpp>
#include <aib/pose/worst_pairs.hpp>

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstddef>
#include <cstdint>

using namespace aib;

namespace {

Eigen::Vector3d normal3(random_engine& random) {
  const double x = random.normal(), y = random.normal(), z = random.normal();
  return {x, y, z};
}

/// Rows of a flight along a front, turned in every direction, a few degrees of noise.
pose::trajectory flight(std::size_t frames, double rotation, double position, std::uint64_t seed) {
  random_engine random(seed);
  pose::trajectory t;
  for (std::size_t i = 0; i < frames; ++i) {
    const auto at = static_cast<double>(i);
    const Eigen::Vector3d look(0.3 * std::sin(0.11 * at), 0.4 * std::cos(0.07 * at), 0.02 * at);
    const Eigen::Vector3d turn = rotation * normal3(random);
    const Eigen::Vector3d centre(50 * std::sin(0.03 * at), 12 * std::cos(0.005 * at), 0.002 * at);
    t.world_from_camera.push_back({math::rotation_from(look) * math::rotation_from(turn),
                                   centre + position * normal3(random)});
  }
  return t;
}

/// Runs `pose_metric(estimate, reference, threads)` over all pairs of the state's frames.
template <class Metric>
void over_all_pairs(benchmark::State& state, Metric&& pose_metric) {
  const auto frames = static_cast<std::size_t>(state.range(0));
  const pose::trajectory reference = flight(frames, 0, 0, 1), estimate = flight(frames, 0.1, 1, 2);
  const auto threads = static_cast<unsigned>(state.range(1));
  for (auto _ : state) benchmark::DoNotOptimize(pose_metric(estimate, reference, threads));
  state.SetItemsProcessed(state.iterations() * state.range(0) * (state.range(0) - 1) / 2);
  state.SetLabel(instruction_set);
}

template <pose::auc_convention Convention>
void auc(benchmark::State& state) {
  over_all_pairs(state, [](const auto& estimate, const auto& reference, unsigned threads) {
    return pose::auc(estimate, reference, {.convention = Convention, .threads = threads}).auc;
  });
}
BENCHMARK(auc<pose::auc_convention::paper>)
    ->ArgsProduct({{500, 4763, 20000}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK(auc<pose::auc_convention::exact>)
    ->Args({4763, 2})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK(auc<pose::auc_convention::colmap>)
    ->Args({4763, 2})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void worst_pairs(benchmark::State& state) {
  over_all_pairs(state, [](const auto& estimate, const auto& reference, unsigned threads) {
    return pose::worst_pairs(estimate, reference, {.threads = threads}).size();
  });
}
BENCHMARK(worst_pairs)->Args({4763, 2})->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
