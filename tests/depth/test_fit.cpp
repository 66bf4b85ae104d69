// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/depth/errors.hpp>
#include <aib/depth/fit.hpp>

#include <doctest/doctest.h>

#include "synthetic.hpp"
#include <initializer_list>

using namespace aib;
using depth::alignment;
using doctest::Approx;

namespace test_fit {

namespace {

raster::image<double> row(std::initializer_list<double> depths) {
  raster::image<double> image(depths.size(), 1);
  std::size_t x = 0;
  for (const double d : depths) image(x++, 0) = d;
  return image;
}

depth::affine fit(alignment kind,
                  const raster::image<double>& estimate,
                  const raster::image<double>& reference) {
  depth::fitter fitter(kind);
  fitter.add(estimate.view(), reference.view());
  return fitter.result();
}

constexpr alignment all[] = {alignment::median,   alignment::median_lower, alignment::scale,
                             alignment::scale_l1, alignment::scale_shift,  alignment::log};

}  // namespace

TEST_CASE("every alignment finds the scale of a scaled map") {
  const auto reference = row({1, 2, 3, 5, 8});
  const auto estimate = row({4, 8, 12, 20, 32});
  for (const alignment kind : all) {
    CAPTURE(static_cast<int>(kind));
    CHECK(fit(kind, estimate, reference).scale == Approx(0.25).epsilon(1e-12));
    CHECK(fit(kind, estimate, reference).shift == Approx(0).epsilon(1e-12));
  }
}

TEST_CASE("medians are of each map: mean of the middle two, or the lower") {
  const auto estimate = row({1, 1, 3, 9});
  const auto reference = row({10, 20, 40, 80});
  CHECK(fit(alignment::median, estimate, reference).scale == 30.0 / 2);
  CHECK(fit(alignment::median_lower, estimate, reference).scale == 20.0 / 1);
}

TEST_CASE("scale is least squares of the depths, log of their logarithms") {
  const auto estimate = row({1, 2});
  const auto reference = row({2, 8});
  CHECK(fit(alignment::scale, estimate, reference).scale == Approx((2 + 16) / 5.0));
  CHECK(fit(alignment::log, estimate, reference).scale == Approx(std::sqrt(2 * 4.0)));
}

TEST_CASE("scale_shift finds both, far from 0 too") {
  const auto fitted = fit(alignment::scale_shift, row({1e6 + 1, 1e6 + 2, 1e6 + 4}), row({3, 5, 9}));
  CHECK(fitted.scale == Approx(2).epsilon(1e-12));
  CHECK(fitted.shift == Approx(1 - 2e6).epsilon(1e-12));
}

TEST_CASE("scale_l1 is held by the many where one pixel is far off") {
  CHECK(fit(alignment::scale_l1, row({1, 2, 3, 4, 5}), row({2, 4, 6, 8, 100})).scale ==
        Approx(2).epsilon(1e-2));
}

TEST_CASE("an aligned frame is measured in the scale that was fitted") {
  const auto frame = synthetic::noisy_frame({.scale = 0.37});
  const auto aligned =
      depth::errors(frame.estimate.view(), frame.reference.view(), {.align = alignment::log});
  const auto plain = depth::errors(frame.estimate.view(), frame.reference.view());
  CHECK(aligned.srmse == Approx(plain.srmse).epsilon(1e-9));
  CHECK(aligned.rmse_log == Approx(plain.si_log_rmse).epsilon(1e-9));
  CHECK(aligned.scale == Approx(1 / 0.37).epsilon(1e-3));
}

TEST_CASE("fitters of the frames of a batch merge to the fitter of the batch") {
  const auto a = synthetic::noisy_frame({.width = 30, .height = 20, .scale = 0.5});
  const auto b = synthetic::noisy_frame({.width = 50, .height = 40, .scale = 0.4});
  for (const alignment kind : all) {
    CAPTURE(static_cast<int>(kind));
    depth::fitter whole(kind), first(kind), second(kind);
    whole.add(a.estimate.view(), a.reference.view());
    whole.add(b.estimate.view(), b.reference.view());
    first.add(a.estimate.view(), a.reference.view());
    second.add(b.estimate.view(), b.reference.view());
    first += second;
    CHECK(first.n_valid() == whole.n_valid());
    CHECK(first.result().scale == Approx(whole.result().scale).epsilon(1e-12));
    CHECK(first.result().shift == Approx(whole.result().shift).epsilon(1e-9));
  }
  CHECK_THROWS_AS(depth::fitter(alignment::log) += depth::fitter(alignment::scale), argument_error);
}

TEST_CASE("what cannot be fitted is undefined") {
  CHECK_THROWS_AS(fit(alignment::median, row({0}), row({1})), undefined_error);
  CHECK_THROWS_AS(fit(alignment::scale_shift, row({2, 2}), row({1, 3})), undefined_error);
  CHECK(fit(alignment::none, row({0}), row({1})) == depth::affine{});
}

}  // namespace test_fit
