// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/pose/auc_breakdown.hpp>
#include <aib/pose/worst_pairs.hpp>

#include <doctest/doctest.h>

#include "synthetic.hpp"
#include <cstdint>
#include <vector>

using namespace aib;
using pose::auc_convention;

namespace test_breakdown {

namespace {

const pose::trajectory reference = synthetic::orbit({.frames = 24});
const pose::trajectory estimate = synthetic::noisy(reference, {.rotation_deg = 6, .position = 0.1});

/// The AUC of the pairs that a rule takes, one trajectory of two frames at a time.
template <class Rule>
double auc_of_pairs(auc_convention convention, Rule&& rule) {
  double sum = 0;
  int n = 0;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    for (std::size_t j = i + 1; j < reference.size(); ++j) {
      if (!rule(i, j)) continue;
      sum +=
          pose::auc(select(estimate, {i, j}), select(reference, {i, j}), {.convention = convention})
              .auc;
      ++n;
    }
  }
  return sum / n;
}

}  // namespace

TEST_CASE("pairs within batches and across them make all pairs") {
  std::vector<std::size_t> batch;
  for (std::size_t i = 0; i < 24; ++i) batch.push_back(i < 10 ? 7 : i % 3);  // not in order
  for (const auto c : {auc_convention::vggt, auc_convention::posediffusion}) {
    CAPTURE(pose::name(c));
    const auto r = pose::auc_by_batch(estimate, reference, batch, {.convention = c});
    CHECK(r.intra.n_pairs + r.cross.n_pairs == 276);
    CHECK(r.intra.value->auc ==
          doctest::Approx(auc_of_pairs(c, [&](auto i, auto j) { return batch[i] == batch[j]; })));
    CHECK(r.cross.value->auc ==
          doctest::Approx(auc_of_pairs(c, [&](auto i, auto j) { return batch[i] != batch[j]; })));
  }
}

TEST_CASE("pairs within batches do not care for the batches' own worlds") {
  const std::vector<std::size_t> batch = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
                                          1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
  pose::trajectory split = estimate;
  for (std::size_t i = 12; i < 24; ++i)
    split.world_from_camera[i] = synthetic::some_sim3() * split.world_from_camera[i];
  const auto one = pose::auc_by_batch(estimate, reference, batch);
  const auto two = pose::auc_by_batch(split, reference, batch);
  CHECK(one.intra.value->auc == doctest::Approx(two.intra.value->auc));
  CHECK(one.cross.value->auc > two.cross.value->auc + 0.1);
}

TEST_CASE("auc by the gap between frames") {
  const std::vector<pose::gap_range> gaps = {{1, 1}, {2, 5}, {30, 40}};
  for (const auto c : {auc_convention::vggt, auc_convention::posediffusion}) {
    CAPTURE(pose::name(c));
    const auto r = pose::auc_by_gap(estimate, reference, gaps, {.convention = c});
    CHECK(r[0].part.n_pairs == 23);
    CHECK(r[1].part.n_pairs == 22 + 21 + 20 + 19);
    CHECK(r[1].part.value->auc == doctest::Approx(auc_of_pairs(
                                      c, [](auto i, auto j) { return j - i >= 2 && j - i <= 5; })));
    CHECK(r[2].part.n_pairs == 0);
    CHECK(!r[2].part.value);
  }
}

TEST_CASE("breakdowns refuse what they cannot do") {
  const std::vector<std::size_t> few = {1, 2};
  CHECK_THROWS_AS(pose::auc_by_batch(estimate, reference, few), argument_error);
  const std::vector<pose::gap_range> zero = {{0, 3}};
  CHECK_THROWS_AS(pose::auc_by_gap(estimate, reference, zero), argument_error);
  const std::vector<std::size_t> batch(24);
  CHECK_THROWS_AS(
      pose::auc_by_batch(estimate, reference, batch, {.convention = auc_convention::exact}),
      argument_error);
}

TEST_CASE("the worst pairs are those of the frame that is off") {
  pose::trajectory wrong = reference;
  wrong.world_from_camera[5].rotation *= math::rotation_from(Eigen::Vector3d(0, 1.5, 0));
  const auto worst = pose::worst_pairs(wrong, reference, {.n = 23});
  REQUIRE(worst.size() == 23);
  for (const auto& w : worst) CHECK((w.first == "005.png" || w.second == "005.png"));
  CHECK(worst[0].rotation_deg == doctest::Approx(math::degrees(1.5)));
  CHECK(pose::worst_pairs(wrong, reference, {.n = 1000}).size() == 276);
  CHECK(pose::worst_pairs(wrong, reference, {.n = SIZE_MAX / 2}).size() == 276);
  CHECK(pose::worst_pairs({}, {}).empty());
}

}  // namespace test_breakdown
