// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT

// time_cloud ESTIMATE.ply REFERENCE.ply [THREADS] [STRAYS]
// Seconds that reading takes, both directions of distances (reading excluded), and voxels of 5 cm;
// bytes a point of the index. STRAYS are put 100 km away. Run by peers_cloud.sh beside other
// programs.
#include <aib/cloud/compare.hpp>
#include <aib/core/isa.hpp>
#include <aib/io/ply.hpp>
#include <aib/sample/voxel.hpp>

#include <chrono>
#include <cstddef>
#include <cstdio>
#include <cstdlib>

namespace {

class stopwatch {
 public:
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

double index_bytes_a_point(const aib::cloud::cloud& c) {
  const auto order = aib::search::common_curve(c.points, {});
  return static_cast<double>(aib::search::box_tree(c.points, order).bytes()) /
         static_cast<double>(c.size());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  const unsigned threads = argc > 3 ? static_cast<unsigned>(std::atoi(argv[3])) : 0;
  const int strays = argc > 4 ? std::atoi(argv[4]) : 0;
  const stopwatch reading;
  auto estimate = aib::io::read_ply_cloud(argv[1]);
  const auto reference = aib::io::read_ply_cloud(argv[2]);
  const double read = reading.seconds();
  for (int i = 1; i <= strays; ++i) {
    const auto far = static_cast<float>(100'000 + i);
    estimate.points.push_back({far, -far, far});
  }
  const stopwatch comparing;
  const auto both = aib::cloud::distances_both_ways(estimate, reference, {.threads = threads});
  const double accuracy = both.to_reference.mean();
  const double completeness = both.to_estimate.mean();
  const double compared = comparing.seconds();
  const stopwatch thinning;
  const std::size_t voxels =
      strays > 0 ? 0 : aib::sample::voxel(estimate, {.size = 0.05, .threads = threads}).size();
  const double thinned = thinning.seconds();
  std::printf("aib %s total %.4f read %.4f voxel %.4f (%zu) index %.2f acc %.9f comp %.9f\n",
              aib::instruction_set, compared, read, thinned, voxels, index_bytes_a_point(reference),
              accuracy, completeness);
}
