// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
//
// A program of somebody else: with points and images of its own.
#if __has_include(<aib/cloud.hpp>)
#include <aib/cloud.hpp>
#include <aib/depth.hpp>
#else  // the single header
#include <aib/aib.hpp>
#endif

#include <cstdio>
#include <vector>

namespace theirs {

struct vertex {
  float east, north, up;
};

struct frame {
  int width, height;
  std::vector<float> metres;
};

aib::raster::view<const float> pixels(const frame& f) {
  const auto width = static_cast<std::size_t>(f.width);
  return {f.metres.data(), width, static_cast<std::size_t>(f.height), width};
}

}  // namespace theirs

template <>
struct aib::point_traits<theirs::vertex> {
  using scalar = float;
  static float coordinate(const theirs::vertex& v, int axis) {
    return axis == 0 ? v.east : axis == 1 ? v.north : v.up;
  }
};

int main() {
  const std::vector<theirs::vertex> scan = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  const std::vector<theirs::vertex> truth = {{0, 0, 0.5}, {1, 0, 0.5}, {2, 0, 0.5}};
  const auto clouds =
      aib::cloud::compare(aib::cloud::from_points(scan), aib::cloud::from_points(truth));

  const theirs::frame estimate = {2, 1, {1, 3}};
  const theirs::frame reference = {2, 1, {1, 2}};
  const auto depths = aib::depth::errors(pixels(estimate), pixels(reference));

  std::printf("chamfer %g, abs_rel %g\n", clouds.chamfer, depths.abs_rel);
}
