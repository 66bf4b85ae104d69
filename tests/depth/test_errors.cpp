// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/depth/errors.hpp>

#include <doctest/doctest.h>

#include "synthetic.hpp"
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

using namespace aib;
using doctest::Approx;

namespace test_errors {

namespace {

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

template <class Scalar>
raster::image<Scalar> row(std::initializer_list<double> depths) {
  raster::image<Scalar> image(depths.size(), 1);
  std::size_t x = 0;
  for (const double d : depths) image(x++, 0) = static_cast<Scalar>(d);
  return image;
}

template <class Scalar>
depth::error_summary errors(const raster::image<Scalar>& estimate,
                            const raster::image<Scalar>& reference,
                            const depth::error_options& options = {}) {
  return depth::errors(estimate.view(), reference.view(), options);
}

}  // namespace

TEST_CASE_TEMPLATE("errors of two pixels are those worked out by hand", T, float, double) {
  // Ratios e/r are 2 and 1/2, so d = -ln 2, ln 2 and mean d = 0.
  const auto result = errors(row<T>({2, 2}), row<T>({1, 4}));
  const double ln2 = std::log(2);
  CHECK(result.srmse == Approx(ln2 * ln2).epsilon(1e-14));
  CHECK(result.si_log_rmse == Approx(ln2).epsilon(1e-14));
  CHECK(result.silog == Approx(100 * ln2).epsilon(1e-14));
  CHECK(result.rmse_log == Approx(ln2).epsilon(1e-14));
  CHECK(result.log10 == Approx(std::log10(2)).epsilon(1e-14));
  CHECK(result.abs_rel == (1 + 0.5) / 2);
  CHECK(result.sq_rel == (1 + 1.0) / 2);
  CHECK(result.mae == (1 + 2) / 2.0);
  CHECK(result.rmse == Approx(std::sqrt((1 + 4) / 2.0)).epsilon(1e-15));
  CHECK(result.irmse == Approx(std::sqrt((0.25 + 0.0625) / 2)).epsilon(1e-15));
  CHECK(result.delta3 == 0);
  CHECK(result.scale == 1);
  CHECK(result.shift == 0);
}

TEST_CASE_TEMPLATE("a ratio of exactly 1.25 is not below it", T, float, double) {
  const auto result = errors(row<T>({5, 25, 125, 4, 4}), row<T>({4, 16, 64, 5, 4}));
  CHECK(result.delta1 == 1.0 / 5);
  CHECK(result.delta2 == 3.0 / 5);
  CHECK(result.delta3 == 4.0 / 5);
}

TEST_CASE("only pixels that are finite and > 0 in both maps count, and coverage says how many") {
  const auto estimate = row<double>({1, not_a_number, 2, 0, -1, inf, 3, 7});
  const auto reference = row<double>({1, 1, 2, 1, 1, 1, inf, not_a_number});
  const auto result = errors(estimate, reference);
  CHECK(result.n_valid == 2);
  CHECK(result.n_reference == 6);
  CHECK(result.n_estimate == 4);
  CHECK(result.coverage == 2.0 / 6);
  CHECK(result.rmse == 0);
}

TEST_CASE("min and max are exclusive bounds of the reference") {
  const auto depths = row<float>({1, 2, 3, 4});
  CHECK(errors(depths, depths, {.min = 1, .max = 4}).n_valid == 2);
  CHECK(errors(depths, depths, {.max = 4}).n_reference == 3);
}

TEST_CASE("a mask leaves pixels out of estimate and reference") {
  raster::image<std::uint8_t> mask(4, 1, 1);
  mask(1, 0) = 0;
  const auto result =
      errors(row<float>({1, 9, 1, 1}), row<float>({1, 1, 1, 0}), {.mask = mask.view()});
  CHECK(result.n_valid == 2);
  CHECK(result.n_reference == 2);
  CHECK(result.n_estimate == 3);
  CHECK(result.mae == 0);
}

TEST_CASE("a transform comes before the clamps, and drops what it moves behind the camera") {
  const auto estimate = row<double>({1, 2, 10, 40});
  const auto reference = row<double>({1, 1, 5, 10});
  const auto result =
      errors(estimate, reference, {.transform = {.scale = 0.5, .shift = -0.5}, .clamp_max = 10});
  CHECK(result.n_valid == 3);
  CHECK(result.coverage == 0.75);
  CHECK(result.mae == Approx((0.5 + 0.5 + 0) / 3));
  CHECK(result.scale == 0.5);
  CHECK(result.shift == -0.5);
  CHECK_THROWS_AS(
      errors(estimate, reference, {.align = depth::alignment::log, .transform = {.scale = 2}}),
      argument_error);
}

TEST_CASE("clamp_log touches the logarithms alone") {
  const auto result = errors(row<double>({1e-9}), row<double>({1}), {.clamp_log = 1e-5});
  CHECK(result.rmse_log == Approx(5 * std::log(10)));
  CHECK(result.mae == Approx(1 - 1e-9));
  CHECK(errors(row<double>({1, 0}), row<double>({1, 1}), {.clamp_log = 2}).rmse_log ==
        Approx(std::log(2)));
}

TEST_CASE("srmse keeps ten digits under a large mean log ratio, as two passes of long double do") {
  auto frame = synthetic::noisy_frame({.scale = 1e-6, .noise = 1e-5});
  frame.estimate(0, 0) *= 1e4f;  // an outlier in the first pixel must not spoil the sums
  const auto result = errors(frame.estimate, frame.reference);
  const auto exact = synthetic::log_moments(frame.estimate, frame.reference);
  CHECK(result.srmse == Approx(exact.variance).epsilon(1e-10));
  CHECK(result.rmse_log == Approx(std::sqrt(exact.mean_square)).epsilon(1e-13));
}

TEST_CASE("a pure scale has no srmse") {
  auto frame = synthetic::noisy_frame({.scale = 8, .noise = 0});
  CHECK(errors(frame.estimate, frame.reference).srmse < 1e-28);
}

TEST_CASE("the bits are the same for any number of threads and for rows with gaps") {
  const auto frame = synthetic::noisy_frame({.width = 517, .height = 391});
  const auto one = errors(frame.estimate, frame.reference, {.threads = 1});
  for (const unsigned threads : {2u, 3u, 0u}) {
    const auto many = errors(frame.estimate, frame.reference, {.threads = threads});
    CHECK(std::memcmp(&one, &many, sizeof one) == 0);
  }
  raster::image<float> wide(600, 391, 1e6f);
  for (std::size_t y = 0; y < 391; ++y)
    for (std::size_t x = 0; x < 517; ++x) wide(x + 5, y) = frame.estimate(x, y);
  const auto part = raster::part<const float>(wide, 5, 0, 517, 391);
  const auto gaps = depth::errors(part, frame.reference.view());
  CHECK(std::memcmp(&one, &gaps, sizeof one) == 0);
}

TEST_CASE("sums of parts merge to the sums of the whole") {
  const auto frame = synthetic::noisy_frame({});
  const auto e = frame.estimate.view();
  const auto r = frame.reference.view();
  auto sums =
      depth::sum_errors(raster::part(e, 0, 0, e.width, 10), raster::part(r, 0, 0, e.width, 10), {});
  sums += depth::sum_errors(raster::part(e, 0, 10, e.width, e.height - 10),
                            raster::part(r, 0, 10, e.width, e.height - 10), {});
  const auto merged = depth::summarize(sums);
  const auto whole = depth::errors(e, r);
  for (const auto& [name, value] : depth::error_fields) {
    CAPTURE(name);
    CHECK(merged.*value == Approx(whole.*value).epsilon(1e-12));
  }
  CHECK(merged.n_valid == whole.n_valid);
}

TEST_CASE("an estimate and a reference of different scalars are compared in double") {
  const raster::image<float> estimate(1, 1, 0.1f);
  const raster::image<double> reference(1, 1, 0.1);
  const auto result = depth::errors(estimate.view(), reference.view());
  CHECK(result.mae == static_cast<double>(0.1f) - 0.1);
}

TEST_CASE("sizes that differ are refused with both named") {
  const raster::image<float> small(160, 90, 1), large(480, 270, 1);
  CHECK_THROWS_WITH_AS(errors(small, large),
                       "depth::errors: the estimate is 160x90, the reference 480x270: downsample "
                       "one to the other first",
                       argument_error);
  const raster::image<std::uint8_t> mask(480, 270, 1);
  CHECK_THROWS_AS(errors(small, small, {.mask = mask.view()}), argument_error);
}

TEST_CASE("no valid pixel is undefined and says the counts") {
  CHECK_THROWS_WITH_AS(errors(row<float>({0, 1}), row<float>({1, 0})),
                       "depth::errors: no pixel is valid in both maps, 1 in the estimate, 1 in the "
                       "reference",
                       undefined_error);
  CHECK_THROWS_AS(errors(raster::image<float>(), raster::image<float>()), undefined_error);
  CHECK_THROWS_AS(errors(row<float>({0}), row<float>({1}), {.align = depth::alignment::median}),
                  undefined_error);
}

}  // namespace test_errors
