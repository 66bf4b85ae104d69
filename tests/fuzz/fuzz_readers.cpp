// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
//
// One reader, by the environment variable AIB_READER, on what libFuzzer makes up. A reader gives a
// value or throws an aib::error; anything else is a finding.
#include <aib/core/error.hpp>
#include <aib/io/cloud.hpp>
#include <aib/io/colmap.hpp>
#include <aib/io/depth.hpp>
#include <aib/io/image.hpp>
#include <aib/io/mesh.hpp>
#include <aib/io/trajectory.hpp>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <unistd.h>

namespace {

namespace fs = std::filesystem;
using namespace aib;

struct target {
  std::string_view name;
  std::string_view file;  ///< its name tells the format where the content does not
  void (*read)(const fs::path& path);
};

template <auto Read>
void read(const fs::path& path) {
  (void)Read(path, {});
}

void read_picture(const fs::path& path) { (void)io::read_image(path); }
void read_label_picture(const fs::path& path) { (void)io::read_labels(path); }
void read_model(const fs::path& path) { (void)io::read_colmap(path.parent_path()); }
void read_array_poses(const fs::path& path) {
  (void)io::read_trajectory(path, {.convention = io::pose_convention::world_from_camera});
}

constexpr auto cloud = read<io::read_cloud>;
constexpr auto mesh = read<io::read_mesh>;
constexpr auto depth = read<io::read_depth>;
constexpr auto poses = read<io::read_trajectory>;

constexpr target targets[] = {
    {"cloud.las", "a.las", cloud},
    {"cloud.npy", "a.npy", cloud},
    {"cloud.pcd", "a.pcd", cloud},
    {"cloud.ply", "a.ply", cloud},
    {"cloud.xyz", "a.xyz", cloud},
    {"colmap.cameras", "cameras.bin", read_model},
    {"colmap.frames", "frames.bin", read_model},
    {"colmap.images", "images.bin", read_model},
    {"colmap.points", "points3D.bin", read_model},
    {"colmap.rigs", "rigs.bin", read_model},
    {"colmap.text", "images.txt", read_model},
    {"depth.bin", "a.bin", depth},
    {"depth.dmap", "a.dmap", depth},
    {"depth.exr", "a.exr", depth},
    {"depth.npy", "a.npy", depth},
    {"depth.npz", "a.npz", depth},
    {"depth.pfm", "a.pfm", depth},
    {"depth.png", "a.png", depth},
    {"image.jpg", "a.jpg", read_picture},
    {"image.png", "a.png", read_label_picture},
    {"mesh.glb", "a.glb", mesh},
    {"mesh.obj", "a.obj", mesh},
    {"mesh.ply", "a.ply", mesh},
    {"mesh.stl", "a.stl", mesh},
    {"poses.csv", "a.csv", poses},
    {"poses.json", "transforms.json", poses},
    {"poses.log", "a.log", poses},
    {"poses.npy", "a.npy", read_array_poses},
    {"poses.npz", "a.npz", read_array_poses},
    {"poses.opensfm", "reconstruction.json", poses},
    {"poses.txt", "a.txt", poses},
    {"poses.xml", "a.xml", poses},
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
  if (t.name == "colmap.text") {
    std::ofstream(folder / "cameras.txt")
        << "1 PINHOLE 4 3 5 5 2 1.5\n2 OPENCV 4 3 5 5 2 1 0 0 0 0\n";
    std::ofstream(folder / "points3D.txt") << "1 0.5 1 2 10 20 30 0.5 1 0 2 1\n";
  }
  const char* model = std::getenv("AIB_MODEL");
  if (!t.name.starts_with("colmap.") || !model) return;
  for (const auto& entry : fs::directory_iterator(model)) {
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
