// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT

/// time_depth make FOLDER N             writes N pairs of 1080p frames: N.est.exr, N.gt.exr (ZIP,
///                                      channel Y, the only one of depth that OpenCV reads)
/// time_depth kernel|decode FOLDER      milliseconds of srmse and of all errors; of a file
/// time_depth pipeline FOLDER N THREADS frames a second: two files and all errors
#include <aib/depth/accumulate.hpp>
#include <aib/io/depth_frame.hpp>

#include "depth_frames.hpp"
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#ifdef AIB_TEST_TINYEXR
#include <tinyexr.h>
#endif
#ifdef AIB_TEST_OPENEXR
#include <ImathBox.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfThreading.h>
#endif

using namespace aib;

namespace {

template <class Work>
double milliseconds(Work work) {
  std::vector<double> times;
  for (int i = 0; i < 7; ++i) {
    const auto start = std::chrono::steady_clock::now();
    work();
    const std::chrono::duration<double, std::milli> spent =
        std::chrono::steady_clock::now() - start;
    times.push_back(spent.count());
  }
  std::sort(times.begin(), times.end());
  return times[times.size() / 2];
}

std::string path_of(const std::string& folder, std::size_t i, const char* kind) {
  return folder + "/" + std::to_string(i) + "." + kind + ".exr";
}

void make(const std::string& folder, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    const frame_pair f = made_frame(i);
    io::write_exr(path_of(folder, i, "est"), f.estimate.view(), {.channel = "Y"});
    io::write_exr(path_of(folder, i, "gt"), f.reference.view(), {.channel = "Y"});
  }
}

void time_kernel(const std::string& folder) {
  const auto e = io::read_depth(path_of(folder, 0, "est")),
             r = io::read_depth(path_of(folder, 0, "gt"));
  double found = 0;
  const double one = milliseconds([&] { found = depth::srmse(e.values.view(), r.values.view()); });
  const double all = milliseconds([&] { found = depth::errors(e, r).srmse; });
  std::printf("srmse %.3f\nall %.3f\nvalue %.17g\n", one, all, found);
}

#ifdef AIB_TEST_TINYEXR
void read_by_tinyexr(const std::string& path) {
  EXRVersion version;
  EXRHeader header;
  EXRImage image;
  InitEXRHeader(&header);
  InitEXRImage(&image);
  ParseEXRVersionFromFile(&version, path.c_str());
  ParseEXRHeaderFromFile(&header, &version, path.c_str(), nullptr);
  LoadEXRImageFromFile(&image, &header, path.c_str(), nullptr);
  FreeEXRImage(&image);
  FreeEXRHeader(&header);
}
#endif

#ifdef AIB_TEST_OPENEXR
void read_by_openexr(const std::string& path) {
  Imf::InputFile file(path.c_str(), 0);  // 0: no threads beside this one
  const auto box = file.header().dataWindow();
  const auto width = static_cast<std::size_t>(box.max.x - box.min.x + 1);
  std::vector<float> values(width * static_cast<std::size_t>(box.max.y - box.min.y + 1));
  Imf::FrameBuffer buffer;
  buffer.insert("Y", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()), sizeof(float),
                                sizeof(float) * width));
  file.setFrameBuffer(buffer);
  file.readPixels(box.min.y, box.max.y);
}
#endif

void time_decode(const std::string& folder) {
  const std::string path = path_of(folder, 0, "est");
  std::printf("aib %.3f\n", milliseconds([&] { static_cast<void>(io::read_depth(path)); }));
#ifdef AIB_TEST_TINYEXR
  std::printf("tinyexr %.3f\n", milliseconds([&] { read_by_tinyexr(path); }));
#endif
#ifdef AIB_TEST_OPENEXR
  Imf::setGlobalThreadCount(0);
  std::printf("openexr %.3f\n", milliseconds([&] { read_by_openexr(path); }));
#endif
}

void time_pipeline(const std::string& folder, std::size_t n, unsigned threads) {
  const double spent = milliseconds([&] {
    const auto errors = depth::accumulate(n, {.threads = threads}, [&](std::size_t i) {
      return io::read_depth_frame({.name = std::to_string(i),
                                   .estimate = path_of(folder, i, "est"),
                                   .reference = path_of(folder, i, "gt")});
    });
    if (errors.frames().size() != n) std::puts("frames are missing");
  });
  std::printf("pipeline %.3f\n", 1000 * static_cast<double>(n) / spent);
}

}  // namespace

int main(int count, char** words) {
  if (count < 3) return 2;
  const std::string_view what = words[1];
  const std::string folder = words[2];
  const auto number = [&](int i) { return count > i ? std::stoul(words[i]) : 1; };
  if (what == "make") make(folder, number(3));
  if (what == "kernel") time_kernel(folder);
  if (what == "decode") time_decode(folder);
  if (what == "pipeline") time_pipeline(folder, number(3), static_cast<unsigned>(number(4)));
}
