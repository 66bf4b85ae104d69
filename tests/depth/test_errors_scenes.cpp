// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/depth/accumulate.hpp>
#include <aib/io/file.hpp>
#include <aib/raster/downsample.hpp>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "support/shared.hpp"
#include <string>
#include <vector>

#ifdef AIB_WITH_EXR

#include <aib/io/depth.hpp>

using namespace aib;
using doctest::Approx;
using raster::nearest_rule;

namespace {

struct rule_name {
  nearest_rule rule;
  const char* name;  ///< in the recorded numbers
};

void check_scene(const std::string& scene, const std::string& run, const std::string& truth) {
  CAPTURE(scene);
  CAPTURE(run);
  const auto root = support::shared() / "scenes";
  const auto recorded =
      nlohmann::json::parse(io::read_file(root / "reference.json"))[scene][run]["depth"];
  for (const auto& [rule, name] :
       {rule_name{nearest_rule::centre, "centre"}, rule_name{nearest_rule::floor, "corner"}}) {
    CAPTURE(name);
    std::vector<std::string> files;
    for (const auto& [file, numbers] : recorded["per_frame"].items()) files.push_back(file);
    const auto load = [&](std::size_t i) {
      auto estimate = io::read_depth(root / "methods" / run / scene / "depth" / files[i]);
      auto reference = io::read_depth(
          root / "gt" / truth / "depth" / files[i],
          {.width = estimate.values.width(), .height = estimate.values.height(), .rule = rule});
      return depth::frame{files[i], std::move(estimate), std::move(reference)};
    };
    const auto frames = depth::accumulate(files.size(), {}, load);
    for (const auto& frame : frames.frames()) {
      CAPTURE(frame.name);
      const auto& expected = recorded["per_frame"][frame.name][name];
      REQUIRE(frame.errors.has_value());
      CHECK(frame.errors->srmse == Approx(expected["sq"].get<double>()).epsilon(1e-9));
      CHECK(frame.errors->si_log_rmse == Approx(expected["sqrt"].get<double>()).epsilon(1e-9));
      CHECK(frame.errors->n_valid == expected["valid"]);
    }
    const auto mean = frames.result().mean;
    const std::string rule_suffix = name;
    CHECK(mean.srmse == Approx(recorded["mean_sq_" + rule_suffix].get<double>()).epsilon(1e-9));
    CHECK(mean.si_log_rmse ==
          Approx(recorded["mean_sqrt_" + rule_suffix].get<double>()).epsilon(1e-9));
  }
}

}  // namespace

TEST_CASE("srmse of the rendered scenes is the recorded one for both index rules") {
  if (!support::has_shared("depth scenes")) return;
  check_scene("crane", "sgbm_gtposes", "crane");
  check_scene("crane", "sgbm_colmap", "crane");
  check_scene("office_high", "sgbm_gtposes", "office");
  check_scene("office_high", "sgbm_colmap", "office");
}

#endif

namespace test_errors_scenes {}  // namespace test_errors_scenes
