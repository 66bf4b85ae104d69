// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/io/cloud_stream.hpp>
#include <aib/io/ply.hpp>

#include <doctest/doctest.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <support/scratch.hpp>

using namespace aib;

namespace test_cloud_stream {

namespace {

const support::scratch scratch;

cloud::cloud piece(double origin, std::size_t n) {
  cloud::cloud c;
  c.origin = {origin, 0, 0};
  for (std::size_t i = 0; i < n; ++i) {
    c.points.push_back({static_cast<float>(i), 0.25f, -1});
    c.colors.push_back({static_cast<std::uint8_t>(i), 2, 3});
  }
  return c;
}

}  // namespace

TEST_CASE("pieces of several origins are one cloud, in their order") {
  const auto path = scratch.folder() / "pieces.ply";
  io::cloud_stream out(path);
  out.add(piece(0, 3));
  out.add({});
  out.add(piece(500'000.125, 40'000));
  CHECK(out.size() == 40'003);
  CHECK(!std::filesystem::exists(path));
  out.commit();
  const auto all = io::read_ply_cloud(path);
  REQUIRE(all.size() == 40'003);
  CHECK(all.position(2) == Eigen::Vector3d(2, 0.25, -1));
  CHECK(all.position(40'002) == Eigen::Vector3d(539'999.125, 0.25, -1));
  CHECK(all.colors[4] == cloud::color{1, 2, 3});
}

TEST_CASE("a piece of other columns is refused, and the old file stays") {
  const auto path = scratch.file("old.ply", "what was there");
  {
    io::cloud_stream out(path);
    out.add(piece(0, 2));
    auto plain = piece(0, 1);
    plain.colors.clear();
    CHECK_THROWS_AS(out.add(plain), argument_error);
  }
  CHECK(io::read_file(path) == "what was there");
}

TEST_CASE("no piece is an empty cloud") {
  const auto path = scratch.folder() / "empty.ply";
  io::cloud_stream out(path);
  out.commit();
  CHECK(io::read_ply_cloud(path).empty());
}

TEST_CASE("a stream that is committed, or could not write, is closed") {
  io::cloud_stream done(scratch.folder() / "done.ply");
  done.commit();
  CHECK_THROWS_AS(done.commit(), argument_error);
  CHECK_THROWS_AS(done.add(piece(0, 1)), argument_error);
  if (!std::filesystem::exists("/dev/full")) return;
  io::cloud_stream full("/dev/full");
  CHECK_THROWS_AS(full.add(piece(0, 100'000)), io_error);
  CHECK_THROWS_AS(full.commit(), argument_error);
}

}  // namespace test_cloud_stream
