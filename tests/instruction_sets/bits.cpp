// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
//
// Prints metrics of random data, those of clouds and depth maps to the last bit, those of poses,
// for which Eigen multiplies with the machine's own instructions, to eleven digits. Built for
// several instruction sets and by several compilers, the program prints the same.
#include <aib/align/trajectory.hpp>
#include <aib/cloud/compare.hpp>
#include <aib/core/isa.hpp>
#include <aib/core/random.hpp>
#include <aib/depth/errors.hpp>
#include <aib/pose/ape.hpp>
#include <aib/pose/auc.hpp>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <string_view>
#include <vector>

namespace {

using namespace aib;

void print(const char* name, double value) { std::printf("%s %a\n", name, value); }

void print_rounded(const char* name, double value) { std::printf("%s %.10e\n", name, value); }

Eigen::Vector3d random_vector(random_engine& random) {
  Eigen::Vector3d v;
  for (double& coordinate : v) coordinate = random.uniform() - 0.5;
  return v;
}

cloud::cloud random_cloud(random_engine& random, std::size_t n) {
  cloud::cloud c;
  for (std::size_t i = 0; i < n; ++i) c.points.push_back(random_vector(random).cast<float>());
  return c;
}

pose::trajectory random_trajectory(random_engine& random, std::size_t n) {
  pose::trajectory t;
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Matrix3d rotation = math::rotation_from(random_vector(random));
    t.world_from_camera.push_back({rotation, random_vector(random)});
  }
  return t;
}

std::vector<float> random_depth(random_engine& random, std::size_t n) {
  std::vector<float> depth;
  for (std::size_t i = 0; i < n; ++i)
    depth.push_back(random.uniform() < 0.1 ? 0.0F : static_cast<float>(1 + 9 * random.uniform()));
  return depth;
}

void print_clouds(random_engine& random) {
  const cloud::cloud estimate = random_cloud(random, 20011);
  const cloud::cloud truth = random_cloud(random, 15013);
  const cloud::comparison c = cloud::compare(estimate, truth, {.tau = {0.01, 0.03}});
  print("accuracy", c.accuracy);
  print("completeness", c.completeness);
  print("accuracy_rmse", c.accuracy_rmse);
  print("hausdorff", c.hausdorff);
  print("f_score", c.scores[1].f_score);
}

void print_depth(random_engine& random) {
  const std::size_t width = 641, height = 37;
  const std::vector<float> e = random_depth(random, width * height);
  const std::vector<float> r = random_depth(random, width * height);
  using view = raster::view<const float>;
  const auto align = {depth::alignment::none, depth::alignment::median, depth::alignment::scale};
  for (const depth::alignment a : align) {
    const depth::error_summary s = depth::errors(
        view{e.data(), width, height, width}, view{r.data(), width, height, width}, {.align = a});
    for (const depth::error_field& field : depth::error_fields) print("depth", s.*field.value);
  }
}

void print_poses(random_engine& random) {
  const pose::trajectory e = random_trajectory(random, 211);
  const pose::trajectory r = random_trajectory(random, 211);
  using enum pose::auc_convention;
  for (const auto convention :
       {paper, vggt, posediffusion, posediffusion_torch, da3, colmap, exact})
    print_rounded("auc", pose::auc(e, r, {.max_deg = 90, .convention = convention}).auc);
  const align::alignment fit = align::trajectory(e, r);
  print_rounded("scale", fit.transform.scale);
  print_rounded("rmse", pose::ape(fit.transform * e, r).summary.rmse);
}

}  // namespace

int main(int count, char** arguments) {
  if (count == 2 && std::string_view(arguments[1]) == "--name") {
    std::printf("%s\n", instruction_set);
    return 0;
  }
  random_engine random(7);
  print_clouds(random);
  print_depth(random);
  print_poses(random);
}
