// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/pose/registration.hpp>

#include <doctest/doctest.h>

#include "synthetic.hpp"
#include <limits>

using namespace aib;

namespace test_registration {

TEST_CASE("registration names the frames that are missing") {
  const pose::trajectory reference = synthetic::orbit({.frames = 4});
  pose::trajectory estimate = select(reference, {3, 0, 1});
  estimate.world_from_camera[2].translation[0] = std::numeric_limits<double>::quiet_NaN();
  estimate.names.push_back("stranger.png");
  estimate.stamps_s.clear();
  estimate.world_from_camera.emplace_back();
  const auto r = pose::registration_rate(estimate, reference);
  CHECK(r.rate == 0.5);
  CHECK(r.n_registered == 2);
  CHECK(r.n_total == 4);
  CHECK(r.missing == std::vector<std::string>{"001.png", "002.png"});
}

TEST_CASE("several sub-models: the largest is scored, together they register more") {
  const pose::trajectory reference = synthetic::orbit({.frames = 6});
  const std::vector<pose::trajectory> models = {
      select(reference, {0, 1}), select(reference, {1, 2, 3}), select(reference, {3, 4, 5})};
  CHECK(pose::largest_model(models) == 1);
  const std::vector<std::size_t> points = {900, 10, 11};
  CHECK(pose::largest_model(models, points) == 2);
  CHECK(pose::registration_rate(models, reference).rate == 1);
  CHECK_THROWS_AS(pose::largest_model({}), undefined_error);
}

TEST_CASE("registration needs names and an expectation") {
  const pose::trajectory reference = synthetic::orbit({.frames = 2});
  pose::trajectory nameless = reference;
  nameless.names.clear();
  CHECK_THROWS_AS(pose::registration_rate(nameless, reference), argument_error);
  CHECK_THROWS_AS(pose::registration_rate(reference, {}), undefined_error);
}

}  // namespace test_registration
