// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/depth/errors.hpp>
#include <aib/depth/presets.hpp>
#include <aib/raster/downsample.hpp>

#include <doctest/doctest.h>

#include "golden.hpp"
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

using namespace aib;
using depth::alignment;

namespace test_errors_golden {

namespace {

/// A zero is compared absolutely: below 1e-12 both are rounding.
bool near(double found, double expected, double relative) {
  return std::abs(found - expected) <= std::max(relative * std::abs(expected), 1e-12);
}

void check_direct(const nlohmann::json& expected,
                  const raster::image<double>& estimate,
                  const raster::image<double>& reference,
                  const depth::error_options& base) {
  const auto aligned = [&](alignment kind) {
    depth::error_options options = base;
    options.align = kind;
    return depth::errors(estimate.view(), reference.view(), options);
  };
  const auto holds = [](const char* name, double found, double value, double scale = 1) {
    INFO(name, ": ", found, " expected ", value);
    CHECK(near(found, value * scale, 1e-9));
  };
  const auto plain = aligned(alignment::none);
  CHECK(plain.n_valid == expected["valid_both"]);
  CHECK(plain.n_reference == expected["valid_gt"]);
  holds("srmse", plain.srmse, expected["sRMSE_paper_formula_no_root"]);
  holds("si_log_rmse", plain.si_log_rmse, expected["sRMSE_with_root"]);
  holds("silog", plain.silog, expected["sRMSE_with_root"], 100);

  const struct {
    const char* errors;
    const char* scale;
    alignment kind;
  } cases[] = {{"no_alignment", nullptr, alignment::none},
               {"median_scaled", "scale_median_numpy", alignment::median},
               {"lsq_scaled", "scale_lsq", alignment::scale},
               {"logmean_scaled", "scale_log_mean", alignment::log}};
  for (const auto& c : cases) {
    CAPTURE(c.errors);
    const auto result = aligned(c.kind);
    const auto& values = expected[c.errors];
    if (c.scale) holds("scale", result.scale, expected[c.scale]);
    holds("abs_rel", result.abs_rel, values["abs_rel"]);
    holds("sq_rel", result.sq_rel, values["sq_rel"]);
    holds("rmse", result.rmse, values["rmse"]);
    holds("rmse_log", result.rmse_log, values["rmse_log"]);
    holds("mae", result.mae, values["mae"]);
    holds("irmse", result.irmse, values["irmse_1/km"], 1e-3);
    holds("log10", result.log10, values["log10"]);
    const double slack =
        values["delta_near_threshold_1e-9"].get<double>() / static_cast<double>(result.n_valid);
    CHECK(std::abs(result.delta1 - values["delta1"].get<double>()) <= slack);
    CHECK(std::abs(result.delta2 - values["delta2"].get<double>()) <= slack);
    CHECK(std::abs(result.delta3 - values["delta3"].get<double>()) <= slack);
  }
  const auto shifted = aligned(alignment::scale_shift);
  holds("scale of scale_shift", shifted.scale, expected["scale_shift_lsq"][0]);
  CHECK(std::abs(shifted.shift - expected["scale_shift_lsq"][1].get<double>()) < 1e-9);
}

/// The errors that video depth scripts print, by their alignment of the only frame.
///
/// The weights 1 / (|residual| + 1e-8) of scale_weiszfeld make it hang on single pixels that fit by
/// chance: the script itself gives numbers up to 1 % apart for float and double copies of a map.
void check_video_depth(const nlohmann::json& peer,
                       const raster::image<double>& estimate,
                       const raster::image<double>& reference,
                       const depth::error_options& base) {
  const std::pair<const char*, alignment> cases[] = {
      {"metric", alignment::none},
      {"median", depth::options_of(depth::preset::cut3r).errors.align},
      {"scale_weiszfeld", alignment::scale_l1},
      {"lstsq_scale_shift", alignment::scale_shift}};
  for (const auto& [name, kind] : cases) {
    depth::error_options options = base;
    options.align = kind;
    options.clamp_log = depth::options_of(depth::preset::cut3r).errors.clamp_log;
    const auto result = depth::errors(estimate.view(), reference.view(), options);
    const std::pair<const char*, double> fields[] = {
        {"Abs Rel", result.abs_rel},   {"Sq Rel", result.sq_rel},   {"RMSE", result.rmse},
        {"Log RMSE", result.rmse_log}, {"δ < 1.25", result.delta1}, {"δ < 1.25^2", result.delta2},
        {"δ < 1.25^3", result.delta3},
    };
    const double relative = kind == alignment::scale_l1 ? 1e-2 : 1e-6;
    CHECK(result.n_valid == peer[name]["valid_pixels"]);
    for (const auto& [field, found] : fields) {
      INFO(name, ", ", field, ": ", found, " expected ", peer[name][field].get<double>());
      CHECK(near(found, peer[name][field], relative));
    }
  }
}

void check_monodepth2(const nlohmann::json& peers,
                      const raster::image<double>& estimate,
                      const raster::image<double>& reference,
                      const depth::error_options& base) {
  const auto check = [&](const nlohmann::json& peer, alignment kind) {
    depth::error_options options = base;
    options.align = kind;
    const auto result = depth::errors(estimate.view(), reference.view(), options);
    CHECK(near(result.abs_rel, peer["abs_rel"], 1e-6));
    CHECK(near(result.sq_rel, peer["sq_rel"], 1e-6));
    CHECK(near(result.rmse, peer["rmse"], 1e-6));
    CHECK(near(result.rmse_log, peer["rmse_log"], 1e-6));
    CHECK(near(result.delta2, peer["a2"], 1e-6));
    CHECK(near(result.delta3, peer["a3"], 1e-6));
    return result.scale;
  };
  check(peers["monodepth2_raw"], alignment::none);
  CHECK(near(check(peers["monodepth2_median_scaled"],
                   depth::options_of(depth::preset::monodepth2).errors.align),
             peers["monodepth2_median_ratio"], 1e-9));
}

void check_case(const std::string& name) {
  if (!support::has_shared("depth golden")) return;
  CAPTURE(name);
  const auto golden = golden::read_case(name);
  const auto estimate = golden::read_map(golden["inputs"]["est"]);
  auto reference = golden::read_map(golden["inputs"]["gt"]);
  if (!estimate || !reference) {
    MESSAGE("SKIPPED: depth golden ", name, ": its format is not built in");
    return;
  }
  depth::error_options options;
  if (const auto& max = golden["inputs"]["dmax"]; max.is_number()) options.max = max;
  const auto& expected = golden["expected"];
  if (expected.contains("direct")) {
    check_direct(expected["direct"], *estimate, *reference, options);
    check_video_depth(expected["peers"]["cut3r"], *estimate, *reference, options);
    check_video_depth(expected["peers"]["pi3"], *estimate, *reference, options);
    check_monodepth2(expected["peers"], *estimate, *reference, options);
    return;
  }
  const auto at = [&](raster::nearest_rule rule) {
    return raster::resample_nearest<double>(reference->view(), estimate->width(),
                                            estimate->height(), rule);
  };
  check_direct(expected["nearest_floor_index"]["result"], *estimate,
               at(raster::nearest_rule::floor), options);
  check_direct(expected["nearest_pixel_centre"]["result"], *estimate,
               at(raster::nearest_rule::centre), options);
}

}  // namespace

TEST_CASE("depth errors are NumPy's to nine digits, those of CUT3R, pi3, monodepth2 to six") {
  for (const char* name : {"dmax_3m", "exact_scale", "invalid_zoo", "livingroom00_png_npy",
                           "livingroom_10_vs_20_png", "sensor_lowres_nearest", "sensor_pfm_exr"})
    check_case(name);
}

}  // namespace test_errors_golden
