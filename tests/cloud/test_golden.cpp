// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/cloud/compare.hpp>
#include <aib/cloud/eth3d.hpp>
#include <aib/io/ply.hpp>
#include <aib/sample/voxel.hpp>

#include <doctest/doctest.h>

#include <support/shared.hpp>

#ifdef AIB_WITH_JSON
#include <nlohmann/json.hpp>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

using namespace aib;

namespace {

struct golden_case {
  std::string name;
  nlohmann::json file;
  cloud::cloud estimate;
  cloud::cloud reference;

  [[nodiscard]] const nlohmann::json& expected() const { return file["expected"]; }
};

std::vector<golden_case> golden_cases() {
  std::vector<golden_case> cases;
  const auto golden = support::shared() / "golden";
  for (const auto& entry : std::filesystem::directory_iterator(golden / "cloud")) {
    if (entry.path().extension() != ".json") continue;
    std::ifstream stream(entry.path());
    golden_case c;
    c.file = nlohmann::json::parse(stream);
    c.name = c.file["case"];
    c.estimate = io::read_ply_cloud(golden / c.file["inputs"]["est"].get<std::string>());
    c.reference = io::read_ply_cloud(golden / c.file["inputs"]["gt"].get<std::string>());
    cases.push_back(std::move(c));
  }
  return cases;
}

void check_near(double found, double expected) {
  CHECK(std::abs(found - expected) <= 1e-5 * std::abs(expected) + 1e-9);
}

/// `at_tau` has the thresholds as text.
void check_scores(const cloud::threshold_scores& found, const nlohmann::json& at_tau) {
  for (const auto& [text, expected] : at_tau.items()) {
    if (std::stod(text) != found.tau) continue;
    CHECK(found.precision == expected["precision"].get<double>());
    CHECK(found.recall == expected["recall"].get<double>());
    check_near(found.f_score, expected["fscore"]);
    return;
  }
  FAIL("no expected scores at tau " << found.tau);
}

}  // namespace

TEST_CASE("clouds compare as Open3D, scipy, DA3 and CUT3R compare them") {
  if (!support::has_shared("cloud golden")) return;
  const auto cases = golden_cases();
  CHECK(cases.size() >= 8);
  for (const golden_case& g : cases) {
    CAPTURE(g.name);
    const auto& e = g.expected();
    const auto taus = g.file["params"]["taus"].get<std::vector<double>>();
    const auto both = cloud::distances_both_ways(g.estimate, g.reference);
    const auto c = cloud::score(both.to_reference, both.to_estimate, taus);
    CHECK(c.n_estimate == e["n_est"]);
    CHECK(c.n_reference == e["n_gt"]);
    check_near(c.accuracy, e["acc_mean"]);
    check_near(c.completeness, e["comp_mean"]);
    check_near(c.accuracy_median, e["acc_median"]);
    check_near(c.completeness_median, e["comp_median"]);
    check_near(c.accuracy_rmse, e["acc_rms"]);
    check_near(c.completeness_rmse, e["comp_rms"]);
    check_near(c.chamfer, e["chamfer_paper_sum"]);
    check_near(c.chamfer_mean, e["chamfer_mean_of_two"]);
    const auto& f1 = e["f1_paper_harmonic_of_distances"];  // null where both distances are 0
    check_near(c.f1_distance, f1.is_null() ? 0 : f1.get<double>());
    check_near(c.hausdorff, e["hausdorff"]);
    for (const auto& [percent, value] : e["percentiles_est_to_gt_numpy_linear"].items()) {
      check_near(both.to_reference.quantile(std::stod(percent) / 100), value);
    }
    for (const auto& found : c.scores) check_scores(found, e["at_tau"]);
  }
}

TEST_CASE("ETH3D's scores are its tool's") {
  if (!support::has_shared("ETH3D golden")) return;
  int n = 0;
  for (const golden_case& g : golden_cases()) {
    if (!g.expected().contains("eth3d")) continue;
    CAPTURE(g.name);
    const auto& e = g.expected()["eth3d"];
    const std::vector scans{cloud::laser_scan{g.reference, {0, 0, 0}}};
    const auto found = cloud::eth3d(
        g.estimate, scans,
        {.tolerances = e["Tolerances"].get<std::vector<double>>(), .voxel = e["voxel_size"]});
    for (std::size_t t = 0; t < found.scores.size(); ++t) {
      CAPTURE(t);
      const auto& s = found.scores[t];
      CHECK(std::abs(s.completeness - e["Completenesses"][t].get<double>()) < 1e-6);
      REQUIRE(s.accuracy.has_value());
      CHECK(std::abs(*s.accuracy - e["Accuracies"][t].get<double>()) < 1e-6);
      CHECK(std::abs(*s.f_score - e["F1-scores"][t].get<double>()) < 1e-6);
    }
    ++n;
  }
  CHECK(n >= 4);
}

TEST_CASE("voxels are Open3D's where the lattice is") {
  if (!support::has_shared("voxel golden")) return;
  const auto near = [](double found, double expected) {
    return std::abs(found - expected) <= 1e-3 * expected;
  };
  for (const golden_case& g : golden_cases()) {
    CAPTURE(g.name);
    for (const auto& [size, expected] : g.expected()["voxel_down_sample_open3d"].items()) {
      const sample::voxel_options how{.size = std::stod(size),
                                      .anchor = sample::voxel_anchor::open3d};
      const auto estimate = sample::voxel(g.estimate, how);
      const auto reference = sample::voxel(g.reference, how);
      CHECK(near(static_cast<double>(estimate.size()), expected["n_est"]));
      CHECK(near(static_cast<double>(reference.size()), expected["n_gt"]));
    }
  }
}
#endif

namespace test_golden {}  // namespace test_golden
