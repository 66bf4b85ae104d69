// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/core/executor.hpp>
#include <aib/core/random.hpp>
#include <aib/raster/image.hpp>
#include <aib/raster/view.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace aib::survey {

/// How the numbers of an image stand for light.
enum class transfer {
  srgb,    ///< IEC 61966-2-1, as PNG and JPEG pictures are
  linear,  ///< in proportion
};

struct sensor_noise_options {
  /// Of light x in 0..1 (1 is the full scale of the sensor) the noise has the variance a x + b.
  double a = 2e-4;  ///< share of shot noise: the full scale is 1 / a electrons
  double b = 2e-6;  ///< variance of the reading: its root is the noise in the dark
  std::uint64_t seed = 1;
  std::uint64_t frame = 0;  ///< frames differ by it, whatever their order
  survey::transfer transfer = transfer::srgb;
  unsigned threads = 0;  ///< 0: all
  aib::control control = {};
};

/// Light of an sRGB number, both in 0..1.
[[nodiscard]] inline double linear_of_srgb(double v) {
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}
/// sRGB number of light, both in 0..1.
[[nodiscard]] inline double srgb_of_linear(double x) {
  return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
}

/// A number of a Poisson distribution, of any mean >= 0.
///
/// Below 30 by inversion; above by the rejection method PTRS.
/// Source: Hoermann, "The transformed rejection method for generating Poisson random variables",
/// Insurance: Mathematics and Economics 12, 1993.
[[nodiscard]] inline double poisson(random_engine& random, double mean) {
  if (!(mean > 0)) return 0;
  if (mean < 30) {
    double left = std::exp(-mean), k = 0;
    for (double u = random.uniform(); u > left && k < 1000; ++k) {
      u -= left;
      left *= mean / (k + 1);
    }
    return k;
  }
  const double log_mean = std::log(mean), b = 0.931 + 2.53 * std::sqrt(mean);
  const double a = -0.059 + 0.02483 * b, inverse_alpha = 1.1239 + 1.1328 / (b - 3.4);
  const double v_r = 0.9277 - 3.6224 / (b - 2);
  for (;;) {
    const double u = random.uniform() - 0.5, v = 1 - random.uniform();
    const double us = 0.5 - std::abs(u);
    const double k = std::floor((2 * a / us + b) * u + mean + 0.43);
    if (us >= 0.07 && v <= v_r) return k;
    if (k < 0 || (us < 0.013 && v > us)) continue;
    const double bound = k * log_mean - mean - std::lgamma(k + 1);
    if (std::log(v * inverse_alpha / (a / (us * us) + b)) <= bound) return k;
  }
}

/// Light as a sensor measures it: a Poisson(x / a) + N(0, b), clipped to 0..1.
/// Source: Foi, Trimeche, Katkovnik, Egiazarian, "Practical Poissonian-Gaussian noise modeling and
/// fitting for single-image raw-data", IEEE TIP 17, 2008, Eqs. (1) to (3) and (31).
[[nodiscard]] inline double measured_light(double x, double a, double b, random_engine& random) {
  const double shot = a > 0 ? a * poisson(random, x / a) : x;
  const double read = b > 0 ? std::sqrt(b) * random.normal() : 0;
  return std::clamp(shot + read, 0.0, 1.0);
}

/// An image with the noise of a sensor: colours of 8 or 16 bits, or gray. Noise is added to light,
/// each channel for itself, and what comes out is rounded.
///
/// The noise of a pixel depends on seed, frame, place and light alone: not on the order of frames
/// or the number of threads. Throws argument_error unless a and b are finite and >= 0.
template <class Pixel>
[[nodiscard]] raster::image<Pixel> sensor_noise(raster::view<const Pixel> image,
                                                const sensor_noise_options& options = {});

namespace detail {

template <std::unsigned_integral T>
T noisy_number(T value, const sensor_noise_options& o, random_engine& random) {
  constexpr double full = std::numeric_limits<T>::max();
  const double stored = static_cast<double>(value) / full;
  const bool srgb = o.transfer == transfer::srgb;
  const double light = measured_light(srgb ? linear_of_srgb(stored) : stored, o.a, o.b, random);
  return static_cast<T>(std::nearbyint(full * (srgb ? srgb_of_linear(light) : light)));
}

template <class T, std::size_t N>
std::array<T, N> noisy_number(const std::array<T, N>& pixel,
                              const sensor_noise_options& o,
                              random_engine& random) {
  std::array<T, N> out;
  for (std::size_t k = 0; k < N; ++k) out[k] = noisy_number(pixel[k], o, random);
  return out;
}

}  // namespace detail

template <class Pixel>
raster::image<Pixel> sensor_noise(raster::view<const Pixel> image,
                                  const sensor_noise_options& options) {
  if (!(options.a >= 0) || !(options.b >= 0) || !std::isfinite(options.a + options.b)) {
    throw argument_error(message("survey::sensor_noise: a and b from 0 expected, found ", options.a,
                                 " and ", options.b));
  }
  raster::image<Pixel> noisy(image.width, image.height);
  const std::uint64_t of_frame = random_bits(options.seed, options.frame);
  for_each_chunk(image.height, 16, options.threads, options.control, [&](const chunk& c) {
    for (std::size_t y = c.begin; y < c.end; ++y) {
      for (std::size_t x = 0; x < image.width; ++x) {
        random_engine random(random_bits(of_frame, y * image.width + x));
        noisy(x, y) = detail::noisy_number(image(x, y), options, random);
      }
    }
  });
  return noisy;
}

}  // namespace aib::survey
