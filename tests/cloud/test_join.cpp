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

TEST_CASE("what not every cloud has is dropped") {
  const cloud::cloud a{.points = {{1, 2, 3}}, .labels = {7}};
  const cloud::cloud b{.points = {{1, 2, 3}}};
  const std::array<const cloud::cloud*, 2> both{&a, &b};
  CHECK(cloud::joined(both).labels.empty());
}

}  // namespace test_join
