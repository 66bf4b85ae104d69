// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/math/rotation.hpp>
#include <aib/pose/auc.hpp>
#include <aib/pose/relative_angles.hpp>

#include <doctest/doctest.h>

#include "golden.hpp"
#include "synthetic.hpp"
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

using namespace aib;
using pose::auc_convention;

namespace test_auc {

namespace {

constexpr auc_convention binned[] = {auc_convention::paper, auc_convention::vggt,
                                     auc_convention::posediffusion,
                                     auc_convention::posediffusion_torch, auc_convention::da3};
constexpr auc_convention invariant[] = {auc_convention::paper,         auc_convention::vggt,
                                        auc_convention::posediffusion, auc_convention::exact,
                                        auc_convention::colmap,        auc_convention::da3};

double auc_of(const pose::trajectory& e, const pose::trajectory& r, auc_convention c) {
  return pose::auc(e, r, {.convention = c}).auc;
}

pose::trajectory some_estimate(const pose::trajectory& reference) {
  return synthetic::noisy(reference, {.rotation_deg = 5, .position = 0.1});
}

/// Two frames, 1 apart along x, whose relative rotation is off by `deg`.
double auc_of_one_error(double deg, auc_convention convention) {
  pose::trajectory reference;
  reference.world_from_camera.resize(2);
  reference.world_from_camera[1].translation = {1, 0, 0};
  pose::trajectory estimate = reference;
  estimate.world_from_camera[1].rotation =
      math::rotation_from(Eigen::Vector3d(0, 0, math::radians(deg)));
  return auc_of(estimate, reference, convention);
}

/// COLMAP's compute_auc, written as it stands there.
double colmap_area(std::vector<double> errors, double limit) {
  std::sort(errors.begin(), errors.end());
  double area = 0, last_error = 0, last_recall = 0;
  for (std::size_t k = 0; k < errors.size() && errors[k] <= limit; ++k) {
    const double recall = static_cast<double>(k + 1) / static_cast<double>(errors.size());
    area += (errors[k] - last_error) * (recall + last_recall) / 2;
    last_error = errors[k];
    last_recall = recall;
  }
  return (area + (limit - last_error) * last_recall) / limit;
}

}  // namespace

TEST_CASE("auc of expected files: direct formulas and the projects' own functions") {
  if (!support::has_shared("auc")) return;
  const auto folder = support::shared() / "golden";
  for (const auto& c : support::golden_cases("pose_auc")) {
    const std::string id = c.at("id");
    CAPTURE(id);
    const auto json = support::read_json(folder / c.at("expected_file").get<std::string>());
    const auto& expected = json.at("expected");
    const auto estimate = support::read_w2c(folder / c.at("inputs").at("est").get<std::string>());
    const auto reference = support::read_w2c(folder / c.at("inputs").at("gt").get<std::string>());

    const auto& paper = expected.at("numpy_paper").at("Ti_invTj");
    const auto& other = expected.at("numpy_paper").at("Tj_invTi");
    const auto near = [](const nlohmann::json& direct) {
      return direct.at("robustness_r").at("count_within_1e-6").get<double>() +
             direct.at("robustness_t").at("count_within_1e-6").get<double>();
    };
    const double pairs = paper.at("pairs");
    const double tolerance = 1e-12 + near(paper) / pairs;
    const auto angles = pose::relative_angles(estimate, reference, {.tau_deg = {3, 5, 10, 15, 30}});
    CHECK(static_cast<double>(angles.n_pairs) == pairs);
    CHECK(angles.n_zero_baseline == paper.at("zero_baseline_pairs").get<std::uint64_t>());
    for (std::size_t k = 0; k < angles.tau_deg.size(); ++k) {
      const std::string tau = std::to_string(static_cast<int>(angles.tau_deg[k]));
      CHECK(std::abs(angles.rra[k] - paper.at("RRA").at(tau).get<double>()) <= tolerance);
      CHECK(std::abs(angles.rta[k] - paper.at("RTA_unfolded").at(tau).get<double>()) <= tolerance);
    }
    if (angles.n_zero_baseline == angles.n_pairs) {
      CHECK_THROWS_AS(pose::auc(estimate, reference), undefined_error);
      continue;
    }
    for (const unsigned t : {3u, 5u, 10u, 15u, 30u}) {
      CAPTURE(t);
      const std::string tau = std::to_string(t);
      const auto at = [&](auc_convention convention) {
        return pose::auc(estimate, reference, {.max_deg = t, .convention = convention});
      };
      const auto by_paper = at(auc_convention::paper);
      CHECK(std::abs(by_paper.auc - paper.at("AUC_min_unfolded").at(tau).get<double>()) <=
            tolerance);
      CHECK(std::abs(by_paper.rta.back() - paper.at("RTA_unfolded").at(tau).get<double>()) <=
            tolerance);
      // The direct joint formula is strict at the last edge, the histogram is not.
      const double edge = 1e-12 + near(paper) / pairs;
      const auto joint = at(auc_convention::vggt);
      CHECK(std::abs(joint.auc - paper.at("AUC_joint_folded").at(tau).get<double>()) <= edge);
      CHECK(std::abs(joint.auc_signed - paper.at("AUC_joint_unfolded").at(tau).get<double>()) <=
            edge);
      const double edge2 = 1e-12 + near(other) / pairs;
      const auto swapped = at(auc_convention::posediffusion);
      CHECK(std::abs(swapped.auc - other.at("AUC_joint_folded").at(tau).get<double>()) <= edge2);
      CHECK(std::abs(swapped.rta.back() - other.at("RTA_folded").at(tau).get<double>()) <= edge2);

      // The projects' functions take rounding noise for directions.
      const double peers =
          1e-9 + near(paper) / pairs + static_cast<double>(angles.n_zero_baseline) / pairs;
      const auto check_peer = [&](const char* project, const pose::auc_result& ours) {
        const auto& p = expected.at(project);
        if (p.contains("AUC") && p.at("AUC").contains(tau))
          CHECK(std::abs(ours.auc - p.at("AUC").at(tau).get<double>()) <= peers);
        if (p.at("RTA").contains(tau))
          CHECK(std::abs(ours.rta.back() - p.at("RTA").at(tau).get<double>()) <= peers);
      };
      check_peer("vggt", joint);
      check_peer("pi3", swapped);
      check_peer("da3", at(auc_convention::da3));
      const auto torch = expected.at("pi3").at("calculate_auc_torch_histc31");
      if (torch.contains(tau)) {
        CHECK(std::abs(at(auc_convention::posediffusion_torch).auc - torch.at(tau).get<double>()) <=
              peers);
      }
    }
  }
}

TEST_CASE("one pair: the edges of the thresholds") {
  for (const auto c : {auc_convention::vggt, auc_convention::posediffusion}) {
    CHECK(auc_of_one_error(29.9999, c) == doctest::Approx(1.0 / 30));
    CHECK(auc_of_one_error(30.0001, c) == 0);
    CHECK(auc_of_one_error(0, c) == 1);
    CHECK(auc_of_one_error(1.00001, c) == doctest::Approx(29.0 / 30));
    CHECK(auc_of_one_error(0.99999, c) == 1);
  }
  CHECK(auc_of_one_error(29.9999, auc_convention::posediffusion_torch) ==
        doctest::Approx(1.0 / 31));
  CHECK(auc_of_one_error(0.9, auc_convention::posediffusion_torch) == 1);
  CHECK(auc_of_one_error(0.99999, auc_convention::posediffusion_torch) ==
        doctest::Approx(30.0 / 31));
  CHECK(auc_of_one_error(12, auc_convention::exact) == doctest::Approx(18.0 / 30));
}

TEST_CASE("auc does not change with a similarity of either side") {
  const pose::trajectory reference = synthetic::orbit();
  const pose::trajectory estimate = some_estimate(reference);
  for (const auto c : invariant) {
    CAPTURE(pose::name(c));
    const double value = auc_of(estimate, reference, c);
    CHECK(auc_of(synthetic::some_sim3() * estimate, reference, c) == doctest::Approx(value));
    CHECK(auc_of(estimate, synthetic::some_sim3() * reference, c) == doctest::Approx(value));
  }
}

TEST_CASE("auc over ordered pairs does not change with the order of the frames") {
  const pose::trajectory reference = synthetic::orbit({.frames = 10});
  const pose::trajectory estimate = some_estimate(reference);
  const std::vector<std::size_t> order = {3, 7, 1, 0, 9, 8, 2, 5, 4, 6};
  const auto c = auc_convention::colmap;
  CHECK(auc_of(select(estimate, order), select(reference, order), c) ==
        doctest::Approx(auc_of(estimate, reference, c)));
}

TEST_CASE("mirrored centres are caught by the signed value beside the folded one") {
  const pose::trajectory reference = synthetic::orbit();
  pose::trajectory estimate = reference;
  for (auto& pose : estimate.world_from_camera) pose.translation *= -1;
  for (const auto c : binned) {
    CAPTURE(pose::name(c));
    const auto r = pose::auc(estimate, reference, {.convention = c});
    if (c == auc_convention::paper) CHECK(r.auc == 0);
    if (c == auc_convention::vggt) CHECK(r.auc == 1);
    CHECK(r.auc_signed <= r.auc);
    if (c != auc_convention::da3) CHECK(r.auc_signed == 0);
  }
}

TEST_CASE("exact and colmap areas are those of the sorted errors") {
  const pose::trajectory reference = synthetic::orbit({.frames = 25});
  const pose::trajectory estimate = some_estimate(reference);
  std::vector<double> ordered;
  double exact = 0;
  for (std::size_t i = 0; i < 25; ++i) {
    for (std::size_t j = 0; j < 25; ++j) {
      if (i == j) continue;
      const auto relative = [&](const pose::trajectory& t) {
        return t.world_from_camera[i].inverse() * t.world_from_camera[j];
      };
      const math::rigid3 e = relative(estimate), r = relative(reference);
      const double error = math::degrees(std::max(
          math::rotation_angle(e.rotation.transpose() * r.rotation),
          std::atan2(e.translation.cross(r.translation).norm(), e.translation.dot(r.translation))));
      ordered.push_back(error);
      if (i < j) exact += std::max(0.0, 30 - error) / 30 / 300;
    }
  }
  CHECK(auc_of(estimate, reference, auc_convention::exact) ==
        doctest::Approx(exact).epsilon(1e-12));
  CHECK(auc_of(estimate, reference, auc_convention::colmap) ==
        doctest::Approx(colmap_area(ordered, 30)).epsilon(1e-12));
}

TEST_CASE("colmap counts the pairs of a missing frame as failed") {
  const pose::trajectory reference = synthetic::orbit({.frames = 5});
  const auto r =
      pose::auc(select(reference, {0, 1, 2, 4}), reference, {.convention = auc_convention::colmap});
  CHECK(r.auc == doctest::Approx(12.0 / 20));
  CHECK(r.n_pairs == 20);
  CHECK(r.n_unregistered == 1);
  CHECK_THROWS_AS(pose::auc(select(reference, {0, 1, 2, 4}), reference), argument_error);
  pose::trajectory nameless = select(reference, {0, 1, 2, 4});
  nameless.names.clear();
  CHECK_THROWS_AS(pose::auc(nameless, reference, {.convention = auc_convention::colmap}),
                  argument_error);
}

TEST_CASE("auc is the same bits for any number of threads") {
  const pose::trajectory reference = synthetic::orbit({.frames = 300});
  const pose::trajectory estimate = some_estimate(reference);
  for (const auto c : invariant) {
    CHECK(pose::auc(estimate, reference, {.convention = c, .threads = 1}).auc ==
          pose::auc(estimate, reference, {.convention = c, .threads = 4}).auc);
  }
}

TEST_CASE("auc of nothing is undefined, of anything else refused") {
  const pose::trajectory reference = synthetic::orbit({.frames = 4});
  pose::trajectory lost = reference;
  for (auto& pose : lost.world_from_camera)
    pose.translation.setConstant(std::numeric_limits<double>::infinity());
  CHECK_THROWS_WITH_AS(pose::auc(lost, reference),
                       "auc: 2 registered frames expected, found 0 of 4", undefined_error);
  pose::trajectory still = reference;
  for (auto& pose : still.world_from_camera) pose.translation.setZero();
  CHECK_THROWS_WITH_AS(pose::auc(still, reference),
                       "auc: none of 6 pairs has a direction; relative_angles still gives RRA",
                       undefined_error);
  CHECK_THROWS_AS(pose::auc(reference, reference, {.max_deg = 0}), argument_error);
  CHECK_THROWS_AS(pose::auc(reference, reference, {.max_deg = 181}), argument_error);
  CHECK(pose::auc(reference, reference, {.max_deg = 180}).auc == 1);
  CHECK(pose::auc(reference, reference, {.max_deg = 180, .convention = auc_convention::vggt}).auc ==
        1);
}

}  // namespace test_auc
