// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
//
// Prints metrics of random data, those of clouds and depth maps to the last bit, those of poses,
// for which Eigen multiplies with the machine's own instructions, to eleven digits. Built for
// several instruction sets, by several compilers, from the single header, and with any number of
// threads, the program prints the same.
//
//   bits [THREADS | --name]
#ifdef AIB_SINGLE
#include <aib/aib.hpp>
#else
#include <aib/align/icp.hpp>
#include <aib/align/trajectory.hpp>
#include <aib/cloud/compare.hpp>
#include <aib/cloud/eth3d.hpp>
#include <aib/cloud/normals.hpp>
#include <aib/cloud/offsets.hpp>
#include <aib/cloud/outliers.hpp>
#include <aib/core/isa.hpp>
#include <aib/core/random.hpp>
#include <aib/depth/accumulate.hpp>
#include <aib/depth/errors.hpp>
#include <aib/io/ply_write.hpp>
#include <aib/mesh/face_scores.hpp>
#include <aib/mesh/offsets.hpp>
#include <aib/pose/ape.hpp>
#include <aib/pose/auc.hpp>
#include <aib/pose/worst_pairs.hpp>
#include <aib/render/frame.hpp>
#include <aib/render/visible.hpp>
#include <aib/sample/mesh.hpp>
#include <aib/sample/voxel.hpp>
#include <aib/stream/compare_clouds.hpp>
#include <aib/survey/measure.hpp>
#endif

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <unistd.h>
#include <vector>

namespace {

using namespace aib;

unsigned threads = 0;

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
  const cloud::comparison c =
      cloud::compare(estimate, truth, {.tau = {0.01, 0.03}, .threads = threads});
  print("accuracy", c.accuracy);
  print("completeness", c.completeness);
  print("accuracy_rmse", c.accuracy_rmse);
  print("hausdorff", c.hausdorff);
  print("f_score", c.scores[1].f_score);
}

/// Clouds in files, more than the search may hold at once.
void print_stream(random_engine& random) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("aib-bits-" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  io::write_ply(folder / "estimate.ply", random_cloud(random, 150011));
  io::write_ply(folder / "truth.ply", random_cloud(random, 15013));
  const cloud::comparison c =
      stream::compare_clouds(folder / "estimate.ply", folder / "truth.ply",
                             {.memory = 16 << 20, .compare = {.tau = {0.03}, .threads = threads}});
  std::filesystem::remove_all(folder);
  print("stream", c.f1_distance);
  print("stream", c.hausdorff);
  print("stream", c.scores[0].f_score);
}

void print_points(const char* name, const cloud::cloud& c) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < c.size(); ++i) sum += static_cast<double>(i + 1) * c.position(i);
  for (const double coordinate : sum) print(name, coordinate);
}

/// What looks at the neighbours of points.
void print_neighbours(random_engine& random) {
  const cloud::cloud estimate = random_cloud(random, 4001);
  const cloud::cloud truth = random_cloud(random, 3001);
  const auto flat = cloud::with_normals(truth, {.neighbours = 8, .threads = threads});
  print_rounded("offsets", cloud::offsets_along_normals(estimate, flat, threads).mean());
  const auto kept = cloud::without_statistical_outliers(estimate, {.threads = threads});
  print("kept", static_cast<double>(kept.size()));
  const auto dense = cloud::without_radius_outliers(
      estimate, {.radius = 0.08, .neighbours = 8, .threads = threads});
  print("dense", static_cast<double>(dense.size()));
  const std::vector<cloud::laser_scan> scans = {{truth, {0, 0, 9}}};
  const auto eth3d = cloud::eth3d(estimate, scans, {.tolerances = {0.05}, .threads = threads});
  print("eth3d", eth3d.scores[0].completeness);
  const auto fit =
      align::icp(estimate, truth, {.max_distance = {0.2}, .max_iterations = 5, .threads = threads});
  print_rounded("icp", fit.rmse);
}

mesh::mesh some_tetrahedron() {
  mesh::mesh tetrahedron;
  tetrahedron.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  tetrahedron.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  return tetrahedron;
}

/// What casts rays.
void print_rays(random_engine& random) {
  const mesh::mesh tetrahedron = some_tetrahedron();
  const mesh::ray_surface surface(tetrahedron, threads);
  std::vector<math::view> views;
  for (const double x : {0.2, 0.3, 0.4})
    views.push_back(
        {math::pinhole(64, 48, 60, 60, 32, 24), {Eigen::Matrix3d::Identity(), {x, 0.2, -2}}});
  const render::view_rays rays(views[0].camera, 64, 48, threads);
  const auto frame =
      render::cast_frame(surface, rays, views[0].world_from_camera, {.cast = {.threads = threads}});
  double sum = 0;
  for (const float z : frame.depth.values) sum += static_cast<double>(z);
  print_rounded("rendered", sum);
  double n = 0;
  for (const auto seen :
       render::n_views(surface, random_cloud(random, 2001), views, {.cast = {.threads = threads}}))
    n += seen;
  print("visible", n);
  const auto measured =
      survey::measure(views, tetrahedron, surface, {.samples = 2000, .threads = threads});
  print("covered", measured.seen_by(2));
}

void print_meshes(random_engine& random) {
  const mesh::mesh tetrahedron = some_tetrahedron();
  const cloud::cloud points = random_cloud(random, 20011);
  const auto offsets = mesh::offsets(points, tetrahedron, threads);
  print("offset", offsets.mean());
  print("deviation", offsets.deviation());
  print_points("samples", sample::mesh(tetrahedron, {.n = 30000, .threads = threads}).points);
  print_points("voxels", sample::voxel(points, {.size = 0.05, .threads = threads}));
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

void print_frames(random_engine& random) {
  const std::size_t width = 64, height = 48;
  std::vector<depth::depth_map> maps(24);
  for (depth::depth_map& map : maps) {
    const auto values = random_depth(random, width * height);
    map.values = raster::image<float>(width, height);
    std::copy(values.begin(), values.end(), map.values.begin());
  }
  const auto load = [&](std::size_t i) {
    return depth::frame{.name = "frame", .estimate = maps[2 * i], .reference = maps[2 * i + 1]};
  };
  const auto frames = depth::accumulate(maps.size() / 2, {.threads = threads}, load).result();
  print("frames", frames.mean.srmse);
  print("pooled", frames.pooled.srmse);
}

void print_poses(random_engine& random) {
  const pose::trajectory e = random_trajectory(random, 211);
  const pose::trajectory r = random_trajectory(random, 211);
  using enum pose::auc_convention;
  for (const auto convention :
       {paper, vggt, posediffusion, posediffusion_torch, da3, colmap, exact})
    print_rounded(
        "auc", pose::auc(e, r, {.max_deg = 90, .convention = convention, .threads = threads}).auc);
  const auto worst = pose::worst_pairs(e, r, {.n = 30, .threads = threads});
  print_rounded("worst", worst.back().rotation_deg);
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
  if (count == 2) threads = static_cast<unsigned>(std::atoi(arguments[1]));
  random_engine random(7);
  print_clouds(random);
  print_meshes(random);
  print_depth(random);
  print_frames(random);
  print_poses(random);
  print_stream(random);
  print_neighbours(random);
  print_rays(random);
}
