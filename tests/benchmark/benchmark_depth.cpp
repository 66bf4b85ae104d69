// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/depth/errors.hpp>
#include <aib/depth/fit.hpp>

#include <benchmark/benchmark.h>

#include "depth_frames.hpp"

using namespace aib;

namespace {

void errors(benchmark::State& state, depth::alignment align) {
  const frame_pair f = made_frame(0);
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        depth::errors(f.estimate.view(), f.reference.view(), {.align = align}).srmse);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(f.estimate.size()));
}
BENCHMARK_CAPTURE(errors, as_they_are, depth::alignment::none)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(errors, log_fit, depth::alignment::log)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(errors, median_fit, depth::alignment::median)->Unit(benchmark::kMillisecond);

void srmse(benchmark::State& state) {
  const frame_pair f = made_frame(0);
  for (auto _ : state)
    benchmark::DoNotOptimize(depth::srmse(f.estimate.view(), f.reference.view()));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(f.estimate.size()));
}
BENCHMARK(srmse)->Unit(benchmark::kMillisecond);

}  // namespace
