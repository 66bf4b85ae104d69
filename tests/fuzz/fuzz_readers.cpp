// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
//
// One reader, by the environment variable AIB_READER, on what libFuzzer makes up. A reader gives a
// value or throws an aib::error; anything else is a finding.
#include <aib/core/error.hpp>
#include <aib/io/cloud.hpp>
#include <aib/io/colmap.hpp>
#include <aib/io/depth.hpp>
#include <aib/io/frame_stack.hpp>
#include <aib/io/image.hpp>
#include <aib/io/mesh.hpp>
#include <aib/io/ply_positions.hpp>
#include <aib/io/trajectory.hpp>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <unistd.h>
#include <utility>
#include <vector>

namespace {

namespace fs = std::filesystem;
using namespace aib;

struct target {
  std::string_view name;
  std::string_view file;  ///< its name tells the format where the content does not
  void (*read)(const fs::path& path);
};

void cloud(const fs::path& path) {
  (void)io::read_cloud(path, {.up = io::up_axis::y, .splats = io::splat_rule::centres});
}

void cloud_of_ply(const fs::path& path) {
  cloud(path);
  io::ply_positions positions(path);
  std::vector<Eigen::Vector3d> block;
  while (positions.next(block)) continue;
}

void mesh(const fs::path& path) { (void)io::read_mesh(path, {.up = io::up_axis::y}); }

void scene(const fs::path& path) {
  mesh(path);
  cloud(path);
}

void depth(const fs::path& path) {
  (void)io::read_depth(path, {.index = 0});
  (void)io::read_depth(path, {.index = 0, .max_depth = 2, .width = 3, .height = 2});
}

void stack(const fs::path& path) {
  io::frame_stack frames(path);
  for (const std::size_t i : {frames.size() - 1, std::size_t{0}}) (void)frames.frame(i);
}

void picture(const fs::path& path) { (void)io::read_image(path); }

/// Calls a reader, whether or not it takes this file.
template <class Read>
void attempt(Read&& read, const fs::path& path) {
  try {
    (void)read(path, io::limits{});
  } catch (const error&) {
  }
}

void picture_of_png(const fs::path& path) {
  attempt(io::read_labels, path);
  attempt(io::read_png_rgba, path);
  attempt(io::read_png_color16, path);
  picture(path);
}

void poses(const fs::path& path) { (void)io::read_posed_images(path, {.size = {40, 30}}); }

void poses_either_way(const fs::path& path) {
  using enum io::pose_convention;
  (void)io::read_posed_images(path, {.convention = world_from_camera});
  (void)io::read_posed_images(path, {.convention = camera_from_world});
}

void model(const fs::path& path) {
  (void)io::read_colmap(path.parent_path());
  (void)io::read_trajectory(path.parent_path());
}

/// The files of a text model, parted by form feeds; of those that are missing there is a sound one.
void text_model(const fs::path& path) {
  constexpr std::pair<const char*, const char*> files[] = {
      {"images.txt", ""},
      {"cameras.txt", "1 PINHOLE 4 3 5 5 2 1.5\n2 OPENCV 4 3 5 5 2 1 0 0 0 0\n"},
      {"points3D.txt", "1 0.5 1 2 10 20 30 0.5 1 0 2 1\n"},
      {"rigs.txt", ""},
      {"frames.txt", ""}};
  std::string rest = io::read_file(path) + '\f';
  for (const auto& [file, otherwise] : files) {
    const std::size_t end = rest.find('\f');
    std::ofstream out(path.parent_path() / file, std::ios::binary);
    if (end == std::string::npos) {
      out << otherwise;
    } else {
      out << rest.substr(0, end);
      rest.erase(0, end + 1);
    }
  }
  model(path);
}

constexpr target targets[] = {
    {"cloud.las", "a.las", cloud},
    {"cloud.npy", "a.npy", cloud},
    {"cloud.npz", "a.npz", cloud},
    {"cloud.pcd", "a.pcd", cloud},
    {"cloud.ply", "a.ply", cloud_of_ply},
    {"cloud.xyz", "a.xyz", cloud},
    {"colmap.cameras", "cameras.bin", model},
    {"colmap.frames", "frames.bin", model},
    {"colmap.images", "images.bin", model},
    {"colmap.points", "points3D.bin", model},
    {"colmap.rigs", "rigs.bin", model},
    {"colmap.text", "model.txt", text_model},
    {"depth.bin", "a.bin", depth},
    {"depth.dmap", "a.dmap", depth},
    {"depth.exr", "a.exr", depth},
    {"depth.npy", "a.npy", depth},
    {"depth.npz", "a.npz", depth},
    {"depth.pfm", "a.pfm", depth},
    {"depth.png", "a.png", depth},
    {"image.jpg", "a.jpg", picture},
    {"image.png", "a.png", picture_of_png},
    {"mesh.glb", "a.glb", scene},
    {"mesh.obj", "a.obj", mesh},
    {"mesh.ply", "a.ply", mesh},
    {"mesh.stl", "a.stl", mesh},
    {"poses.csv", "a.csv", poses},
    {"poses.json", "transforms.json", poses},
    {"poses.log", "a.log", poses_either_way},
    {"poses.npy", "a.npy", poses_either_way},
    {"poses.npz", "a.npz", poses_either_way},
    {"poses.opensfm", "reconstruction.json", poses},
    {"poses.txt", "a.txt", poses_either_way},
    {"poses.xml", "a.xml", poses},
    {"stack.npy", "a.npy", stack},
    {"stack.npz", "a.npz", stack},
};

/// Prints the names and ends where the variable names no reader.
const target& chosen() {
  const char* name = std::getenv("AIB_READER");
  for (const target& t : targets) {
    if (name && t.name == name) return t;
  }
  for (const target& t : targets)
    std::printf("%.*s\n", static_cast<int>(t.name.size()), t.name.data());
  std::fflush(stdout);
  std::_Exit(name ? 2 : 0);
}

/// A folder of this process.
fs::path own_folder() {
  const fs::path folder = fs::temp_directory_path() / ("aib-fuzz-" + std::to_string(getpid()));
  fs::create_directories(folder);
  static const fs::path kept = folder;
  std::atexit([] { fs::remove_all(kept); });
  return folder;
}

/// The files that a model needs beside the one that is made up.
void complete(const fs::path& folder, const target& t) {
  const char* beside = std::getenv("AIB_MODEL");
  if (!t.name.starts_with("colmap.") || !beside) return;
  for (const auto& entry : fs::directory_iterator(beside)) {
    if (entry.path().filename() != t.file &&
        entry.path().extension() == fs::path(t.file).extension())
      fs::copy_file(entry, folder / entry.path().filename(), fs::copy_options::overwrite_existing);
  }
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  chosen();
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const target& t = chosen();
  static const fs::path path = [] {
    const fs::path folder = own_folder();
    complete(folder, t);
    return folder / t.file;
  }();
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  try {
    t.read(path);
  } catch (const error&) {  // a sentence: what a bad file deserves
  }
  return 0;
}
