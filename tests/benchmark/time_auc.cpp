// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT

// time_auc POSES.bin FRAMES [THREADS] [CONVENTION]
// Seconds that the AUC over all pairs takes, reading excluded; run by peers_auc.sh beside other
// programs. POSES.bin holds camera-from-world poses, 12 doubles each by rows: those of the
// reference, then as many of the estimate. Of the default convention also prints vggt's area.
#include <aib/core/isa.hpp>
#include <aib/pose/auc.hpp>

#include <chrono>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <sys/resource.h>
#include <vector>

using namespace aib;

namespace {

std::vector<double> numbers_of(const char* path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  std::vector<double> out(static_cast<std::size_t>(file.tellg()) / sizeof(double));
  file.seekg(0);
  file.read(reinterpret_cast<char*>(out.data()),
            static_cast<std::streamsize>(out.size() * sizeof(double)));
  return out;
}

pose::trajectory frames_of(const double* poses, std::size_t n) {
  pose::trajectory t;
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> m(poses + 12 * i);
    t.world_from_camera.push_back(math::rigid3{m.leftCols<3>(), m.col(3)}.inverse());
  }
  return t;
}

pose::auc_convention convention_of(const std::string& name) {
  for (std::size_t i = 0; i < pose::auc_convention_names.size(); ++i) {
    if (pose::auc_convention_names[i] == name) return static_cast<pose::auc_convention>(i);
  }
  std::exit(2);
}

struct timed {
  double seconds;
  pose::auc_result result;
};

timed timed_auc(const pose::trajectory& estimate,
                const pose::trajectory& reference,
                const pose::auc_options& options) {
  const auto start = std::chrono::steady_clock::now();
  pose::auc_result r = pose::auc(estimate, reference, options);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  return {seconds.count(), std::move(r)};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  const std::vector<double> numbers = numbers_of(argv[1]);
  const auto frames = static_cast<std::size_t>(std::atoll(argv[2]));
  if (numbers.size() < 24 * frames) return 2;
  const pose::trajectory reference = frames_of(numbers.data(), frames);
  const pose::trajectory estimate = frames_of(numbers.data() + numbers.size() / 2, frames);
  pose::auc_options options{.convention = convention_of(argc > 4 ? argv[4] : "paper"),
                            .threads = argc > 3 ? static_cast<unsigned>(std::atoi(argv[3])) : 0};
  const timed t = timed_auc(estimate, reference, options);
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  std::printf("aib %s %s pairs %llu total %.5f AUC(%s) %.12f rssMB %.1f", instruction_set,
              argc > 3 ? argv[3] : "all", static_cast<unsigned long long>(t.result.n_pairs),
              t.seconds, name(options.convention).data(), t.result.auc,
              static_cast<double>(usage.ru_maxrss) / 1024);
  if (options.convention == pose::auc_convention::paper) {
    options.convention = pose::auc_convention::vggt;
    std::printf(" AUC(vggt) %.12f", pose::auc(estimate, reference, options).auc);
  }
  std::printf("\n");
}
