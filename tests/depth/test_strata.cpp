// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/depth/accumulate.hpp>
#include <aib/depth/boundary.hpp>
#include <aib/depth/boundary_errors.hpp>
#include <aib/depth/strata.hpp>

#include <doctest/doctest.h>

#include "synthetic.hpp"
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

using namespace aib;
using doctest::Approx;

namespace test_strata {

namespace {

template <class T>
raster::view<const T> view(const raster::image<T>& image) {
  return image.view();
}

/// 24 x 16 pixels that step up and down, as NumPy made them for the expected number.
raster::image<float> steps(std::size_t a, std::size_t b, std::size_t n, double size) {
  raster::image<float> map(24, 16);
  for (std::size_t y = 0; y < 16; ++y)
    for (std::size_t x = 0; x < 24; ++x)
      map(x, y) = static_cast<float>(1 + static_cast<double>((x * a + y * b) % n) * size);
  return map;
}

}  // namespace

TEST_CASE("errors by label are those of a mask of the label") {
  const auto f = synthetic::noisy_frame({.width = 100, .height = 60});
  raster::image<std::uint16_t> labels(100, 60);
  for (std::size_t i = 0; i < labels.size(); ++i)
    labels.data()[i] = static_cast<std::uint16_t>(i / 7 % 3 * 1000);
  const auto found =
      depth::errors_by_label(view(f.estimate), view(f.reference),
                             {.labels = view(labels), .crop = depth::crop_rule::garg});
  REQUIRE(found.size() == 3);
  for (const auto& [label, record] : found) {
    raster::image<std::uint8_t> mask(100, 60);
    for (std::size_t i = 0; i < mask.size(); ++i) mask.data()[i] = labels.data()[i] == label;
    const auto masked = depth::errors(view(f.estimate), view(f.reference),
                                      {.mask = mask, .crop = depth::crop_rule::garg});
    for (const auto& [name, value] : depth::error_fields) {
      INFO(name);
      CHECK((*record.errors).*value == Approx(masked.*value).epsilon(1e-12));
    }
    CHECK(record.errors->n_valid == masked.n_valid);
  }
}

TEST_CASE(
    "a label without a valid pixel has sums and no errors; labels of another size are refused") {
  const raster::image<float> reference(4, 1, 1);
  raster::image<float> estimate(4, 1, 1);
  raster::image<std::uint16_t> labels(4, 1, 1);
  labels(3, 0) = 2;
  estimate(3, 0) = 0;
  const auto found =
      depth::errors_by_label(view(estimate), view(reference), {.labels = view(labels)});
  CHECK(found.at(1).errors.has_value());
  CHECK_FALSE(found.at(2).errors.has_value());
  CHECK(found.at(2).sums.n_reference == 1);
  const raster::image<std::uint16_t> small(2, 1);
  CHECK_THROWS_AS(
      (void)depth::errors_by_label(view(estimate), view(reference), {.labels = view(small)}),
      argument_error);
  CHECK_THROWS_AS((void)depth::errors_by_label(view(estimate), view(reference), {}),
                  argument_error);
}

TEST_CASE("an accumulator of one label has the frames that show it") {
  const raster::image<float> reference(2, 1, 1);
  raster::image<float> estimate(2, 1, 1);
  estimate(1, 0) = 3;
  raster::image<std::uint16_t> labels(2, 1, 5);
  depth::accumulator all;
  all.add("plain", view(estimate), view(reference), {}, view(labels));
  labels(1, 0) = 6;
  all.add("both", view(estimate), view(reference), {}, view(labels));
  CHECK(all.labels() == std::vector<std::uint16_t>{5, 6});
  CHECK(all.of_label(6).frames().size() == 1);
  CHECK(all.of_label(6).result().mean.mae == 2);
  CHECK(all.of_label(5).result().mean.mae == 0.5);
  CHECK(all.of_label(5).result().pooled.mae == Approx(2.0 / 3));
  CHECK_THROWS_AS((void)all.of_label(7).result(), undefined_error);
}

TEST_CASE("the worst share is the smallest, the worst error the largest") {
  const raster::image<float> reference(2, 1, 1), good(2, 1, 1), bad(2, 1, 2);
  depth::accumulator all;
  all.add("good", view(good), view(reference));
  all.add("bad", view(bad), view(reference));
  CHECK(depth::worst_first(all.frames(), &depth::error_summary::mae).front() == 1);
  CHECK(depth::worst_first(all.frames(), &depth::error_summary::delta1).front() == 1);
}

TEST_CASE("srmse alone has the bits of errors") {
  const auto f = synthetic::noisy_frame({});
  for (const auto align : {depth::alignment::none, depth::alignment::median}) {
    const depth::error_options options{.align = align, .min = 2.5, .clamp_min = 1};
    CHECK(depth::srmse(view(f.estimate), view(f.reference), options) ==
          depth::errors(view(f.estimate), view(f.reference), options).srmse);
  }
}

TEST_CASE("strata: a bar before a wall is thin, its surroundings are an edge, sky is nothing") {
  raster::image<float> map(40, 30, 10);
  for (std::size_t y = 0; y < 30; ++y) {
    for (std::size_t x = 10; x < 13; ++x) map(x, y) = 5;  // a bar, 3 wide
    for (std::size_t x = 30; x < 40; ++x) map(x, y) = 0;  // sky
  }
  map(35, 15) = 20;  // a wire's pixel in the sky
  const auto strata = depth::strata(view(map));
  const auto at = [&](std::size_t x, std::size_t y) {
    return static_cast<depth::stratum>(strata(x, y));
  };
  for (std::size_t x = 10; x < 13; ++x) CHECK(at(x, 7) == depth::stratum::thin);
  CHECK(at(9, 7) == depth::stratum::edge);
  CHECK(at(8, 7) == depth::stratum::edge);
  CHECK(at(7, 7) == depth::stratum::inside);
  CHECK(at(14, 7) == depth::stratum::edge);
  CHECK(at(15, 7) == depth::stratum::inside);
  CHECK(at(29, 7) == depth::stratum::edge);
  CHECK(at(30, 7) == depth::stratum::nothing);
  CHECK(at(35, 15) == depth::stratum::thin);
  CHECK(depth::strata(view(map), {.thin_width = 2})(11, 7) == 2);
  CHECK(depth::strata(view(raster::image<float>())).empty());
  CHECK_THROWS_AS((void)depth::strata(view(map), {.jump = 0}), argument_error);
}

TEST_CASE("strata: a slanted floor has no edges, and the border of the image ends nothing") {
  raster::image<float> map(20, 20);
  for (std::size_t y = 0; y < 20; ++y)
    for (std::size_t x = 0; x < 20; ++x)
      map(x, y) = x < 3 ? 2 : static_cast<float>(10 + 0.2 * static_cast<double>(y));
  const auto strata = depth::strata(view(map));
  CHECK(strata(0, 10) == 1);
  CHECK(strata(2, 10) == 2);
  CHECK(strata(10, 10) == 1);
}

TEST_CASE("boundary F1 is Depth Pro's") {
  const auto estimate = steps(7, 13, 11, 0.1), reference = steps(5, 3, 7, 0.15);
  CHECK(depth::boundary_f1(view(estimate), view(reference)) ==
        Approx(0.3979978319350959).epsilon(1e-12));
  CHECK(depth::boundary_f1(view(reference), view(reference)) == Approx(1));
}

TEST_CASE("boundary F1 keeps its properties: single step, flat map, one pixel off, holes") {
  raster::image<float> step(8, 8, 1), shifted(8, 8, 1);
  for (std::size_t y = 0; y < 8; ++y) {
    for (std::size_t x = 4; x < 8; ++x) step(x, y) = 2;
    for (std::size_t x = 5; x < 8; ++x) shifted(x, y) = 2;
  }
  CHECK(depth::boundary_f1(view(step), view(step)) == Approx(0.25));
  CHECK(depth::boundary_f1(view(shifted), view(step)) == 0);
  const raster::image<float> flat(8, 8, 1);
  CHECK(depth::boundary_f1(view(flat), view(flat)) == 0);
  auto hole = step;
  hole(1, 1) = std::numeric_limits<float>::quiet_NaN();
  CHECK(depth::boundary_f1(view(hole), view(step)) == Approx(0.25));
  hole(1, 1) = 0;
  CHECK(depth::boundary_f1(view(hole), view(step)) < 0.25);
  CHECK_THROWS_AS((void)depth::boundary_f1(view(step), view(step), {.n = 0}), argument_error);
}

namespace {

/// A disc and a block before a slanted wall.
raster::image<float> disc_and_block(int x, int y, int square, std::size_t block, double wall) {
  raster::image<float> map(64, 48);
  for (std::size_t v = 0; v < 48; ++v) {
    for (std::size_t u = 0; u < 64; ++u) {
      const int dx = static_cast<int>(u) - x, dy = static_cast<int>(v) - y;
      const double slant = 0.01 * static_cast<double>(u) + 0.003 * static_cast<double>(v);
      map(u, v) = static_cast<float>((dx * dx + dy * dy < square ? 2.0 : wall) + slant);
      if (v >= 30 && v < 42 && u >= block && u < block + 17) map(u, v) = 3.25F;
    }
  }
  return map;
}

}  // namespace

// Expected: iBims-1's formulas with scikit-image 0.19 and SciPy.
TEST_CASE("boundary errors are those of iBims-1") {
  const auto reference = disc_and_block(20, 15, 90, 40, 5.0);
  const auto estimate = disc_and_block(22, 16, 85, 38, 5.5);
  const auto edges = depth::depth_edges(reference);
  const auto found = depth::boundary_error(estimate, edges);
  CHECK(found.n_estimate == 128);
  CHECK(found.n_reference == 128);
  CHECK(found.accuracy == Approx(1.076170581975328).epsilon(1e-12));
  CHECK(found.completeness == Approx(1.0854090904987332).epsilon(1e-12));
}

TEST_CASE("boundary errors: the same map, no edge near, no true edge, other sizes") {
  const auto reference = disc_and_block(20, 15, 90, 40, 5.0);
  const auto edges = depth::depth_edges(reference);
  CHECK(depth::boundary_error(reference, edges).completeness == 0);
  const raster::image<float> flat(64, 48, 2);
  const auto missed = depth::boundary_error(flat, edges);
  CHECK(missed.accuracy == 10);
  CHECK(missed.completeness == 10);
  CHECK(missed.n_estimate == 0);
  const raster::image<std::uint8_t> none(64, 48), small(3, 3, 1);
  CHECK_THROWS_AS((void)depth::boundary_error(reference, none), undefined_error);
  CHECK_THROWS_AS((void)depth::boundary_error(reference, small), argument_error);
}

}  // namespace test_strata
