// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT

// time_cloud ESTIMATE.ply REFERENCE.ply [THREADS]
// Seconds that both directions take, reading excluded; run by peers_cloud.sh beside other programs.
#include <aib/cloud/compare.hpp>
#include <aib/io/ply.hpp>

#include <chrono>
#include <cstdio>
#include <cstdlib>

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  const auto estimate = aib::io::read_ply_cloud(argv[1]);
  const auto reference = aib::io::read_ply_cloud(argv[2]);
  const unsigned threads = argc > 3 ? static_cast<unsigned>(std::atoi(argv[3])) : 0;
  const auto start = std::chrono::steady_clock::now();
  const auto both = aib::cloud::distances_both_ways(estimate, reference, {.threads = threads});
  const double accuracy = both.to_reference.mean();
  const double completeness = both.to_estimate.mean();
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  std::printf("aib total %.4f acc %.9f comp %.9f\n", seconds.count(), accuracy, completeness);
}
