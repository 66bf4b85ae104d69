// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/io/frame_stack.hpp>
#include <aib/io/npz_write.hpp>

#include <doctest/doctest.h>

#include <support/scratch.hpp>
#include <support/shared.hpp>
#include <vector>

using namespace aib;

namespace test_frame_stack {

namespace {

const support::scratch scratch;

io::array counting(std::vector<std::size_t> shape) {
  std::vector<float> values(io::detail::element_count(shape).value());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i);
  return io::make_array<float>(std::move(shape), values);
}

}  // namespace

TEST_CASE("frames of an NPY file are read in any order") {
  const auto path = scratch.folder() / "depth.npy";
  io::write_npy(path, counting({3, 2, 4, 1}));
  io::frame_stack frames(path);
  CHECK(frames.size() == 3);
  CHECK(frames.width() == 4);
  CHECK(frames.height() == 2);
  CHECK(frames.frame(2)(0, 0) == 16);
  CHECK(frames.frame(0)(3, 1) == 7);
  CHECK_THROWS_AS(frames.frame(3), argument_error);
}

TEST_CASE("a point map gives its points, and z as depth") {
  const auto path = scratch.folder() / "res.npz";
  io::write_npz(path, {{"local_points", counting({1, 2, 1, 2, 3})}});
  io::frame_stack frames(path, "local_points");
  CHECK(frames.size() == 2);
  CHECK(frames.is_point_map());
  CHECK(frames.at(1).shape == std::vector<std::size_t>{1, 2, 3});
  CHECK(frames.at(1)[0] == 6);
  CHECK(frames.frame(1)(1, 0) == 11);
}

TEST_CASE("an array that holds no frames is refused") {
  const auto path = scratch.folder() / "line.npy";
  io::write_npy(path, counting({5}));
  CHECK_THROWS_AS(io::frame_stack{path}, format_error);
}

TEST_CASE("deflated frames are those of the whole array, forwards and backwards") {
  if (!support::has_shared("deflated frames")) return;
  const auto path =
      support::shared() / "scenes/batched/methods/da3/crane/batch_000/exports/mini_npz/results.npz";
  const io::array_frames all = io::read_array_frames(path, "depth");
  io::frame_stack frames(path, "depth");
  REQUIRE(frames.size() == all.size());
  for (const std::size_t i : {std::size_t{0}, std::size_t{5}, std::size_t{30}, std::size_t{2}}) {
    const auto expected = all.frame(i), found = frames.frame(i);
    std::size_t n_different = 0;
    for (std::size_t k = 0; k < found.size(); ++k) {
      const float a = expected.data()[k], b = found.data()[k];
      if (!(a == b || (a != a && b != b))) ++n_different;
    }
    CHECK(n_different == 0);
  }
}

}  // namespace test_frame_stack
