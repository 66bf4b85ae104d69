// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/cloud/join.hpp>

#include <doctest/doctest.h>

#include <array>

using namespace aib;

namespace test_join {

TEST_CASE("joined clouds keep their places, whatever their origins") {
  const cloud::cloud a{.origin = {5e5, 0, 0}, .points = {{1, 2, 3}}, .colors = {{1, 2, 3}}};
  const cloud::cloud b{.origin = {5e5 + 16, 1, 0}, .points = {{0.5, 0, 0}}, .colors = {{4, 5, 6}}};
  const cloud::cloud nothing;
  const std::array<const cloud::cloud*, 3> all{&nothing, &a, &b};
  const cloud::cloud joined = cloud::joined(all);
  REQUIRE(joined.size() == 2);
  CHECK(joined.position(0) == a.position(0));
  CHECK(joined.position(1) == b.position(0));
  CHECK(joined.colors.size() == 2);
}

TEST_CASE("a cloud that lies far away, joined first, does not blur the others") {
  const cloud::cloud lost{.origin = {1e9, 0, 0}, .points = {{0, 0, 0}}};
  const cloud::cloud wall{.points = {{1.001F, 2, 3}, {1.002F, 2, 3}, {1.003F, 2, 3}}};
  const std::array<const cloud::cloud*, 2> both{&lost, &wall};
  const cloud::cloud all = cloud::joined(both);
  CHECK(all.position(0) == lost.position(0));
  for (std::size_t i = 0; i < 3; ++i) CHECK(all.position(i + 1) == wall.position(i));
}

TEST_CASE("what not every cloud has is dropped") {
  const cloud::cloud a{.points = {{1, 2, 3}}, .labels = {7}};
  const cloud::cloud b{.points = {{1, 2, 3}}};
  const std::array<const cloud::cloud*, 2> both{&a, &b};
  CHECK(cloud::joined(both).labels.empty());
}

}  // namespace test_join
