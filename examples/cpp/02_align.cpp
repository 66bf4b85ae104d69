// An aligner returns a transform and what to think of it; the caller applies it and measures.
#include <aib/align/trajectory.hpp>
#include <aib/pose/ape.hpp>

#include <cstdio>

int main() {
  aib::pose::trajectory truth;
  for (int i = 0; i < 8; ++i)
    truth.world_from_camera.push_back(
        {Eigen::Matrix3d::Identity(), {double(i % 4), double(i / 4), 0.1 * i}});
  const aib::math::sim3 map_from_world{2, Eigen::Matrix3d::Identity(), {5, 0, 0}};
  aib::pose::trajectory estimate = map_from_world * truth;
  estimate.world_from_camera[7].translation.z() += 100;  // one camera is lost

  const auto fit =
      aib::align::trajectory(estimate, truth, {.robust = aib::align::ransac_options{}});
  const auto error = aib::pose::ape(fit.transform * estimate, truth);
  std::printf("scale %.3f from %zu of 8 cameras\n", fit.transform.scale, fit.n_inliers);
  std::printf("median error %.3f, largest %.1f\n", error.summary.median, error.summary.max);
}
