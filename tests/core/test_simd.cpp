// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/core/simd.hpp>
#include <aib/core/simd_integers.hpp>
#include <aib/core/simd_wide.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <limits>

using namespace aib;

namespace test_simd {

namespace {

/// The wide lanes have only the operations that are used.
template <class Lanes, class Scalar>
void check_lanes() {
  constexpr std::size_t n = Lanes::width;
  const Scalar nan = std::numeric_limits<Scalar>::quiet_NaN();
  Scalar a[n], b[n], out[n];
  for (std::size_t i = 0; i < n; ++i) {
    a[i] = static_cast<Scalar>(i) / 3;
    b[i] = static_cast<Scalar>(n - i) / 7;
  }
  b[1] = nan;
  const Lanes x = Lanes::load(a);
  const Lanes y = Lanes::load(b);
  const auto expect = [&](Lanes found, auto op) {
    found.store(out);
    for (std::size_t i = 0; i < n; ++i) {
      const Scalar wanted = op(a[i], b[i]);
      CHECK((out[i] == wanted || (std::isnan(out[i]) && std::isnan(wanted))));
    }
  };
  expect(x + y, [](Scalar p, Scalar q) { return p + q; });
  expect(x - y, [](Scalar p, Scalar q) { return p - q; });
  expect(x * y, [](Scalar p, Scalar q) { return p * q; });
  if constexpr (requires { x / y; }) expect(x / y, [](Scalar p, Scalar q) { return p / q; });
  if constexpr (requires { sqrt(x); })
    expect(sqrt(x), [](Scalar p, Scalar) { return std::sqrt(p); });
  expect(min(x, y), [](Scalar p, Scalar q) { return p < q ? p : q; });
  expect(max(x, y), [](Scalar p, Scalar q) { return p > q ? p : q; });
  if constexpr (requires { choose(x, y, x, y); }) {
    expect(choose(x, y, x, Lanes::broadcast(5)),
           [](Scalar p, Scalar q) { return p < q ? p : Scalar{5}; });
  }
  if constexpr (requires { less(x, y); }) {
    for (std::size_t i = 0; i < n; ++i) CHECK(((less(x, y) >> i) & 1) == (a[i] < b[i]));
  }
}

}  // namespace

TEST_CASE("integer lanes calculate as scalars do, modulo 2^32") {
  const std::uint32_t a[8] = {0, 1, 2, 3, 0xffffffff, 0x80000000, 0x7fffffff, 0x12345678};
  const std::uint32_t b[8] = {1, 1, 7, 0, 0xf0f0f0f0, 0x80000001, 3, 0x9abcdef0};
  const auto expect = [&](u32x8 found, auto op) {
    std::uint32_t out[8];
    found.store(out);
    for (std::size_t i = 0; i < 8; ++i) CHECK(out[i] == op(a[i], b[i]));
  };
  const u32x8 x = u32x8::load(a), y = u32x8::load(b);
  using u32 = std::uint32_t;
  expect(x & y, [](u32 p, u32 q) { return p & q; });
  expect(x | y, [](u32 p, u32 q) { return p | q; });
  expect(x ^ y, [](u32 p, u32 q) { return p ^ q; });
  expect(x - y, [](u32 p, u32 q) { return p - q; });
  expect(x << 5, [](u32 p, u32) { return p << 5; });
  expect(x >> 31, [](u32 p, u32) { return p >> 31; });
  expect(u32x8::broadcast(9), [](u32, u32) { return u32{9}; });
}

TEST_CASE("lanes calculate as scalars do, unordered lanes included") {
  check_lanes<f32x8, float>();
  check_lanes<f64x4, double>();
  check_lanes<f32x16, float>();
  check_lanes<f64x8, double>();
}

TEST_CASE("lanes are folded") {
  const float a[8] = {3, 1, 4, 1, 5, 9, 2, 6};
  CHECK(lowest(f32x8::load(a)) == 1);
  CHECK(highest(f32x8::load(a)) == 9);
  const double d[4] = {1, 2, 3, 4};
  CHECK(sum(f64x4::load(d)) == 10);
}

TEST_CASE("doubles are taken apart into mantissa and exponent") {
  const double a[4] = {1, 0.3, 1e300, 0x1p-1022};
  double m[4], e[4];
  mantissa(f64x4::load(a)).store(m);
  exponent(f64x4::load(a)).store(e);
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK((m[i] >= 1 && m[i] < 2));
    CHECK(std::ldexp(m[i], static_cast<int>(e[i])) == a[i]);
  }
}

TEST_CASE("floats are converted to doubles") {
  const float a[4] = {0.1f, -3, std::numeric_limits<float>::denorm_min(), 1e30f};
  double out[4];
  f64x4::convert(a).store(out);
  for (std::size_t i = 0; i < 4; ++i) CHECK(out[i] == static_cast<double>(a[i]));
}

TEST_CASE("eight doubles are two times four") {
  double a[8], b[8], wide[8], narrow[8];
  for (int i = 0; i < 8; ++i) {
    a[i] = 0.1 + i * 1.7;
    b[i] = 20.3 / (i + 1);
  }
  b[2] = std::numeric_limits<double>::quiet_NaN();
  const f64x8 x = f64x8::load(a), y = f64x8::load(b);
  const auto check = [&](f64x8 found, auto op) {
    found.store(wide);
    op(f64x4::load(a), f64x4::load(b)).store(narrow);
    op(f64x4::load(a + 4), f64x4::load(b + 4)).store(narrow + 4);
    for (int i = 0; i < 8; ++i)
      CHECK((wide[i] == narrow[i] || (std::isnan(wide[i]) && std::isnan(narrow[i]))));
  };
  check(x + y, [](f64x4 p, f64x4 q) { return p + q; });
  check(x - y, [](f64x4 p, f64x4 q) { return p - q; });
  check(x * y, [](f64x4 p, f64x4 q) { return p * q; });
  check(x / y, [](f64x4 p, f64x4 q) { return p / q; });
  check(min(x, y), [](f64x4 p, f64x4 q) { return min(p, q); });
  check(max(x, y), [](f64x4 p, f64x4 q) { return max(p, q); });
  check(choose(x, y, y, x), [](f64x4 p, f64x4 q) { return choose(p, q, q, p); });
  check(mantissa(x), [](f64x4 p, f64x4) { return mantissa(p); });
  check(exponent(x), [](f64x4 p, f64x4) { return exponent(p); });
  const float floats[8] = {1, 2, 3, 4, 5, 6, 7, 8};
  CHECK(sum(f64x8::convert(floats)) == 36);
}

}  // namespace test_simd
