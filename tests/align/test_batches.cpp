// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/align/batches.hpp>
#include <aib/io/colmap.hpp>
#include <aib/io/trajectory.hpp>
#include <aib/io/tum.hpp>
#include <aib/pose/ape.hpp>
#include <aib/pose/associate.hpp>
#include <aib/pose/auc.hpp>
#include <aib/pose/focal.hpp>
#include <aib/pose/registration.hpp>

#include <doctest/doctest.h>

#include "../pose/golden.hpp"
#include "../pose/synthetic.hpp"
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

using namespace aib;

namespace test_batches {

namespace {

/// Batches of 10, each in a world of its own.
pose::trajectory in_own_worlds(pose::trajectory t) {
  for (std::size_t i = 0; i < t.size(); ++i) {
    const double k = static_cast<double>(i / 10);
    const math::sim3 own{1 + k, math::rotation_from(Eigen::Vector3d(k, 1, 0)), {k, 0, 0}};
    t.world_from_camera[i] = own * t.world_from_camera[i];
  }
  return t;
}

pose::trajectory joined(const std::vector<pose::trajectory>& parts) {
  pose::trajectory out;
  for (const auto& t : parts) {
    out.world_from_camera.insert(out.world_from_camera.end(), t.world_from_camera.begin(),
                                 t.world_from_camera.end());
    out.names.insert(out.names.end(), t.names.begin(), t.names.end());
  }
  return out;
}

double rmse(const pose::trajectory& e, const pose::trajectory& r) {
  return pose::ape(e, r).summary.rmse;
}

}  // namespace

TEST_CASE("each batch finds its own transform") {
  const pose::trajectory reference = synthetic::orbit({.frames = 35});
  const pose::trajectory estimate = in_own_worlds(reference);
  const auto b = align::batches(estimate, reference, {.size = 10});
  REQUIRE(b.size() == 4);
  CHECK(b[3].frames.front() == 30);
  CHECK(b[3].frames.back() == 34);
  for (const auto& batch : b) {
    REQUIRE(batch.fit);
    CHECK(batch.fit->rmse < 1e-12);
    CHECK(*batch.fit->half_rmse < 1e-11);
  }
  CHECK(!b[0].seam);
  CHECK(*b[1].seam < 1e-12);
  CHECK(rmse(align::transformed(b, estimate), reference) < 1e-12);
}

TEST_CASE("a seam shows how far two neighbours disagree") {
  const pose::trajectory reference = synthetic::orbit({.frames = 20, .turns = 2});
  const pose::trajectory estimate = synthetic::noisy(reference, {.position = 0.05});
  const auto b = align::batches(estimate, reference, {.sizes = {10, 10}});
  CHECK(*b[1].seam > 0.01);
  CHECK(*b[1].seam < 0.5);
  CHECK(*b[0].fit->half_rmse > b[0].fit->rmse);  // on poses that it was not fitted to
}

TEST_CASE("a degenerate batch is named and left out, not guessed") {
  pose::trajectory reference = synthetic::orbit({.frames = 21});
  for (std::size_t i = 10; i < 20; ++i)
    reference.world_from_camera[i].translation = {static_cast<double>(i), 0, 0};
  const auto b = align::batches(in_own_worlds(reference), reference, {.size = 10});
  REQUIRE(b.size() == 3);
  CHECK(!b[1].fit);
  CHECK(b[1].degenerate.find("lie on a line") != std::string::npos);
  CHECK(b[2].degenerate.find("in one place") != std::string::npos);
  CHECK(!b[2].seam);
  CHECK(pose::ape(align::transformed(b, in_own_worlds(reference)), reference).summary.count == 10);
}

TEST_CASE("sizes must add up") {
  const pose::trajectory t = synthetic::orbit({.frames = 20});
  CHECK_THROWS_AS(align::batches(t, t, {.sizes = {10, 9}}), argument_error);
  CHECK_THROWS_AS(align::batches(t, t, {.size = 0}), argument_error);
}

TEST_CASE("batches by lists of frames or of names") {
  pose::trajectory reference = synthetic::orbit({.frames = 30, .turns = 2});
  for (std::size_t i = 0; i < reference.size(); ++i) reference.names[i] = std::to_string(i);
  const pose::trajectory estimate = in_own_worlds(reference);
  const auto by_frame =
      align::batches(estimate, reference, {.frames = {{20, 22, 24, 26, 28}, {0, 1, 2, 3, 4, 5}}});
  REQUIRE(by_frame.size() == 2);
  CHECK(by_frame[0].fit->rmse < 1e-12);
  CHECK(*by_frame[1].seam < 1e-12);
  const pose::trajectory moved = align::transformed(by_frame, estimate);
  CHECK(moved.world_from_camera[28].is_finite());
  CHECK(!moved.world_from_camera[29].is_finite());  // in no batch
  CHECK(pose::ape(moved, reference).summary.count == 11);

  const auto by_name =
      align::batches(estimate, reference, {.names = {{"9", "8", "7", "0", "x.png"}, {"y.png"}}});
  CHECK(by_name[0].frames == std::vector<std::size_t>{9, 8, 7, 0});
  CHECK(by_name[0].missing == std::vector<std::string>{"x.png"});
  CHECK(by_name[0].fit->rmse < 1e-12);
  CHECK(by_name[1].degenerate.find("none of 0 frames") != std::string::npos);

  CHECK_THROWS_WITH_AS(align::batches(estimate, reference, {.frames = {{1, 2}, {2, 3}}}),
                       "align::batches: frame 2 comes twice", argument_error);
  CHECK_THROWS_WITH_AS(align::batches(estimate, reference, {.frames = {{30}}}),
                       "align::batches: frames below 30 expected, found 30", argument_error);
  reference.names.clear();
  CHECK_THROWS_AS(align::batches(reference, reference, {.names = {{"1"}}}), argument_error);
}

TEST_CASE("outliers of a batch are frames of the whole") {
  const pose::trajectory reference = synthetic::orbit({.frames = 30});
  pose::trajectory estimate = reference;
  estimate.world_from_camera[25].translation = {1e3, 0, 0};
  const auto b =
      align::batches(estimate, reference, {.size = 15, .align = {.outliers = {.factor = 5.0}}});
  CHECK(b[1].fit->outliers == std::vector<std::size_t>{25});
}

TEST_CASE("evo's alignment of each batch") {
  if (!support::has_shared("batches, evo")) return;
  const auto folder = support::shared() / "golden";
  for (const auto& c : support::golden_cases("trajectory")) {
    if (!c.at("inputs").contains("est")) continue;
    const auto json = support::read_json(folder / c.at("expected_file").get<std::string>());
    const auto& expected = json.at("expected");
    const pose::association a =
        pose::associate(io::read_tum(folder / c.at("inputs").at("est").get<std::string>()),
                        io::read_tum(folder / c.at("inputs").at("ref").get<std::string>()),
                        {.by = pose::match_by::stamp,
                         .max_gap_s = expected.at("main_association_max_diff"),
                         .rule = pose::association_rule::evo});
    const auto& batches = expected.at("batches");
    const auto ours = align::batches(a.estimate, a.reference, {.size = batches.at("batch_size")});
    REQUIRE(ours.size() == batches.at("results").size());
    for (std::size_t k = 0; k < ours.size(); ++k) {
      const auto& e = batches.at("results").at(k);
      CHECK(ours[k].frames.front() == e.at("first").get<std::size_t>());
      CHECK(ours[k].frames.size() == e.at("count").get<std::size_t>());
      CHECK(ours[k].fit.has_value() == !e.contains("raises"));
      if (!ours[k].fit) continue;
      CHECK(ours[k].fit->rmse == doctest::Approx(e.at("ate_rmse").get<double>()).epsilon(1e-7));
      CHECK((ours[k].fit->transform.rotation - support::matrix3(e.at("alignment").at("R"))).norm() <
            1e-7);
    }
  }
}

TEST_CASE("batches of COLMAP models end to end") {
  if (!support::has_shared("batches, end to end")) return;
  const auto folder = support::shared() / "golden";
  const auto json = support::read_json(folder / "e2e" / "expected_batches.json");
  const auto& expected = json.at("expected");
  const auto truth = io::read_colmap(folder / "e2e" / "batches_gt");
  std::vector<pose::trajectory> estimates, kept, kept_reference;
  std::vector<pose::camera_pair> views;
  const auto truth_cameras = io::cameras_by_name(truth);
  for (std::size_t k = 0; k < 3; ++k) {
    CAPTURE(k);
    const auto& e = expected.at("batches").at(k);
    const auto model = io::read_colmap(folder / "e2e" / ("batches_est_" + std::to_string(k)));
    for (const auto& [name, camera] : io::cameras_by_name(model))
      views.push_back({camera, truth_cameras.at(name)});
    estimates.push_back(model.trajectory);
    const pose::association a = pose::associate(model.trajectory, truth.trajectory);
    CHECK(a.n_matched == e.at("registered").get<std::size_t>());
    const auto fit = align::trajectory(a.estimate, a.reference, {.outliers = {.factor = 3}});
    std::vector<std::string> removed;
    for (const std::size_t i : fit.outliers) removed.push_back(a.reference.names[i]);
    CHECK(removed == e.at("removed").get<std::vector<std::string>>());
    const auto& sim3 = e.at("sim3_after_removal");
    CHECK(std::abs(fit.transform.scale / sim3.at("s").get<double>() - 1) <= 1e-8);
    CHECK((fit.transform.rotation - support::matrix3(sim3.at("R"))).norm() <= 1e-8);
    CHECK((fit.transform.translation - support::vector3(sim3.at("t"))).norm() <= 1e-8);
    CHECK(fit.rmse == doctest::Approx(e.at("ate_rmse_kept").get<double>()).epsilon(1e-8));
    const auto plain = align::trajectory(a.estimate, a.reference);
    CHECK(plain.transform.scale ==
          doctest::Approx(e.at("sim3_without_removal").at("s").get<double>()).epsilon(1e-8));
    CHECK(!plain.warnings.empty());
    CHECK(rmse(fit.transform * a.estimate, a.reference) ==
          doctest::Approx(e.at("ate_rmse_all").get<double>()).epsilon(1e-8));
    const auto& intra = e.at("auc_within_batch_all_registered");
    CHECK(std::abs(pose::auc(a.estimate, a.reference).auc -
                   intra.at("AUC_min_unfolded").at("30").get<double>()) <= 1e-12);
    std::vector<std::size_t> inliers;
    for (std::size_t i = 0; i < a.n_matched; ++i) {
      if (!std::binary_search(fit.outliers.begin(), fit.outliers.end(), i)) inliers.push_back(i);
    }
    kept.push_back(fit.transform * select(a.estimate, inliers));
    kept_reference.push_back(select(a.reference, inliers));
  }
  const auto& overall = expected.at("overall");
  CHECK(pose::registration_rate(estimates, truth.trajectory).rate ==
        overall.at("registration_rate").get<double>());
  CHECK(
      pose::auc(joined(kept), joined(kept_reference)).auc ==
      doctest::Approx(
          overall.at("auc_all_batches_aligned_kept").at("AUC_min_unfolded").at("30").get<double>())
          .epsilon(1e-9));
}

TEST_CASE("real GLOMAP and COLMAP models: recorded numbers, warnings, recovery") {
  if (!support::has_shared("glomap")) return;
  const auto folder = support::shared() / "scenes";
  const auto json = support::read_json(folder / "reference_glomap.json");
  for (const std::string scene : {"crane", "office_high"}) {
    const auto truth =
        io::read_trajectory(folder / "gt" / scene.substr(0, scene.find('_')) / "transforms.json");
    for (const auto& [method, models] : json.at(scene).items()) {
      const auto place = folder / "methods" / method / scene;
      if (!std::filesystem::exists(place)) continue;
      const auto ours = io::read_colmap_models(place);
      for (std::size_t k = 0; k < ours.size(); ++k) {
        CAPTURE(scene + "/" + method + "/" + std::to_string(k));
        const auto& e = models.at(std::to_string(k));
        const pose::association a =
            pose::associate(ours[k].trajectory, truth, {.ignore_folder = true});
        CHECK(a.n_matched == e.at("registered").get<std::size_t>());
        CHECK(pose::registration_rate(ours[k].trajectory, truth, {.ignore_folder = true}).rate ==
              e.at("registration_rate").get<double>());
        CHECK(std::abs(pose::auc(a.estimate, a.reference).auc -
                       e.at("pose").at("AUC30_paper_mean").get<double>()) <= 1e-12);
        CHECK(
            std::abs(
                pose::auc(a.estimate, a.reference, {.convention = pose::auc_convention::vggt}).auc -
                e.at("pose").at("AUC30_vggt_pairmax_sign_agnostic").get<double>()) <= 1e-12);
        // The recorded centres are R^T R c of matrices that are rotations to seven digits only.
        const auto& u = e.at("umeyama");
        if (!u.at("well_conditioned").get<bool>()) continue;
        const auto plain = align::trajectory(a.estimate, a.reference);
        CHECK(plain.transform.scale == doctest::Approx(u.at("scale").get<double>()).epsilon(1e-7));
        CHECK(plain.rmse == doctest::Approx(u.at("rmse").get<double>()).epsilon(1e-5));
        const auto trimmed =
            align::trajectory(a.estimate, a.reference, {.outliers = {.factor = 3}});
        CHECK(trimmed.n_inliers == u.at("outlier3xmedian").at("kept").get<std::size_t>());
        CHECK(trimmed.transform.scale ==
              doctest::Approx(u.at("outlier3xmedian").at("scale").get<double>()).epsilon(1e-7));
      }
    }
  }
  const auto stray = io::read_colmap(folder / "methods" / "glomap" / "crane").trajectory;
  const auto truth = io::read_trajectory(folder / "gt" / "crane" / "transforms.json");
  const pose::association a = pose::associate(stray, truth, {.ignore_folder = true});
  const auto plain = align::trajectory(a.estimate, a.reference);
  CHECK(plain.transform.scale < 0.2);
  CHECK(!plain.warnings.empty());
  const auto robust =
      align::trajectory(a.estimate, a.reference, {.robust = align::ransac_options{}});
  CHECK(robust.n_inliers > a.n_matched / 2);  // the majority agrees within millimetres
  CHECK(robust.rmse < 0.005);
  CHECK(robust.transform.scale == doctest::Approx(0.73).epsilon(0.01));
}

}  // namespace test_batches
