// Relative pose accuracy of three cameras, from matrices that you have in memory. Eigen alone is
// needed.
#include <aib/math/rotation.hpp>
#include <aib/pose/auc.hpp>

#include <cstdio>

int main() {
  aib::pose::trajectory truth;
  for (int i = 0; i < 3; ++i)
    truth.world_from_camera.push_back({Eigen::Matrix3d::Identity(), {double(i), 0.2 * i * i, 0}});

  aib::pose::trajectory estimate = truth;
  const Eigen::Vector3d tilt(0, 0, aib::math::radians(4));
  estimate.world_from_camera[2].rotation = aib::math::rotation_from(tilt);

  const auto result = aib::pose::auc(estimate, truth, {.max_deg = 10});
  std::printf("AUC10 %.4f of %zu pairs\n", result.auc, std::size_t(result.n_pairs));
}
