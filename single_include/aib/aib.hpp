// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
//
// aib 0.1.0, the whole library in one header, made by single_include/amalgamate.py.
// Compile with -std=c++20 -ffp-contract=off: results are then the same bits on every machine.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/SVD>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <numbers>
#include <optional>
#include <ranges>
#include <span>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <string_view>
#include <sys/stat.h>
#include <system_error>
#include <thread>
#include <type_traits>
#include <unistd.h>
#include <utility>
#include <vector>

// aib/core/concepts.hpp

namespace aib {

/// Teaches aib a point type. A specialisation has
///   using scalar = float or double;
///   static scalar coordinate(const Point& point, int axis);   // axis 0, 1, 2
template <class Point>
struct point_traits;

template <std::floating_point Scalar, int Options>
struct point_traits<Eigen::Matrix<Scalar, 3, 1, Options>> {
  using scalar = Scalar;
  static scalar coordinate(const Eigen::Matrix<Scalar, 3, 1, Options>& point, int axis) {
    return point[axis];
  }
};

template <std::floating_point Scalar>
struct point_traits<std::array<Scalar, 3>> {
  using scalar = Scalar;
  static scalar coordinate(const std::array<Scalar, 3>& point, int axis) {
    return point[static_cast<std::size_t>(axis)];
  }
};

/// A type that `point_traits` knows.
template <class Point>
concept point = requires(const Point& p) {
  typename point_traits<Point>::scalar;
  { point_traits<Point>::coordinate(p, 0) } -> std::same_as<typename point_traits<Point>::scalar>;
};

/// Any sized random-access range of points: a vector, a span, a range of your own.
template <class Range>
concept point_range = std::ranges::random_access_range<const Range> &&
    std::ranges::sized_range<const Range> && point<std::ranges::range_value_t<const Range>>;

/// Scalar of the points of a range.
template <point_range Range>
using scalar_of = typename point_traits<std::ranges::range_value_t<const Range>>::scalar;

/// The point as an Eigen vector of another scalar.
template <class Scalar, point Point>
Eigen::Matrix<Scalar, 3, 1> as_vector(const Point& p) {
  using traits = point_traits<Point>;
  return {static_cast<Scalar>(traits::coordinate(p, 0)),
          static_cast<Scalar>(traits::coordinate(p, 1)),
          static_cast<Scalar>(traits::coordinate(p, 2))};
}

}  // namespace aib

// aib/core/message.hpp

namespace aib {

namespace detail {

inline void append(std::string& out, std::string_view part) { out += part; }

template <class Number>
requires std::is_arithmetic_v<Number>
void append(std::string& out, Number value) {
  if constexpr (std::is_same_v<Number, bool>) {
    out += value ? "true" : "false";
  } else if constexpr (std::is_same_v<Number, char>) {
    out += value;
  } else {
    char digits[32];
    const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
    out.append(digits, end);
  }
}

}  // namespace detail

/// The parts written one after another; numbers in their shortest exact form, in no locale.
template <class... Parts>
[[nodiscard]] std::string message(const Parts&... parts) {
  std::string out;
  (detail::append(out, parts), ...);
  return out;
}

}  // namespace aib

// aib/core/error.hpp

namespace aib {

/// Root of every exception that aib throws. The message says where, what was expected, what was
/// found.
class error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A file cannot be opened, read or written.
class io_error : public error {
 public:
  io_error(const std::filesystem::path& path, std::string_view what)
      : error(message(path.string(), ": ", what)) {}
};

/// One-based line of a text file.
struct at_line {
  std::size_t number;
};

/// Zero-based byte of a binary file.
struct at_byte {
  std::uint64_t offset;
};

/// The content of a file is not what its format demands.
class format_error : public error {
 public:
  format_error(const std::filesystem::path& path, std::string_view what)
      : error(message(path.string(), ": ", what)) {}
  format_error(const std::filesystem::path& path, at_line line, std::string_view what)
      : error(message(path.string(), ":", line.number, ": ", what)) {}
  format_error(const std::filesystem::path& path, at_byte byte, std::string_view what)
      : error(message(path.string(), ": byte ", byte.offset, ": ", what)) {}
};

/// The caller passed something that the function does not accept.
class argument_error : public error {
 public:
  using error::error;
};

/// A metric over nothing: no valid pixel, no pair, an empty cloud. Carries the counts in its
/// message.
class undefined_error : public error {
 public:
  using error::error;
};

/// The work was stopped through its stop token; nothing half-done is left behind.
class stopped_error : public error {
 public:
  using error::error;
};

}  // namespace aib

// aib/core/executor.hpp

#if defined(__linux__)
#include <sched.h>
#endif

namespace aib {

/// How a caller watches and stops long work. Every option struct with `threads` may carry one.
struct control {
  std::stop_token stop = {};  ///< stops between chunks with stopped_error
  std::function<void(double share)> progress =
      {};  ///< called with 0..1, never from two threads at once
};

/// Threads that the process may use: affinity mask and cgroup quota, at least 1.
unsigned available_threads();

/// The index range [begin, end) of chunk number `index`.
struct chunk {
  std::size_t begin;
  std::size_t end;
  std::size_t index;
};

/// Calls `body(chunk)` for the chunks of [0, n), each `size` items but the last. Chunks depend on
/// `size` alone, so that per-chunk results combined in order are bit-identical for any number of
/// threads.
///
/// threads   0: available_threads()
///
/// A call from inside a body runs on the calling thread. The first exception (lowest chunk) is
/// rethrown. Throws stopped_error when `control.stop` was requested.
template <class Body>
void for_each_chunk(
    std::size_t n, std::size_t size, unsigned threads, const control& control, Body&& body);

/// Maps each chunk to a T and folds them in chunk order: `total = combine(total, map(chunk))`.
template <class T, class Map, class Combine>
T reduce_chunks(std::size_t n,
                std::size_t size,
                unsigned threads,
                const control& control,
                T total,
                Map&& map,
                Combine&& combine);

namespace detail {

inline thread_local bool inside_worker = false;

struct worker_scope {
  bool outer = std::exchange(inside_worker, true);
  ~worker_scope() { inside_worker = outer; }
};

inline unsigned cgroup_threads() {
  std::ifstream file("/sys/fs/cgroup/cpu.max");
  std::string quota;
  double period = 0;
  if (!(file >> quota >> period) || quota == "max" || period <= 0) return ~0u;
  const double threads = std::strtod(quota.c_str(), nullptr) / period;
  return static_cast<unsigned>(std::max(1.0, std::min(threads + 0.5, 1e6)));
}

/// What the workers of one parallel region share.
class region {
 public:
  region(std::size_t n, std::size_t size, const control& control)
      : n_(n), size_(size), chunks_((n + size - 1) / size), control_(control) {}

  std::size_t chunks() const { return chunks_; }

  template <class Body>
  void work(Body& body) {
    const worker_scope scope;
    for (std::size_t i; !stopped() && (i = next_.fetch_add(1)) < chunks_;) {
      try {
        body(chunk{i * size_, std::min(n_, (i + 1) * size_), i});
        finished();
      } catch (...) {
        failed(i);
      }
    }
  }

  void finish() const {
    if (failure_) std::rethrow_exception(failure_);
    if (done_ < chunks_) throw stopped_error("stopped");
  }

 private:
  bool stopped() const {
    return control_.stop.stop_requested() || cancel_.load(std::memory_order_relaxed);
  }

  void finished() {
    const std::scoped_lock lock(mutex_);
    ++done_;
    if (control_.progress)
      control_.progress(static_cast<double>(done_) / static_cast<double>(chunks_));
  }

  void failed(std::size_t index) {
    const std::scoped_lock lock(mutex_);
    cancel_ = true;
    if (index < failed_at_) {
      failed_at_ = index;
      failure_ = std::current_exception();
    }
  }

  std::size_t n_, size_, chunks_;
  const control& control_;
  std::atomic<std::size_t> next_ = 0;
  std::atomic<bool> cancel_ = false;
  std::mutex mutex_;
  std::size_t done_ = 0;
  std::size_t failed_at_ = ~std::size_t{0};
  std::exception_ptr failure_;
};

}  // namespace detail

inline unsigned available_threads() {
  unsigned threads = std::max(1u, std::thread::hardware_concurrency());
#if defined(__linux__)
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof set, &set) == 0)
    threads = static_cast<unsigned>(std::max(1, CPU_COUNT(&set)));
#endif
  return std::min(threads, detail::cgroup_threads());
}

template <class Body>
void for_each_chunk(
    std::size_t n, std::size_t size, unsigned threads, const control& control, Body&& body) {
  if (size == 0) throw argument_error("for_each_chunk: chunk size 0");
  if (n == 0) return;
  detail::region region(n, size, control);
  if (threads == 0) threads = available_threads();
  const std::size_t workers =
      detail::inside_worker ? 1 : std::min<std::size_t>(threads, region.chunks());
  {
    std::vector<std::jthread> pool;
    pool.reserve(workers - 1);
    for (std::size_t i = 1; i < workers; ++i) pool.emplace_back([&] { region.work(body); });
    region.work(body);
  }
  region.finish();
}

template <class T, class Map, class Combine>
T reduce_chunks(std::size_t n,
                std::size_t size,
                unsigned threads,
                const control& control,
                T total,
                Map&& map,
                Combine&& combine) {
  if (size == 0) throw argument_error("reduce_chunks: chunk size 0");
  std::vector<T> parts((n + size - 1) / size);
  for_each_chunk(n, size, threads, control, [&](const chunk& c) { parts[c.index] = map(c); });
  for (T& part : parts) total = combine(std::move(total), std::move(part));
  return total;
}

}  // namespace aib

// aib/core/isa.hpp

/// Names the instruction set that this translation unit is compiled for. Code whose machine form
/// depends on it lives in `inline namespace AIB_ISA`, so that units compiled for different machines
/// can be linked together.
#if defined(AIB_PLAIN)
#define AIB_ISA plain
#elif defined(__AVX2__)
#define AIB_ISA avx2
#elif defined(__SSE2__)
#define AIB_ISA sse2
#else
#define AIB_ISA plain
#endif

namespace aib {

inline namespace AIB_ISA {}

#define AIB_ISA_TEXT_(name) #name
#define AIB_ISA_TEXT(name) AIB_ISA_TEXT_(name)

/// "avx2", "sse2" or "plain".
inline constexpr const char* instruction_set = AIB_ISA_TEXT(AIB_ISA);

#undef AIB_ISA_TEXT
#undef AIB_ISA_TEXT_

}  // namespace aib

// aib/core/random.hpp

namespace aib {

/// A well-mixed 64-bit number for a counter: the same for any order of calls.
/// Source: Steele, Lea, Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014
/// (SplitMix64).
[[nodiscard]] constexpr std::uint64_t random_bits(std::uint64_t seed, std::uint64_t counter) {
  std::uint64_t z = seed + (counter + 1) * 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

/// Seeded random numbers, the same on every machine. The distributions are our own because those of
/// the standard library differ between implementations.
///
/// Satisfies std::uniform_random_bit_generator. Source of the generator: xoshiro256++, Blackman and
/// Vigna, 2021.
class random_engine {
 public:
  using result_type = std::uint64_t;

  explicit constexpr random_engine(std::uint64_t seed = 1) {
    for (std::uint64_t i = 0; i < 4; ++i) state_[i] = random_bits(seed, i);
  }

  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return ~result_type{0}; }

  constexpr result_type operator()() {
    const auto rotate = [](std::uint64_t x, int k) { return (x << k) | (x >> (64 - k)); };
    const std::uint64_t result = rotate(state_[0] + state_[3], 23) + state_[0];
    const std::uint64_t t = state_[1] << 17;
    state_[2] ^= state_[0];
    state_[3] ^= state_[1];
    state_[1] ^= state_[2];
    state_[0] ^= state_[3];
    state_[2] ^= t;
    state_[3] = rotate(state_[3], 45);
    return result;
  }

  /// Uniform in [0, 1), 53 random bits.
  constexpr double uniform() { return static_cast<double>((*this)() >> 11) * 0x1p-53; }

  /// Uniform in [low, high).
  constexpr double uniform(double low, double high) { return low + (high - low) * uniform(); }

  /// Uniform integer in [0, n), n > 0.
  constexpr std::uint64_t below(std::uint64_t n) {
    const std::uint64_t uneven = (0 - n) % n;  // 2^64 mod n values would come up once too often
    std::uint64_t bits = (*this)();
    while (bits < uneven) bits = (*this)();
    return bits % n;
  }

  /// Standard normal (Box and Muller, one of the two values used).
  double normal() {
    const double radius = std::sqrt(-2 * std::log(1 - uniform()));
    return radius * std::cos(2 * std::numbers::pi * uniform());
  }

 private:
  std::uint64_t state_[4] = {};
};

}  // namespace aib

// aib/core/simd.hpp

#if !defined(AIB_PLAIN) && defined(__SSE2__)
#include <immintrin.h>
#endif

/// Eight floats and four doubles that are calculated together, for the few loops where that pays.
///
/// The same bits on every machine: each operation is the IEEE one on each lane, nothing is
/// contracted. `min(a, b)` and `max(a, b)` give `b` where the lanes are unordered. `less(a, b)` has
/// bit i set where a < b in lane i. `choose(a, b, x, y)` is x where a < b, else y.
/// `load` and `store` need no alignment.
namespace aib {
inline namespace AIB_ISA {

#if !defined(AIB_PLAIN) && defined(__AVX2__)

struct f32x8 {
  static constexpr std::size_t width = 8;
  __m256 v;

  static f32x8 load(const float* p) { return {_mm256_loadu_ps(p)}; }
  static f32x8 broadcast(float x) { return {_mm256_set1_ps(x)}; }
  void store(float* p) const { _mm256_storeu_ps(p, v); }

  friend f32x8 operator+(f32x8 a, f32x8 b) { return {_mm256_add_ps(a.v, b.v)}; }
  friend f32x8 operator-(f32x8 a, f32x8 b) { return {_mm256_sub_ps(a.v, b.v)}; }
  friend f32x8 operator*(f32x8 a, f32x8 b) { return {_mm256_mul_ps(a.v, b.v)}; }
  friend f32x8 operator/(f32x8 a, f32x8 b) { return {_mm256_div_ps(a.v, b.v)}; }
  friend f32x8 sqrt(f32x8 a) { return {_mm256_sqrt_ps(a.v)}; }
  friend f32x8 min(f32x8 a, f32x8 b) { return {_mm256_min_ps(a.v, b.v)}; }
  friend f32x8 max(f32x8 a, f32x8 b) { return {_mm256_max_ps(a.v, b.v)}; }
  friend unsigned less(f32x8 a, f32x8 b) {
    return static_cast<unsigned>(_mm256_movemask_ps(_mm256_cmp_ps(a.v, b.v, _CMP_LT_OQ)));
  }
  friend f32x8 choose(f32x8 a, f32x8 b, f32x8 x, f32x8 y) {
    return {_mm256_blendv_ps(y.v, x.v, _mm256_cmp_ps(a.v, b.v, _CMP_LT_OQ))};
  }
};

struct f64x4 {
  static constexpr std::size_t width = 4;
  __m256d v;

  static f64x4 load(const double* p) { return {_mm256_loadu_pd(p)}; }
  static f64x4 broadcast(double x) { return {_mm256_set1_pd(x)}; }
  void store(double* p) const { _mm256_storeu_pd(p, v); }

  friend f64x4 operator+(f64x4 a, f64x4 b) { return {_mm256_add_pd(a.v, b.v)}; }
  friend f64x4 operator-(f64x4 a, f64x4 b) { return {_mm256_sub_pd(a.v, b.v)}; }
  friend f64x4 operator*(f64x4 a, f64x4 b) { return {_mm256_mul_pd(a.v, b.v)}; }
  friend f64x4 operator/(f64x4 a, f64x4 b) { return {_mm256_div_pd(a.v, b.v)}; }
  friend f64x4 sqrt(f64x4 a) { return {_mm256_sqrt_pd(a.v)}; }
  friend f64x4 min(f64x4 a, f64x4 b) { return {_mm256_min_pd(a.v, b.v)}; }
  friend f64x4 max(f64x4 a, f64x4 b) { return {_mm256_max_pd(a.v, b.v)}; }
  friend unsigned less(f64x4 a, f64x4 b) {
    return static_cast<unsigned>(_mm256_movemask_pd(_mm256_cmp_pd(a.v, b.v, _CMP_LT_OQ)));
  }
  friend f64x4 choose(f64x4 a, f64x4 b, f64x4 x, f64x4 y) {
    return {_mm256_blendv_pd(y.v, x.v, _mm256_cmp_pd(a.v, b.v, _CMP_LT_OQ))};
  }
};

#elif !defined(AIB_PLAIN) && defined(__SSE2__)

struct f32x8 {
  static constexpr std::size_t width = 8;
  __m128 lo, hi;

  static f32x8 load(const float* p) { return {_mm_loadu_ps(p), _mm_loadu_ps(p + 4)}; }
  static f32x8 broadcast(float x) { return {_mm_set1_ps(x), _mm_set1_ps(x)}; }
  void store(float* p) const {
    _mm_storeu_ps(p, lo);
    _mm_storeu_ps(p + 4, hi);
  }

  friend f32x8 operator+(f32x8 a, f32x8 b) {
    return {_mm_add_ps(a.lo, b.lo), _mm_add_ps(a.hi, b.hi)};
  }
  friend f32x8 operator-(f32x8 a, f32x8 b) {
    return {_mm_sub_ps(a.lo, b.lo), _mm_sub_ps(a.hi, b.hi)};
  }
  friend f32x8 operator*(f32x8 a, f32x8 b) {
    return {_mm_mul_ps(a.lo, b.lo), _mm_mul_ps(a.hi, b.hi)};
  }
  friend f32x8 operator/(f32x8 a, f32x8 b) {
    return {_mm_div_ps(a.lo, b.lo), _mm_div_ps(a.hi, b.hi)};
  }
  friend f32x8 sqrt(f32x8 a) { return {_mm_sqrt_ps(a.lo), _mm_sqrt_ps(a.hi)}; }
  friend f32x8 min(f32x8 a, f32x8 b) { return {_mm_min_ps(a.lo, b.lo), _mm_min_ps(a.hi, b.hi)}; }
  friend f32x8 max(f32x8 a, f32x8 b) { return {_mm_max_ps(a.lo, b.lo), _mm_max_ps(a.hi, b.hi)}; }
  friend unsigned less(f32x8 a, f32x8 b) {
    const int low = _mm_movemask_ps(_mm_cmplt_ps(a.lo, b.lo));
    const int high = _mm_movemask_ps(_mm_cmplt_ps(a.hi, b.hi));
    return static_cast<unsigned>(low | high << 4);
  }
  friend f32x8 choose(f32x8 a, f32x8 b, f32x8 x, f32x8 y) {
    const auto half = [](__m128 mask, __m128 yes, __m128 no) {
      return _mm_or_ps(_mm_and_ps(mask, yes), _mm_andnot_ps(mask, no));
    };
    return {half(_mm_cmplt_ps(a.lo, b.lo), x.lo, y.lo), half(_mm_cmplt_ps(a.hi, b.hi), x.hi, y.hi)};
  }
};

struct f64x4 {
  static constexpr std::size_t width = 4;
  __m128d lo, hi;

  static f64x4 load(const double* p) { return {_mm_loadu_pd(p), _mm_loadu_pd(p + 2)}; }
  static f64x4 broadcast(double x) { return {_mm_set1_pd(x), _mm_set1_pd(x)}; }
  void store(double* p) const {
    _mm_storeu_pd(p, lo);
    _mm_storeu_pd(p + 2, hi);
  }

  friend f64x4 operator+(f64x4 a, f64x4 b) {
    return {_mm_add_pd(a.lo, b.lo), _mm_add_pd(a.hi, b.hi)};
  }
  friend f64x4 operator-(f64x4 a, f64x4 b) {
    return {_mm_sub_pd(a.lo, b.lo), _mm_sub_pd(a.hi, b.hi)};
  }
  friend f64x4 operator*(f64x4 a, f64x4 b) {
    return {_mm_mul_pd(a.lo, b.lo), _mm_mul_pd(a.hi, b.hi)};
  }
  friend f64x4 operator/(f64x4 a, f64x4 b) {
    return {_mm_div_pd(a.lo, b.lo), _mm_div_pd(a.hi, b.hi)};
  }
  friend f64x4 sqrt(f64x4 a) { return {_mm_sqrt_pd(a.lo), _mm_sqrt_pd(a.hi)}; }
  friend f64x4 min(f64x4 a, f64x4 b) { return {_mm_min_pd(a.lo, b.lo), _mm_min_pd(a.hi, b.hi)}; }
  friend f64x4 max(f64x4 a, f64x4 b) { return {_mm_max_pd(a.lo, b.lo), _mm_max_pd(a.hi, b.hi)}; }
  friend unsigned less(f64x4 a, f64x4 b) {
    const int low = _mm_movemask_pd(_mm_cmplt_pd(a.lo, b.lo));
    const int high = _mm_movemask_pd(_mm_cmplt_pd(a.hi, b.hi));
    return static_cast<unsigned>(low | high << 2);
  }
  friend f64x4 choose(f64x4 a, f64x4 b, f64x4 x, f64x4 y) {
    const auto half = [](__m128d mask, __m128d yes, __m128d no) {
      return _mm_or_pd(_mm_and_pd(mask, yes), _mm_andnot_pd(mask, no));
    };
    return {half(_mm_cmplt_pd(a.lo, b.lo), x.lo, y.lo), half(_mm_cmplt_pd(a.hi, b.hi), x.hi, y.hi)};
  }
};

#else

/// Lanes in plain code, for machines without vector code of their own here.
template <class Scalar, std::size_t Width>
struct plain_lanes {
  static constexpr std::size_t width = Width;
  Scalar v[Width];

  static plain_lanes load(const Scalar* p) {
    plain_lanes out;
    std::memcpy(out.v, p, sizeof out.v);
    return out;
  }
  static plain_lanes broadcast(Scalar x) {
    plain_lanes out;
    std::fill_n(out.v, Width, x);
    return out;
  }
  void store(Scalar* p) const { std::memcpy(p, v, sizeof v); }

  template <class Op>
  static plain_lanes each(const plain_lanes& a, const plain_lanes& b, Op op) {
    plain_lanes out;
    for (std::size_t i = 0; i < Width; ++i) out.v[i] = op(a.v[i], b.v[i]);
    return out;
  }
  friend plain_lanes operator+(const plain_lanes& a, const plain_lanes& b) {
    return each(a, b, [](Scalar x, Scalar y) { return x + y; });
  }
  friend plain_lanes operator-(const plain_lanes& a, const plain_lanes& b) {
    return each(a, b, [](Scalar x, Scalar y) { return x - y; });
  }
  friend plain_lanes operator*(const plain_lanes& a, const plain_lanes& b) {
    return each(a, b, [](Scalar x, Scalar y) { return x * y; });
  }
  friend plain_lanes operator/(const plain_lanes& a, const plain_lanes& b) {
    return each(a, b, [](Scalar x, Scalar y) { return x / y; });
  }
  friend plain_lanes sqrt(const plain_lanes& a) {
    return each(a, a, [](Scalar x, Scalar) { return std::sqrt(x); });
  }
  friend plain_lanes min(const plain_lanes& a, const plain_lanes& b) {
    return each(a, b, [](Scalar x, Scalar y) { return x < y ? x : y; });
  }
  friend plain_lanes max(const plain_lanes& a, const plain_lanes& b) {
    return each(a, b, [](Scalar x, Scalar y) { return x > y ? x : y; });
  }
  friend unsigned less(const plain_lanes& a, const plain_lanes& b) {
    unsigned bits = 0;
    for (std::size_t i = 0; i < Width; ++i) bits |= static_cast<unsigned>(a.v[i] < b.v[i]) << i;
    return bits;
  }
  friend plain_lanes choose(const plain_lanes& a,
                            const plain_lanes& b,
                            const plain_lanes& x,
                            const plain_lanes& y) {
    plain_lanes out;
    for (std::size_t i = 0; i < Width; ++i) out.v[i] = a.v[i] < b.v[i] ? x.v[i] : y.v[i];
    return out;
  }
};

using f32x8 = plain_lanes<float, 8>;
using f64x4 = plain_lanes<double, 4>;

#endif

/// The smallest and the largest of the lanes; no lane is NaN.
inline float lowest(f32x8 a) {
  float lane[8];
  a.store(lane);
  return *std::min_element(lane, lane + 8);
}
inline float highest(f32x8 a) {
  float lane[8];
  a.store(lane);
  return *std::max_element(lane, lane + 8);
}

/// Sum of the lanes in a fixed order.
inline double sum(f64x4 a) {
  double lane[4];
  a.store(lane);
  return (lane[0] + lane[1]) + (lane[2] + lane[3]);
}

}  // namespace AIB_ISA
}  // namespace aib

// aib/math/camera.hpp

namespace aib::math {

/// Camera models with COLMAP's numbers, up to COLMAP 4.2.
enum class camera_model : std::int32_t {
  simple_pinhole = 0,
  pinhole = 1,
  simple_radial = 2,
  radial = 3,
  opencv = 4,
  opencv_fisheye = 5,
  full_opencv = 6,
  fov = 7,
  simple_radial_fisheye = 8,
  radial_fisheye = 9,
  thin_prism_fisheye = 10,
  rad_tan_thin_prism_fisheye = 11,
  simple_division = 12,
  division = 13,
  simple_fisheye = 14,
  fisheye = 15,
  eucm = 16,
  equirectangular = 17,
};

/// What COLMAP calls a model and how its parameters begin.
struct camera_model_info {
  std::string_view name;  ///< as in cameras.txt
  std::size_t n_parameters;
  std::size_t n_focal;  ///< 1: f, cx, cy, ...   2: fx, fy, cx, cy, ...   0: no focal length
};

inline constexpr std::array<camera_model_info, 18> camera_models{{
    {"SIMPLE_PINHOLE", 3, 1},
    {"PINHOLE", 4, 2},
    {"SIMPLE_RADIAL", 4, 1},
    {"RADIAL", 5, 1},
    {"OPENCV", 8, 2},
    {"OPENCV_FISHEYE", 8, 2},
    {"FULL_OPENCV", 12, 2},
    {"FOV", 5, 2},
    {"SIMPLE_RADIAL_FISHEYE", 4, 1},
    {"RADIAL_FISHEYE", 5, 1},
    {"THIN_PRISM_FISHEYE", 12, 2},
    {"RAD_TAN_THIN_PRISM_FISHEYE", 16, 2},
    {"SIMPLE_DIVISION", 4, 1},
    {"DIVISION", 5, 2},
    {"SIMPLE_FISHEYE", 3, 1},
    {"FISHEYE", 4, 2},
    {"EUCM", 6, 2},
    {"EQUIRECTANGULAR", 2, 0},
}};

[[nodiscard]] constexpr const camera_model_info& info(camera_model model) {
  return camera_models[static_cast<std::size_t>(model)];
}

/// The model of COLMAP's number or name; nothing where COLMAP (up to 4.2) has none such.
[[nodiscard]] constexpr std::optional<camera_model> find_camera_model(std::int64_t id) {
  if (id < 0 || id >= static_cast<std::int64_t>(camera_models.size())) return std::nullopt;
  return static_cast<camera_model>(id);
}
[[nodiscard]] constexpr std::optional<camera_model> find_camera_model(std::string_view name) {
  for (std::size_t i = 0; i < camera_models.size(); ++i) {
    if (camera_models[i].name == name) return static_cast<camera_model>(i);
  }
  return std::nullopt;
}

/// Intrinsics of a camera. Pixel (0.5, 0.5) is the centre of the top left pixel.
struct camera {
  camera_model model = camera_model::pinhole;
  std::uint64_t width = 0;         ///< pixels
  std::uint64_t height = 0;        ///< pixels
  std::vector<double> parameters;  ///< in COLMAP's order, pixels where they are lengths

  [[nodiscard]] bool has_focal() const { return info(model).n_focal > 0; }

  /// Focal lengths and principal point in pixels. Throw argument_error where the model has none.
  [[nodiscard]] double fx() const;
  [[nodiscard]] double fy() const;
  [[nodiscard]] double cx() const;
  [[nodiscard]] double cy() const;
};

namespace detail {

inline double pinhole_parameter(const camera& c, std::size_t index) {
  if (!c.has_focal())
    throw argument_error(message("camera: ", info(c.model).name, " has no focal length"));
  if (index >= c.parameters.size()) {
    throw argument_error(message("camera: ", info(c.model).name, " expects ",
                                 info(c.model).n_parameters, " parameters, found ",
                                 c.parameters.size()));
  }
  return c.parameters[index];
}

}  // namespace detail

inline double camera::fx() const { return detail::pinhole_parameter(*this, 0); }
inline double camera::fy() const {
  return detail::pinhole_parameter(*this, info(model).n_focal - 1);
}
inline double camera::cx() const { return detail::pinhole_parameter(*this, info(model).n_focal); }
inline double camera::cy() const {
  return detail::pinhole_parameter(*this, info(model).n_focal + 1);
}

/// A camera without distortion.
[[nodiscard]] inline camera pinhole(
    std::uint64_t width, std::uint64_t height, double fx, double fy, double cx, double cy) {
  return {camera_model::pinhole, width, height, {fx, fy, cx, cy}};
}

}  // namespace aib::math

// aib/math/rotation.hpp

namespace aib::math {

inline constexpr double degrees_per_radian = 180 / std::numbers::pi;

/// Angle in degrees of an angle in radians.
[[nodiscard]] constexpr double degrees(double radians) { return radians * degrees_per_radian; }

/// Angle in radians of an angle in degrees.
[[nodiscard]] constexpr double radians(double degrees) { return degrees / degrees_per_radian; }

/// Unit quaternion, Hamilton convention, scalar first. Has no alignment demands, unlike Eigen's.
struct quaternion {
  double w = 1;
  double x = 0;
  double y = 0;
  double z = 0;
};

/// Rotation matrix of a quaternion of any length > 0.
/// Throws argument_error if the quaternion is zero or not finite.
Eigen::Matrix3d rotation_from(const quaternion& q);

/// Unit quaternion of a rotation matrix, w >= 0.
quaternion quaternion_from(const Eigen::Matrix3d& rotation);

/// Rotation by the length of `axis_angle` (radians) about its direction.
Eigen::Matrix3d rotation_from(const Eigen::Vector3d& axis_angle);

/// Axis times angle in radians, angle in [0, pi].
Eigen::Vector3d axis_angle_from(const Eigen::Matrix3d& rotation);

/// Geodesic angle of a rotation in radians, [0, pi]; accurate near 0 and near pi.
double rotation_angle(const Eigen::Matrix3d& rotation);

/// A rotation and how far the matrix that it was made from lay from it.
struct projected_rotation {
  Eigen::Matrix3d rotation;
  double residual;  ///< Frobenius norm of (matrix - rotation)
};

/// The rotation nearest to `matrix` in the Frobenius norm; nothing where the matrix is not finite
/// or where its determinant is not positive.
std::optional<projected_rotation> nearest_rotation(const Eigen::Matrix3d& matrix);

inline Eigen::Matrix3d rotation_from(const quaternion& q) {
  const double norm = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  if (!(norm > 0) || !std::isfinite(norm)) {
    throw argument_error(message("math::rotation_from: quaternion (", q.w, ", ", q.x, ", ", q.y,
                                 ", ", q.z, ") has no direction"));
  }
  return Eigen::Quaterniond(q.w / norm, q.x / norm, q.y / norm, q.z / norm).toRotationMatrix();
}

inline quaternion quaternion_from(const Eigen::Matrix3d& rotation) {
  Eigen::Quaterniond q(rotation);
  q.normalize();
  const double sign = q.w() < 0 ? -1 : 1;
  return {sign * q.w(), sign * q.x(), sign * q.y(), sign * q.z()};
}

inline Eigen::Matrix3d rotation_from(const Eigen::Vector3d& axis_angle) {
  const double angle = axis_angle.norm();
  if (angle == 0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, axis_angle / angle).toRotationMatrix();
}

inline Eigen::Vector3d axis_angle_from(const Eigen::Matrix3d& rotation) {
  const quaternion q = quaternion_from(rotation);
  const Eigen::Vector3d v(q.x, q.y, q.z);
  const double length = v.norm();
  if (length == 0) return Eigen::Vector3d::Zero();
  return v * (2 * std::atan2(length, q.w) / length);
}

inline double rotation_angle(const Eigen::Matrix3d& rotation) {
  const quaternion q = quaternion_from(rotation);
  return 2 * std::atan2(std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z), q.w);
}

inline std::optional<projected_rotation> nearest_rotation(const Eigen::Matrix3d& matrix) {
  if (!matrix.allFinite() || !(matrix.determinant() > 0)) return std::nullopt;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d rotation = svd.matrixU() * svd.matrixV().transpose();
  return projected_rotation{rotation, (matrix - rotation).norm()};
}

}  // namespace aib::math

// aib/math/rigid3.hpp

namespace aib::math {

/// Rigid motion of space: `b_from_a * p_in_a = p_in_b`.
struct rigid3 {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  [[nodiscard]] rigid3 inverse() const {
    return {rotation.transpose(), -(rotation.transpose() * translation)};
  }
  [[nodiscard]] bool is_finite() const { return rotation.allFinite() && translation.allFinite(); }
  [[nodiscard]] Eigen::Matrix4d matrix() const {
    Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
    m.topLeftCorner<3, 3>() = rotation;
    m.topRightCorner<3, 1>() = translation;
    return m;
  }

  /// c_from_a = c_from_b * b_from_a
  friend rigid3 operator*(const rigid3& c_from_b, const rigid3& b_from_a) {
    return {c_from_b.rotation * b_from_a.rotation,
            c_from_b.rotation * b_from_a.translation + c_from_b.translation};
  }
  friend Eigen::Vector3d operator*(const rigid3& b_from_a, const Eigen::Vector3d& p_in_a) {
    return b_from_a.rotation * p_in_a + b_from_a.translation;
  }
};

}  // namespace aib::math

// aib/math/sim3.hpp

namespace aib::math {

/// Similarity of space: `p_in_b = scale * rotation * p_in_a + translation`.
struct sim3 {
  double scale = 1;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  [[nodiscard]] sim3 inverse() const {
    const Eigen::Matrix3d r = rotation.transpose();
    return {1 / scale, r, -(r * translation) / scale};
  }
  [[nodiscard]] Eigen::Matrix4d matrix() const {
    Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
    m.topLeftCorner<3, 3>() = scale * rotation;
    m.topRightCorner<3, 1>() = translation;
    return m;
  }

  friend sim3 operator*(const sim3& c_from_b, const sim3& b_from_a) {
    return {c_from_b.scale * b_from_a.scale, c_from_b.rotation * b_from_a.rotation,
            c_from_b * b_from_a.translation};
  }
  friend Eigen::Vector3d operator*(const sim3& b_from_a, const Eigen::Vector3d& p_in_a) {
    return b_from_a.scale * (b_from_a.rotation * p_in_a) + b_from_a.translation;
  }
  /// Moves a pose: its position as a point, its axes by the rotation alone.
  friend rigid3 operator*(const sim3& b_from_a, const rigid3& a_from_camera) {
    return {b_from_a.rotation * a_from_camera.rotation, b_from_a * a_from_camera.translation};
  }
};

}  // namespace aib::math

// aib/stats/histogram.hpp

namespace aib::stats {

/// Counts of values in equal bins on [low, high), mergeable. Values outside are counted, not
/// dropped.
class histogram {
 public:
  /// Throws argument_error unless low < high and bins > 0.
  histogram(double low, double high, std::size_t bins) : low_(low), high_(high), counts_(bins) {
    if (!(low < high) || bins == 0) {
      throw argument_error(message("stats::histogram: low < high and bins > 0 expected, found ",
                                   low, ", ", high, ", ", bins));
    }
  }

  /// A NaN counts as above.
  void add(double value) {
    if (value < low_) {
      ++below_;
    } else if (value < high_) {
      const double place = (value - low_) / (high_ - low_) * static_cast<double>(counts_.size());
      ++counts_[std::min(static_cast<std::size_t>(place), counts_.size() - 1)];
    } else {
      ++above_;
    }
  }

  /// Throws argument_error if the bins differ.
  histogram& operator+=(const histogram& other) {
    if (other.low_ != low_ || other.high_ != high_ || other.counts_.size() != counts_.size()) {
      throw argument_error("stats::histogram: the bins of merged histograms differ");
    }
    for (std::size_t i = 0; i < counts_.size(); ++i) counts_[i] += other.counts_[i];
    below_ += other.below_;
    above_ += other.above_;
    return *this;
  }

  [[nodiscard]] const std::vector<std::uint64_t>& counts() const { return counts_; }
  [[nodiscard]] std::uint64_t below() const { return below_; }
  [[nodiscard]] std::uint64_t above() const { return above_; }
  [[nodiscard]] std::uint64_t total() const {
    std::uint64_t n = below_ + above_;
    for (const std::uint64_t c : counts_) n += c;
    return n;
  }
  /// Lower edge of bin i; edge(bins) is the upper end.
  [[nodiscard]] double edge(std::size_t i) const {
    return low_ + (high_ - low_) * static_cast<double>(i) / static_cast<double>(counts_.size());
  }

 private:
  double low_, high_;
  std::vector<std::uint64_t> counts_;
  std::uint64_t below_ = 0;
  std::uint64_t above_ = 0;
};

}  // namespace aib::stats

// aib/stats/moments.hpp

namespace aib::stats {

/// Count, mean, variance and range of a stream of numbers, mergeable. Deviations are summed about a
/// running mean, so that a small spread about a large mean is kept. Source: Chan, Golub, LeVeque,
/// "Updating formulae and a pairwise algorithm for computing sample variances", 1979.
class moments {
 public:
  void add(double value) {
    ++count_;
    const double delta = value - mean_;
    mean_ += delta / static_cast<double>(count_);
    squares_ += delta * (value - mean_);
    min_ = std::min(min_, value);
    max_ = std::max(max_, value);
  }

  moments& operator+=(const moments& other) {
    if (other.count_ == 0) return *this;
    if (count_ == 0) return *this = other;
    const auto n = static_cast<double>(count_);
    const auto m = static_cast<double>(other.count_);
    const double delta = other.mean_ - mean_;
    mean_ += delta * (m / (n + m));
    squares_ += other.squares_ + delta * delta * (n * m / (n + m));
    count_ += other.count_;
    min_ = std::min(min_, other.min_);
    max_ = std::max(max_, other.max_);
    return *this;
  }

  [[nodiscard]] std::uint64_t count() const { return count_; }
  [[nodiscard]] double mean() const { return mean_; }  ///< 0 of nothing
  [[nodiscard]] double sum() const { return mean_ * static_cast<double>(count_); }
  [[nodiscard]] double variance() const {  ///< population (ddof 0)
    return count_ ? squares_ / static_cast<double>(count_) : 0;
  }
  [[nodiscard]] double deviation() const { return std::sqrt(variance()); }  ///< population
  [[nodiscard]] double mean_square() const { return variance() + mean_ * mean_; }
  [[nodiscard]] double min() const { return min_; }  ///< +inf of nothing
  [[nodiscard]] double max() const { return max_; }  ///< -inf of nothing

 private:
  std::uint64_t count_ = 0;
  double mean_ = 0;
  double squares_ = 0;
  double min_ = std::numeric_limits<double>::infinity();
  double max_ = -std::numeric_limits<double>::infinity();
};

}  // namespace aib::stats

// aib/stats/quantiles.hpp

namespace aib::stats {

/// What a quantile between two values is.
enum class quantile_rule {
  linear,    ///< interpolated, numpy's default
  lower,     ///< the smaller value (torch.median)
  midpoint,  ///< their mean
};

/// Quantile of unsorted values, q in [0, 1]. Reorders `values`; takes linear time.
/// Throws undefined_error if there is no value, argument_error if q is outside [0, 1].
template <class Scalar>
double quantile_in_place(std::span<Scalar> values,
                         double q,
                         quantile_rule rule = quantile_rule::linear) {
  if (values.empty()) throw undefined_error("stats::quantile: no values");
  if (!(q >= 0 && q <= 1))
    throw argument_error(message("stats::quantile: q in [0, 1] expected, found ", q));
  const double place = q * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(below);
  std::nth_element(values.begin(), nth, values.end());
  const double low = static_cast<double>(*nth);
  const double share = place - static_cast<double>(below);
  if (share == 0 || rule == quantile_rule::lower) return low;
  const double high = static_cast<double>(*std::min_element(nth + 1, values.end()));
  return rule == quantile_rule::midpoint ? (low + high) / 2 : low + (high - low) * share;
}

/// As quantile_in_place, on a copy.
template <class Scalar>
double quantile(std::span<const Scalar> values,
                double q,
                quantile_rule rule = quantile_rule::linear) {
  std::vector<Scalar> copy(values.begin(), values.end());
  return quantile_in_place<Scalar>(copy, q, rule);
}

/// The middle value, or the mean of the two middle values.
template <class Scalar>
double median(std::span<const Scalar> values) {
  return quantile(values, 0.5);
}

}  // namespace aib::stats

// aib/stats/summary.hpp

namespace aib::stats {

/// Statistics of a set of errors, named as evo names them.
struct summary {
  std::uint64_t count;
  double rmse;
  double mean;
  double median;
  double std;  ///< population (ddof 0)
  double min;
  double max;
  double sse;  ///< sum of squares
};

/// Throws undefined_error if there is no value.
inline summary summarize(std::span<const double> errors) {
  if (errors.empty()) throw undefined_error("stats::summarize: no values");
  moments m;
  double sse = 0;
  for (const double e : errors) {
    m.add(e);
    sse += e * e;
  }
  return {.count = m.count(),
          .rmse = std::sqrt(sse / static_cast<double>(m.count())),
          .mean = m.mean(),
          .median = median(errors),
          .std = m.deviation(),
          .min = m.min(),
          .max = m.max(),
          .sse = sse};
}

}  // namespace aib::stats

// aib/raster/view.hpp

namespace aib::raster {

/// A rectangle of pixels that somebody else owns. Row-major, row 0 on top.
template <class T>
struct view {
  T* data = nullptr;
  std::size_t width = 0;
  std::size_t height = 0;
  std::size_t stride = 0;  ///< elements from one row to the next

  [[nodiscard]] T& operator()(std::size_t x, std::size_t y) const { return data[y * stride + x]; }
  [[nodiscard]] std::span<T> row(std::size_t y) const { return {data + y * stride, width}; }
  [[nodiscard]] std::size_t size() const { return width * height; }
  [[nodiscard]] bool empty() const { return size() == 0; }

  operator view<const T>() const requires(!std::is_const_v<T>) {
    return {data, width, height, stride};
  }
};

/// The part of a view that begins at (x, y). The caller keeps it inside.
template <class T>
[[nodiscard]] view<T> part(
    view<T> whole, std::size_t x, std::size_t y, std::size_t width, std::size_t height) {
  return {whole.data + y * whole.stride + x, width, height, whole.stride};
}

}  // namespace aib::raster

// aib/raster/image.hpp

namespace aib::raster {

/// A rectangle of pixels, owned, rows without gaps.
template <class T>
class image {
 public:
  image() = default;
  image(std::size_t width, std::size_t height, T value = {})
      : width_(width), height_(height), pixels_(width * height, value) {}

  [[nodiscard]] std::size_t width() const { return width_; }
  [[nodiscard]] std::size_t height() const { return height_; }
  [[nodiscard]] std::size_t size() const { return pixels_.size(); }
  [[nodiscard]] bool empty() const { return pixels_.empty(); }

  [[nodiscard]] T* data() { return pixels_.data(); }
  [[nodiscard]] const T* data() const { return pixels_.data(); }
  [[nodiscard]] T& operator()(std::size_t x, std::size_t y) { return pixels_[y * width_ + x]; }
  [[nodiscard]] const T& operator()(std::size_t x, std::size_t y) const {
    return pixels_[y * width_ + x];
  }

  [[nodiscard]] auto begin() { return pixels_.begin(); }
  [[nodiscard]] auto end() { return pixels_.end(); }
  [[nodiscard]] auto begin() const { return pixels_.begin(); }
  [[nodiscard]] auto end() const { return pixels_.end(); }

  [[nodiscard]] raster::view<T> view() { return {data(), width_, height_, width_}; }
  [[nodiscard]] raster::view<const T> view() const { return {data(), width_, height_, width_}; }
  operator raster::view<T>() { return view(); }
  operator raster::view<const T>() const { return view(); }

  friend bool operator==(const image&, const image&) = default;

 private:
  std::size_t width_ = 0;
  std::size_t height_ = 0;
  std::vector<T> pixels_;
};

}  // namespace aib::raster

// aib/raster/downsample.hpp

namespace aib::raster {

/// Which source pixel a target pixel takes.
enum class nearest_rule {
  centre,  ///< under the target's centre: ((2i + 1) N) div 2n
  floor,   ///< floor(i N / n), OpenCV's INTER_NEAREST
};

/// Source index of target index i when N samples become n. Integer arithmetic: ties never depend on
/// rounding.
[[nodiscard]] constexpr std::size_t nearest_index(std::size_t i,
                                                  std::size_t N,
                                                  std::size_t n,
                                                  nearest_rule rule) {
  return rule == nearest_rule::centre ? ((2 * i + 1) * N) / (2 * n) : (i * N) / n;
}

/// The image at another size by nearest neighbour: no value is made up, edges and invalid pixels do
/// not bleed. Throws argument_error if a target size is 0 or the image is empty.
template <class T>
[[nodiscard]] image<T> resample_nearest(view<const T> source,
                                        std::size_t width,
                                        std::size_t height,
                                        nearest_rule rule = nearest_rule::centre) {
  if (width == 0 || height == 0 || source.empty()) {
    throw argument_error(message("raster::resample_nearest: cannot make ", width, "x", height,
                                 " of ", source.width, "x", source.height));
  }
  std::vector<std::size_t> column(width);
  for (std::size_t x = 0; x < width; ++x) column[x] = nearest_index(x, source.width, width, rule);
  image<T> target(width, height);
  for (std::size_t y = 0; y < height; ++y) {
    const auto from = source.row(nearest_index(y, source.height, height, rule));
    for (std::size_t x = 0; x < width; ++x) target(x, y) = from[column[x]];
  }
  return target;
}

}  // namespace aib::raster

// aib/depth/depth_map.hpp

namespace aib::depth {

/// Planar depth of a view: distance along the optical axis, in the unit of its source.
/// A pixel is valid where it is finite and > 0; readers turn the background markers of their source
/// into 0.
template <class Scalar>
struct basic_depth_map {
  raster::image<Scalar> values;
  std::vector<std::string> warnings = {};  ///< what the reader removed or doubts, a sentence each
};

using depth_map = basic_depth_map<float>;

template <class Scalar>
[[nodiscard]] bool is_valid(Scalar depth) {
  return std::isfinite(depth) && depth > 0;
}

}  // namespace aib::depth

// aib/pose/trajectory.hpp

namespace aib::pose {

/// Camera poses in the order of their source.
///
/// `names` and `stamps_s` are empty or as long as the poses. Axes of a camera: x right, y down, z
/// forward (OpenCV). A pose that is not finite is not registered.
struct trajectory {
  std::vector<math::rigid3> world_from_camera = {};
  std::vector<std::string> names = {};
  std::vector<double> stamps_s = {};
  std::vector<std::string> warnings = {};  ///< what the reader repaired or doubts, a sentence each

  [[nodiscard]] std::size_t size() const { return world_from_camera.size(); }
  [[nodiscard]] bool empty() const { return world_from_camera.empty(); }
};

/// Throws argument_error unless names and stamps are absent or one a pose.
inline void check(const trajectory& t) {
  const auto fits = [&](std::size_t n) { return n == 0 || n == t.size(); };
  if (fits(t.names.size()) && fits(t.stamps_s.size())) return;
  throw argument_error(message("trajectory: ", t.size(), " poses, ", t.names.size(), " names, ",
                               t.stamps_s.size(), " stamps: one of each a pose expected"));
}

/// The trajectory seen from another frame.
inline trajectory operator*(const math::sim3& b_from_a, trajectory t) {
  for (math::rigid3& pose : t.world_from_camera) pose = b_from_a * pose;
  return t;
}

/// Camera centres.
inline std::vector<Eigen::Vector3d> positions(const trajectory& t) {
  std::vector<Eigen::Vector3d> p;
  p.reserve(t.size());
  for (const math::rigid3& pose : t.world_from_camera) p.push_back(pose.translation);
  return p;
}

/// The poses at `indices`, with their names and stamps.
inline trajectory select(const trajectory& t, const std::vector<std::size_t>& indices) {
  trajectory out;
  for (const std::size_t i : indices) {
    out.world_from_camera.push_back(t.world_from_camera.at(i));
    if (!t.names.empty()) out.names.push_back(t.names.at(i));
    if (!t.stamps_s.empty()) out.stamps_s.push_back(t.stamps_s.at(i));
  }
  return out;
}

}  // namespace aib::pose

// aib/cloud/cloud.hpp

namespace aib::cloud {

using color = std::array<std::uint8_t, 3>;

/// Points with what may come with them. A point lies at `origin + points[i]`: float keeps a tenth
/// of a millimetre within a kilometre, the double origin keeps map coordinates (UTM) exact.
///
/// `normals`, `colors` and `labels` are empty or one a point.
struct cloud {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3f> points = {};
  std::vector<Eigen::Vector3f> normals = {};
  std::vector<color> colors = {};
  std::vector<std::uint32_t> labels = {};
  std::vector<std::string> warnings = {};  ///< what the reader removed or doubts, a sentence each

  [[nodiscard]] std::size_t size() const { return points.size(); }
  [[nodiscard]] bool empty() const { return points.empty(); }
  [[nodiscard]] Eigen::Vector3d position(std::size_t i) const {
    return origin + points[i].cast<double>();
  }
};

/// The origin that readers give a cloud whose box is [low, high]: 0 where floats hold it well
/// (|coordinate| < 1024), else the box centre in whole units.
[[nodiscard]] inline Eigen::Vector3d natural_origin(const Eigen::Vector3d& low,
                                                    const Eigen::Vector3d& high) {
  if (low.cwiseAbs().maxCoeff() < 1024 && high.cwiseAbs().maxCoeff() < 1024)
    return Eigen::Vector3d::Zero();
  return ((low + high) / 2).array().round();
}

}  // namespace aib::cloud

// aib/mesh/mesh.hpp

namespace aib::mesh {

using triangle = std::array<std::uint32_t, 3>;

/// Triangles over shared vertices. A vertex lies at `origin + vertices[i]`, as a point of a cloud
/// does.
///
/// `labels` is empty or one a triangle; `label_names[k]` names label k where the source does.
struct mesh {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3f> vertices = {};
  std::vector<triangle> triangles = {};
  std::vector<std::uint32_t> labels = {};
  std::vector<std::string> label_names = {};
  std::vector<std::string> warnings = {};  ///< what the reader removed or doubts, a sentence each

  [[nodiscard]] bool empty() const { return triangles.empty(); }
  [[nodiscard]] Eigen::Vector3d position(std::size_t vertex) const {
    return origin + vertices[vertex].cast<double>();
  }
};

}  // namespace aib::mesh

// aib/io/axes.hpp

namespace aib::io {

/// The axis that points up in a file. Blender's OBJ and glTF exports are Y up by default, its PLY
/// and STL exports Z up.
enum class up_axis { z, y };

/// "z" or "y". Throws argument_error for another name.
[[nodiscard]] inline up_axis parse_up_axis(std::string_view name) {
  if (name == "z") return up_axis::z;
  if (name == "y") return up_axis::y;
  throw argument_error(message("up: \"z\" or \"y\" expected, found \"", name, "\""));
}

namespace detail {

/// (x, y, z) of a Y-up frame in the Z-up frame: (x, -z, y).
template <class Scalar>
Eigen::Matrix<Scalar, 3, 1> z_up_from_y_up(const Eigen::Matrix<Scalar, 3, 1>& v) {
  return {v[0], -v[2], v[1]};
}

}  // namespace detail

/// Turns a cloud so that z points up, with its normals.
inline void turn_z_up(cloud::cloud& cloud, up_axis from) {
  if (from == up_axis::z) return;
  cloud.origin = detail::z_up_from_y_up(cloud.origin);
  for (Eigen::Vector3f& p : cloud.points) p = detail::z_up_from_y_up(p);
  for (Eigen::Vector3f& n : cloud.normals) n = detail::z_up_from_y_up(n);
}

/// Turns a mesh so that z points up.
inline void turn_z_up(mesh::mesh& mesh, up_axis from) {
  if (from == up_axis::z) return;
  mesh.origin = detail::z_up_from_y_up(mesh.origin);
  for (Eigen::Vector3f& v : mesh.vertices) v = detail::z_up_from_y_up(v);
}

}  // namespace aib::io

// aib/io/file.hpp

namespace aib::io {

/// A regular file opened for reading, of which any part can be read. Throws io_error where the path
/// is not one: missing, a folder, a pipe, not permitted.
class input_file {
 public:
  explicit input_file(std::filesystem::path path);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::uint64_t size() const { return size_; }

  /// Reads exactly `n` bytes at `offset`. Throws format_error where the file ends before.
  void read_at(std::uint64_t offset, void* to, std::size_t n) const;

 private:
  struct closer {
    void operator()(std::FILE* f) const { std::fclose(f); }
  };
  std::filesystem::path path_;
  std::unique_ptr<std::FILE, closer> file_;
  std::uint64_t size_ = 0;
};

/// The whole content of a file.
/// Throws io_error where it cannot be read, format_error where it is larger than `max_bytes`.
std::string read_file(const std::filesystem::path& path,
                      std::uint64_t max_bytes = std::numeric_limits<std::uint64_t>::max());

/// Writes a file under a temporary name beside it; `commit` makes it the file in one step. Where
/// commit is never reached, or fails, the old file stays as it was and the temporary one is
/// removed.
class output_file {
 public:
  explicit output_file(std::filesystem::path path);
  output_file(const output_file&) = delete;
  output_file& operator=(const output_file&) = delete;
  ~output_file();

  /// Throws io_error where the disk is full or the file is not writable.
  void write(const void* data, std::size_t n);
  void write(std::string_view text) { write(text.data(), text.size()); }
  void commit();

 private:
  [[noreturn]] void fail(const char* doing) const;

  std::filesystem::path path_;
  std::filesystem::path temporary_;
  std::FILE* file_ = nullptr;
};

/// Writes a whole file in one step, see output_file.
void write_file(const std::filesystem::path& path, std::string_view content);

inline input_file::input_file(std::filesystem::path path) : path_(std::move(path)) {
  // O_NONBLOCK: opening a pipe without a writer must not hang.
  const int descriptor = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) throw io_error(path_, message("cannot open: ", std::strerror(errno)));
  file_.reset(::fdopen(descriptor, "rb"));
  struct stat status = {};
  if (!file_ || ::fstat(descriptor, &status) != 0)
    throw io_error(path_, message("cannot open: ", std::strerror(errno)));
  if (!S_ISREG(status.st_mode)) {
    throw io_error(path_, S_ISDIR(status.st_mode) ? "a file expected, found a folder"
                                                  : "a regular file expected");
  }
  size_ = static_cast<std::uint64_t>(status.st_size);
}

inline void input_file::read_at(std::uint64_t offset, void* to, std::size_t n) const {
  auto* bytes = static_cast<char*>(to);
  while (n > 0) {
    const ssize_t got = ::pread(::fileno(file_.get()), bytes, n, static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw io_error(path_, message("cannot read: ", std::strerror(errno)));
    if (got == 0)
      throw format_error(path_, at_byte{offset},
                         message("the file ends, ", n, " more bytes expected"));
    bytes += got;
    offset += static_cast<std::uint64_t>(got);
    n -= static_cast<std::size_t>(got);
  }
}

inline std::string read_file(const std::filesystem::path& path, std::uint64_t max_bytes) {
  const input_file file(path);
  if (file.size() > max_bytes) {
    throw format_error(path,
                       message("at most ", max_bytes, " bytes expected, found ", file.size()));
  }
  std::string content(static_cast<std::size_t>(file.size()), '\0');
  file.read_at(0, content.data(), content.size());
  return content;
}

inline output_file::output_file(std::filesystem::path path) : path_(std::move(path)) {
  std::string name = path_.string() + ".XXXXXX";
  const int descriptor = ::mkstemp(name.data());
  if (descriptor < 0) fail("create");
  temporary_ = name;
  const mode_t mask = ::umask(0);
  ::umask(mask);
  ::fchmod(descriptor, 0666 & ~mask);
  file_ = ::fdopen(descriptor, "wb");
  if (!file_) fail("create");
}

inline output_file::~output_file() {
  if (file_) std::fclose(file_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

inline void output_file::fail(const char* doing) const {
  throw io_error(path_, message("cannot ", doing, ": ", std::strerror(errno)));
}

inline void output_file::write(const void* data, std::size_t n) {
  if (n > 0 && std::fwrite(data, 1, n, file_) != n) fail("write");
}

inline void output_file::commit() {
  if (std::fflush(file_) != 0 || ::fsync(::fileno(file_)) != 0) fail("write");
  if (std::fclose(std::exchange(file_, nullptr)) != 0) fail("write");
  if (::rename(temporary_.c_str(), path_.c_str()) != 0) fail("replace");
  temporary_.clear();
}

inline void write_file(const std::filesystem::path& path, std::string_view content) {
  output_file file(path);
  file.write(content);
  file.commit();
}

}  // namespace aib::io

// aib/io/byte_stream.hpp

namespace aib::io {

/// Walks the bytes of a file from front to back in large blocks; only one block is in memory.
/// Every step is checked against the end of the file before memory is asked for, and every error
/// names the byte and what was being read. The file must outlive the stream.
class byte_stream {
 public:
  explicit byte_stream(const input_file& file, std::uint64_t offset = 0)
      : file_(&file), block_offset_(offset) {}

  [[nodiscard]] std::uint64_t offset() const { return block_offset_ + at_; }
  [[nodiscard]] std::uint64_t left() const { return file_->size() - offset(); }

  /// The next `n` bytes, valid until the next call.
  const char* take(std::size_t n, std::string_view what) {
    if (n > filled_ - at_) refill(n, what);
    const char* bytes = block_.data() + at_;
    at_ += n;
    return bytes;
  }

  /// Copies the next `n` bytes to `to`; large pieces go there without a detour.
  void read(void* to, std::size_t n, std::string_view what) {
    const std::size_t ready = std::min(n, filled_ - at_);
    if (ready > 0) std::memcpy(to, take(ready, what), ready);
    if (n == ready) return;
    if (n - ready < block_size) {
      std::memcpy(static_cast<char*>(to) + ready, take(n - ready, what), n - ready);
      return;
    }
    demand(n - ready, what);
    file_->read_at(offset(), static_cast<char*>(to) + ready, n - ready);
    move_to(offset() + (n - ready));
  }

  void skip(std::uint64_t n, std::string_view what) {
    demand(n, what);
    if (n <= filled_ - at_) {
      at_ += static_cast<std::size_t>(n);
    } else {
      move_to(offset() + n);
    }
  }

  /// Throws format_error where fewer than `n` bytes are left.
  void demand(std::uint64_t n, std::string_view what) const {
    if (n > left()) fail(message(what, ": ", n, " bytes expected, ", left(), " left in the file"));
  }

  [[noreturn]] void fail(std::string_view what) const {
    throw format_error(file_->path(), at_byte{offset()}, what);
  }

 private:
  static constexpr std::size_t block_size = std::size_t{1} << 20;

  void move_to(std::uint64_t offset) {
    block_offset_ = offset;
    at_ = filled_ = 0;
  }

  void refill(std::size_t n, std::string_view what) {
    demand(n, what);
    const auto wanted = static_cast<std::size_t>(
        std::min<std::uint64_t>(left(), std::max<std::size_t>(n, block_size)));
    const std::size_t kept = filled_ - at_;
    std::memmove(block_.data(), block_.data() + at_, kept);
    move_to(offset());
    if (block_.size() < wanted) block_.resize(wanted);
    file_->read_at(block_offset_ + kept, block_.data() + kept, wanted - kept);
    filled_ = wanted;
  }

  const input_file* file_;
  std::vector<char> block_;
  std::uint64_t block_offset_;  ///< place of the block in the file
  std::size_t at_ = 0;          ///< next byte in the block
  std::size_t filled_ = 0;      ///< bytes of the block that were read
};

}  // namespace aib::io

// aib/io/bytes.hpp

namespace aib::io {

/// The number whose bytes lie at `from` in the given order.
template <class T>
[[nodiscard]] T load(const void* from, std::endian order = std::endian::little) {
  static_assert(std::is_arithmetic_v<T>);
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), from, sizeof(T));
  if (order != std::endian::native) std::reverse(bytes.begin(), bytes.end());
  return std::bit_cast<T>(bytes);
}

/// Appends the bytes of a number in the given order.
template <class T>
void store(std::string& to, T value, std::endian order = std::endian::little) {
  auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if (order != std::endian::native) std::reverse(bytes.begin(), bytes.end());
  to.append(bytes.data(), bytes.size());
}

/// Reads numbers one after another from bytes in memory. Every read is checked against the end, and
/// every error names the file, the byte and what was being read.
class byte_reader {
 public:
  byte_reader(std::string_view bytes,
              std::filesystem::path path,
              std::endian order = std::endian::little)
      : bytes_(bytes), path_(std::move(path)), order_(order) {}

  [[nodiscard]] std::size_t position() const { return position_; }
  [[nodiscard]] std::size_t left() const { return bytes_.size() - position_; }

  template <class T>
  T read(std::string_view what) {
    return load<T>(take(sizeof(T), what).data(), order_);
  }

  /// The next `n` bytes, in place.
  std::string_view take(std::size_t n, std::string_view what) {
    if (n > left()) fail(message(what, ": ", n, " bytes expected, ", left(), " left in the file"));
    return bytes_.substr(std::exchange(position_, position_ + n), n);
  }

  /// A count of records that take at least `record_bytes` each: refused where the file cannot hold
  /// so many.
  template <class T>
  std::size_t read_count(std::size_t record_bytes, std::string_view what) {
    const std::size_t at = position_;
    const auto count = static_cast<std::uint64_t>(read<T>(what));
    if (count > left() / record_bytes) {
      position_ = at;
      fail(message(what, ": ", count, " records of at least ", record_bytes,
                   " bytes do not fit in the ", bytes_.size() - at - sizeof(T), " bytes left"));
    }
    return static_cast<std::size_t>(count);
  }

  /// Text up to a NUL, which is skipped.
  std::string_view read_name(std::string_view what) {
    const std::size_t end = bytes_.find('\0', position_);
    if (end == std::string_view::npos) fail(message(what, ": no end of the name in the file"));
    const std::string_view name = bytes_.substr(position_, end - position_);
    position_ = end + 1;
    return name;
  }

  [[noreturn]] void fail(std::string_view what) const {
    throw format_error(path_, at_byte{position_}, what);
  }

 private:
  std::string_view bytes_;
  std::filesystem::path path_;
  std::endian order_;
  std::size_t position_ = 0;
};

}  // namespace aib::io

// aib/io/file_kind.hpp

namespace aib::io {

/// Formats of clouds, meshes, depth maps and images that aib knows of; not all of them are read.
enum class file_kind {
  unknown,
  colmap_map,  ///< COLMAP's stereo/depth_maps/*.bin
  dmap,        ///< OpenMVS depth map
  e57,
  exr,
  glb,
  gltf,
  jpeg,
  las,  ///< LAS or LAZ
  npy,
  npz,
  obj,
  pcd,
  pfm,
  ply,
  png,
  stl,
  text_points,  ///< XYZ, CSV, PTS
};

/// The extension in lower case, with its dot.
[[nodiscard]] inline std::string extension_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return extension;
}

namespace detail {

/// "480&270&1&": what COLMAP writes before its dense maps.
inline bool is_colmap_map(std::string_view begin) {
  std::size_t n_fields = 0;
  bool digits = false;
  for (const char c : begin) {
    if (c >= '0' && c <= '9') {
      digits = true;
    } else if (c == '&' && digits) {
      digits = false;
      if (++n_fields == 3) return true;
    } else {
      return false;
    }
  }
  return false;
}

/// A binary STL says in its bytes 80 to 83 how many triangles of 50 bytes follow. Text before them
/// may begin with "solid" all the same, so that only the size tells.
inline bool is_binary_stl(std::string_view begin, std::uint64_t file_size) {
  if (begin.size() < 84) return false;
  std::uint64_t n = 0;
  for (std::size_t i = 4; i-- > 0;) n = (n << 8) | static_cast<unsigned char>(begin[80 + i]);
  return file_size == 84 + 50 * n;
}

inline file_kind kind_of_content(std::string_view begin) {
  using namespace std::string_view_literals;
  constexpr std::array<std::pair<std::string_view, file_kind>, 18> magics{{
      {"ply\n"sv, file_kind::ply},
      {"ply\r"sv, file_kind::ply},
      {"\x76\x2f\x31\x01"sv, file_kind::exr},
      {"\x89PNG\r\n\x1a\n"sv, file_kind::png},
      {"\xff\xd8\xff"sv, file_kind::jpeg},
      {"\x93NUMPY"sv, file_kind::npy},
      {"PK\x03\x04"sv, file_kind::npz},
      {"PK\x05\x06"sv, file_kind::npz},
      {"Pf\n"sv, file_kind::pfm},
      {"Pf\r"sv, file_kind::pfm},
      {"Pf "sv, file_kind::pfm},
      {"PF\n"sv, file_kind::pfm},
      {"glTF"sv, file_kind::glb},
      {"LASF"sv, file_kind::las},
      {"ASTM-E57"sv, file_kind::e57},
      {"# .PCD"sv, file_kind::pcd},
      {"VERSION "sv, file_kind::pcd},
      {"solid"sv, file_kind::stl},
  }};
  for (const auto& [magic, kind] : magics) {
    if (begin.starts_with(magic)) return kind;
  }
  return is_colmap_map(begin) ? file_kind::colmap_map : file_kind::unknown;
}

inline file_kind kind_of_extension(std::string_view extension) {
  constexpr std::array<std::pair<std::string_view, file_kind>, 21> extensions{{
      {".asc", file_kind::text_points},
      {".csv", file_kind::text_points},
      {".dmap", file_kind::dmap},
      {".e57", file_kind::e57},
      {".exr", file_kind::exr},
      {".glb", file_kind::glb},
      {".gltf", file_kind::gltf},
      {".las", file_kind::las},
      {".laz", file_kind::las},
      {".npy", file_kind::npy},
      {".npz", file_kind::npz},
      {".obj", file_kind::obj},
      {".pcd", file_kind::pcd},
      {".pfm", file_kind::pfm},
      {".ply", file_kind::ply},
      {".png", file_kind::png},
      {".pts", file_kind::text_points},
      {".stl", file_kind::stl},
      {".txt", file_kind::text_points},
      {".xyz", file_kind::text_points},
      {".xyzrgb", file_kind::text_points},
  }};
  for (const auto& [known, kind] : extensions) {
    if (known == extension) return kind;
  }
  return file_kind::unknown;
}

}  // namespace detail

/// The format of a file: told from its first bytes, else from its extension.
/// Throws io_error where the file cannot be read.
[[nodiscard]] inline file_kind kind_of(const std::filesystem::path& path) {
  const input_file file(path);
  std::string begin(static_cast<std::size_t>(std::min<std::uint64_t>(file.size(), 128)), '\0');
  file.read_at(0, begin.data(), begin.size());
  if (detail::is_binary_stl(begin, file.size())) return file_kind::stl;
  const file_kind kind = detail::kind_of_content(begin);
  return kind != file_kind::unknown ? kind : detail::kind_of_extension(extension_of(path));
}

}  // namespace aib::io

// aib/io/numbers.hpp

namespace aib::io {

/// Takes the next number off the front of a line, in no locale; nothing, and the line as it was,
/// where the next field is not a number or the line is at its end. Fields are parted by blanks and
/// the characters of `separators`. "nan" and "inf" are numbers; what is too small for double is 0.
[[nodiscard]] inline std::optional<double> take_number(std::string_view& line,
                                                       std::string_view separators = " \t\r\v\f") {
  const auto is_separator = [&](char c) { return separators.find(c) != std::string_view::npos; };
  std::size_t at = 0;
  while (at < line.size() && is_separator(line[at])) ++at;
  if (at + 1 < line.size() && line[at] == '+' && line[at + 1] != '-') ++at;
  double value = 0;
  const char* const last = line.data() + line.size();
  const auto [end, code] = std::from_chars(line.data() + at, last, value);
  if (code == std::errc::invalid_argument || (end != last && !is_separator(*end)))
    return std::nullopt;
  if (code == std::errc::result_out_of_range) {
    const std::string_view text(line.data() + at, static_cast<std::size_t>(end - line.data()) - at);
    if (text.find("e-") == std::string_view::npos && text.find("E-") == std::string_view::npos)
      return std::nullopt;
    value = 0;
  }
  line.remove_prefix(static_cast<std::size_t>(end - line.data()));
  return value;
}

}  // namespace aib::io

// aib/io/text.hpp

namespace aib::io {

/// The text without blanks and line ends at both sides.
[[nodiscard]] inline std::string_view trim(std::string_view text) {
  constexpr std::string_view blank = " \t\r\n\v\f";
  const std::size_t first = text.find_first_not_of(blank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blank) - first + 1);
}

/// The fields of a line: parted by `separator`, or by runs of blanks where it is 0. Fields are
/// trimmed.
inline void split(std::string_view line,
                  std::vector<std::string_view>& fields,
                  char separator = 0) {
  fields.clear();
  if (separator == 0) {
    constexpr std::string_view blank = " \t\r\n\v\f";
    for (std::size_t at = line.find_first_not_of(blank); at != std::string_view::npos;) {
      const std::size_t end = std::min(line.find_first_of(blank, at), line.size());
      fields.push_back(line.substr(at, end - at));
      at = line.find_first_not_of(blank, end);
    }
    return;
  }
  for (;;) {
    const std::size_t end = line.find(separator);
    fields.push_back(trim(line.substr(0, end)));
    if (end == std::string_view::npos) return;
    line.remove_prefix(end + 1);
  }
}

/// The number that the whole text is, in no locale; nothing where it is not one. "nan" and "inf"
/// are numbers, a leading + is allowed.
template <class Number>
[[nodiscard]] std::optional<Number> parse(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  Number value{};
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size() || text.empty()) return std::nullopt;
  if (code != std::errc()) return std::nullopt;
  return value;
}

/// Walks the lines of a text: LF or CRLF, the last with or without an end; a byte order mark is
/// skipped.
class line_reader {
 public:
  line_reader(std::string_view text, std::filesystem::path path)
      : rest_(text), path_(std::move(path)) {
    if (rest_.starts_with("\xEF\xBB\xBF")) rest_.remove_prefix(3);
  }

  /// Moves to the next line; false after the last.
  bool next() {
    if (rest_.empty()) return false;
    const std::size_t end = rest_.find('\n');
    line_ = rest_.substr(0, end);
    if (line_.ends_with('\r')) line_.remove_suffix(1);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    ++number_;
    return true;
  }

  /// Moves to the next line that is neither blank nor a comment ('#').
  bool next_content() {
    while (next()) {
      const std::string_view content = trim(line_);
      if (!content.empty() && content.front() != '#') return true;
    }
    return false;
  }

  [[nodiscard]] std::string_view line() const { return line_; }
  [[nodiscard]] std::size_t number() const { return number_; }
  [[noreturn]] void fail(std::string_view what) const {
    throw format_error(path_, at_line{number_}, what);
  }

 private:
  std::string_view rest_;
  std::string_view line_;
  std::size_t number_ = 0;
  std::filesystem::path path_;
};

}  // namespace aib::io

// aib/io/ply_header.hpp

namespace aib::io {

enum class ply_format { ascii, binary_little_endian, binary_big_endian };

enum class ply_type : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// Calls `body(std::type_identity<T>{})` with the C++ type.
template <class Body>
decltype(auto) with_type(ply_type type, Body&& body) {
  switch (type) {
    case ply_type::int8:
      return body(std::type_identity<std::int8_t>{});
    case ply_type::uint8:
      return body(std::type_identity<std::uint8_t>{});
    case ply_type::int16:
      return body(std::type_identity<std::int16_t>{});
    case ply_type::uint16:
      return body(std::type_identity<std::uint16_t>{});
    case ply_type::int32:
      return body(std::type_identity<std::int32_t>{});
    case ply_type::uint32:
      return body(std::type_identity<std::uint32_t>{});
    case ply_type::float32:
      return body(std::type_identity<float>{});
    default:
      return body(std::type_identity<double>{});
  }
}

[[nodiscard]] constexpr std::size_t size_of(ply_type type) {
  constexpr std::array<std::size_t, 8> sizes{1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[static_cast<std::size_t>(type)];
}

/// A column of an element: one number a row, or a list of them.
struct ply_property {
  std::string name;
  ply_type type;
  std::optional<ply_type> list_count = {};  ///< type of the count, where the property is a list
};

/// A table of the file: rows of equal properties.
struct ply_element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<ply_property> properties = {};

  [[nodiscard]] bool has_list() const {
    return std::any_of(properties.begin(), properties.end(),
                       [](const ply_property& p) { return p.list_count.has_value(); });
  }

  /// Bytes of a binary row; where the element has lists, those of a row of empty lists.
  [[nodiscard]] std::size_t row_bytes() const {
    std::size_t n = 0;
    for (const ply_property& p : properties) n += size_of(p.list_count.value_or(p.type));
    return n;
  }

  /// Index of a property, nothing where there is none of this name.
  [[nodiscard]] std::optional<std::size_t> find(std::string_view property) const {
    for (std::size_t i = 0; i < properties.size(); ++i) {
      if (properties[i].name == property) return i;
    }
    return std::nullopt;
  }
};

/// What stands before the data of a PLY file.
struct ply_header {
  ply_format format = ply_format::ascii;
  std::vector<ply_element> elements = {};
  std::vector<std::string> comments = {};
  std::uint64_t data_offset = 0;
  std::size_t lines = 0;

  [[nodiscard]] const ply_element* find(std::string_view element) const {
    for (const ply_element& e : elements) {
      if (e.name == element) return &e;
    }
    return nullptr;
  }
};

/// Reads the header of a PLY file; LF and CRLF line ends. Throws format_error where it is damaged,
/// longer than a megabyte, or announces more rows than the file can hold.
ply_header read_ply_header(const input_file& file);

namespace detail {

inline std::optional<ply_type> find_ply_type(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, ply_type>, 16> types{{
      {"char", ply_type::int8},
      {"int8", ply_type::int8},
      {"uchar", ply_type::uint8},
      {"uint8", ply_type::uint8},
      {"short", ply_type::int16},
      {"int16", ply_type::int16},
      {"ushort", ply_type::uint16},
      {"uint16", ply_type::uint16},
      {"int", ply_type::int32},
      {"int32", ply_type::int32},
      {"uint", ply_type::uint32},
      {"uint32", ply_type::uint32},
      {"float", ply_type::float32},
      {"float32", ply_type::float32},
      {"double", ply_type::float64},
      {"float64", ply_type::float64},
  }};
  for (const auto& [known, type] : types) {
    if (known == name) return type;
  }
  return std::nullopt;
}

/// The lines of the header one by one.
class ply_header_parser {
 public:
  explicit ply_header_parser(const input_file& file) : file_(file) { load_text(); }

  ply_header parse() {
    if (file_.size() == 0) throw format_error(file_.path(), "ply: the file is empty");
    if (!next() || trim(line_) != "ply") fail("ply: the first line must be \"ply\"");
    bool has_format = false;
    while (next()) {
      split(line_, fields_);
      if (fields_.empty() || fields_[0] == "obj_info") continue;
      if (fields_[0] == "comment") {
        header_.comments.emplace_back(trim(line_.substr(line_.find("comment") + 7)));
      } else if (fields_[0] == "format") {
        parse_format();
        has_format = true;
      } else if (fields_[0] == "element") {
        parse_element();
      } else if (fields_[0] == "property") {
        parse_property();
      } else if (fields_[0] == "end_header") {
        if (!has_format) fail("ply: no format line in the header");
        header_.data_offset = at_;
        header_.lines = number_;
        check_sizes();
        return std::move(header_);
      } else {
        fail(message("ply: format, element, property, comment or end_header expected, found \"",
                     fields_[0].substr(0, 40), "\""));
      }
    }
    fail(message("ply: no end_header in the first ", text_.size(), " bytes"));
  }

 private:
  static constexpr std::size_t max_header = std::size_t{1} << 20;

  void load_text() {
    text_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(file_.size(), 4096)));
    file_.read_at(0, text_.data(), text_.size());
    while (text_.find("end_header") == std::string::npos && text_.size() < max_header &&
           text_.size() < file_.size() && text_.starts_with("ply")) {
      const std::size_t read = text_.size();
      text_.resize(static_cast<std::size_t>(
          std::min<std::uint64_t>({file_.size(), max_header, std::uint64_t{4} * read})));
      file_.read_at(read, text_.data() + read, text_.size() - read);
    }
  }

  bool next() {
    const std::size_t end = text_.find('\n', at_);
    if (end == std::string::npos) return false;
    line_ = std::string_view(text_).substr(at_, end - at_);
    if (line_.ends_with('\r')) line_.remove_suffix(1);
    at_ = end + 1;
    ++number_;
    return true;
  }

  void parse_format() {
    const std::string_view name = fields_.size() > 1 ? fields_[1] : "";
    if (name == "ascii") {
      header_.format = ply_format::ascii;
    } else if (name == "binary_little_endian") {
      header_.format = ply_format::binary_little_endian;
    } else if (name == "binary_big_endian") {
      header_.format = ply_format::binary_big_endian;
    } else {
      fail(
          message("ply: format ascii, binary_little_endian or binary_big_endian expected, found \"",
                  name.substr(0, 40), "\""));
    }
  }

  void parse_element() {
    if (fields_.size() != 3) fail("ply: expected \"element NAME COUNT\"");
    const auto count = io::parse<std::uint64_t>(fields_[2]);
    if (!count) {
      fail(message("ply: count of element ", fields_[1].substr(0, 40), " expected, found \"",
                   fields_[2].substr(0, 40), "\""));
    }
    header_.elements.push_back({std::string(fields_[1]), *count});
  }

  void parse_property() {
    if (header_.elements.empty()) fail("ply: property before the first element");
    ply_property property;
    if (fields_.size() == 5 && fields_[1] == "list") {
      property = {std::string(fields_[4]), type_named(fields_[3]), type_named(fields_[2])};
      if (*property.list_count >= ply_type::float32)
        fail("ply: the count of a list must be an integer type");
    } else if (fields_.size() == 3) {
      property = {std::string(fields_[2]), type_named(fields_[1])};
    } else {
      fail("ply: expected \"property TYPE NAME\" or \"property list TYPE TYPE NAME\"");
    }
    header_.elements.back().properties.push_back(std::move(property));
  }

  ply_type type_named(std::string_view name) const {
    if (const auto type = find_ply_type(name)) return *type;
    fail(message("ply: unknown type \"", name.substr(0, 40), "\""));
  }

  void check_sizes() const {
    const bool ascii = header_.format == ply_format::ascii;
    // An ascii number takes a digit and a blank; the last line may lack its end.
    std::uint64_t left = file_.size() - header_.data_offset + (ascii ? 1 : 0);
    for (const ply_element& e : header_.elements) {
      const std::uint64_t row = ascii ? 2 * e.properties.size() : e.row_bytes();
      if (row == 0) continue;
      if (e.count > left / row) {
        throw format_error(
            file_.path(), message("ply: element ", e.name, ": ", e.count, " rows of at least ", row,
                                  " bytes expected, the file has ", left, " bytes for them"));
      }
      left -= e.count * row;
    }
  }

  [[noreturn]] void fail(std::string_view what) const {
    throw format_error(file_.path(), at_line{number_}, what);
  }

  const input_file& file_;
  std::string text_;
  std::size_t at_ = 0;
  std::string_view line_;
  std::size_t number_ = 0;
  std::vector<std::string_view> fields_;
  ply_header header_;
};

}  // namespace detail

inline ply_header read_ply_header(const input_file& file) {
  return detail::ply_header_parser(file).parse();
}

}  // namespace aib::io

// aib/io/ply_data.hpp

namespace aib::io::detail {

/// A row of an element as numbers.
struct ply_row {
  std::vector<double> values;  ///< one a property; of a list its length
  std::vector<double> list;    ///< items of the list that was asked for
};

inline constexpr std::size_t no_list = ~std::size_t{0};

/// The data of a PLY file, element by element in file order.
class ply_data {
 public:
  virtual ~ply_data() = default;
  virtual void read_row(const ply_element& element, std::size_t wanted_list, ply_row& row) = 0;
  virtual void skip(const ply_element& element) = 0;
  /// The bytes that come next, where the data are binary.
  virtual byte_stream* stream() { return nullptr; }
  /// An error at the place where the data were last read.
  [[nodiscard]] virtual format_error error(std::string_view what) const = 0;
};

class ply_binary_data : public ply_data {
 public:
  ply_binary_data(const input_file& file, std::uint64_t offset, std::endian order)
      : path_(file.path()), stream_(file, offset), order_(order) {}

  void read_row(const ply_element& element, std::size_t wanted_list, ply_row& row) override {
    row.values.clear();
    row.list.clear();
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      const ply_property& p = element.properties[i];
      row.values.push_back(take(p.list_count.value_or(p.type), p));
      if (p.list_count) read_list(p, i == wanted_list, row);
    }
  }

  void skip(const ply_element& element) override {
    if (!element.has_list()) {
      stream_.skip(element.count * element.row_bytes(), element.name);
      return;
    }
    ply_row row;
    for (std::uint64_t i = 0; i < element.count; ++i) read_row(element, no_list, row);
  }

  byte_stream* stream() override { return &stream_; }
  [[nodiscard]] format_error error(std::string_view what) const override {
    return format_error(path_, at_byte{stream_.offset()}, what);
  }

 private:
  double number(ply_type type, const char* from) const {
    return with_type(type, [&]<class T>(std::type_identity<T>) {
      return static_cast<double>(load<T>(from, order_));
    });
  }

  double take(ply_type type, const ply_property& p) {
    return number(type, stream_.take(size_of(type), p.name));
  }

  void read_list(const ply_property& p, bool wanted, ply_row& row) {
    const double count = row.values.back();
    if (count < 0) throw error(message("ply: list ", p.name, " of ", count, " items"));
    const auto n = static_cast<std::size_t>(count);
    const char* items = stream_.take(n * size_of(p.type), p.name);
    if (!wanted) return;
    for (std::size_t k = 0; k < n; ++k)
      row.list.push_back(number(p.type, items + k * size_of(p.type)));
  }

  std::filesystem::path path_;
  byte_stream stream_;
  std::endian order_;
};

/// A row is a line; blank lines between rows are passed over.
class ply_ascii_data : public ply_data {
 public:
  ply_ascii_data(const input_file& file, std::size_t header_lines)
      : path_(file.path()), text_(read_file(path_)), lines_(text_, path_) {
    for (std::size_t i = 0; i < header_lines; ++i) lines_.next();
  }

  void read_row(const ply_element& element, std::size_t wanted_list, ply_row& row) override {
    row.values.clear();
    row.list.clear();
    do {
      if (!lines_.next()) throw error(message("ply: the file ends within element ", element.name));
      rest_ = trim(lines_.line());
    } while (rest_.empty());
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      const ply_property& p = element.properties[i];
      row.values.push_back(take(p));
      if (p.list_count) read_list(p, i == wanted_list, row);
    }
    if (rest_.empty()) return;
    throw error(message("ply: ", element.name, " has ", element.properties.size(),
                        " properties, the line goes on with \"", trim(rest_).substr(0, 40), "\""));
  }

  void skip(const ply_element& element) override {
    if (element.properties.empty()) return;
    ply_row row;
    for (std::uint64_t i = 0; i < element.count; ++i) read_row(element, no_list, row);
  }

  [[nodiscard]] format_error error(std::string_view what) const override {
    return format_error(path_, at_line{lines_.number()}, what);
  }

 private:
  double take(const ply_property& p) {
    if (const auto value = take_number(rest_)) return *value;
    if (rest_.empty()) throw error(message("ply: the line ends where ", p.name, " is expected"));
    throw error(message("ply: a number expected for ", p.name, ", found \"",
                        trim(rest_).substr(0, 40), "\""));
  }

  void read_list(const ply_property& p, bool wanted, ply_row& row) {
    const double count = row.values.back();
    if (!(count >= 0)) throw error(message("ply: list ", p.name, " of ", count, " items"));
    for (double k = 0; k < count; ++k) {
      const double item = take(p);
      if (wanted) row.list.push_back(item);
    }
  }

  std::filesystem::path path_;
  std::string text_;
  line_reader lines_;
  std::string_view rest_;
};

inline std::endian byte_order(ply_format format) {
  return format == ply_format::binary_big_endian ? std::endian::big : std::endian::little;
}

inline std::unique_ptr<ply_data> open_ply_data(const input_file& file, const ply_header& header) {
  if (header.format == ply_format::ascii)
    return std::make_unique<ply_ascii_data>(file, header.lines);
  return std::make_unique<ply_binary_data>(file, header.data_offset, byte_order(header.format));
}

}  // namespace aib::io::detail

// aib/io/positions.hpp

namespace aib::io {

/// Positions as clouds and meshes keep them: `origin + points[i]`.
struct float_positions {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3f> points = {};
};

/// Double positions as floats from the natural origin of their finite ones.
[[nodiscard]] inline float_positions to_floats(std::span<const Eigen::Vector3d> positions) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  Eigen::Vector3d low = Eigen::Vector3d::Constant(infinite);
  Eigen::Vector3d high = -low;
  for (const Eigen::Vector3d& p : positions) {
    if (!p.allFinite()) continue;
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  float_positions result;
  if (low[0] <= high[0]) result.origin = cloud::natural_origin(low, high);
  result.points.reserve(positions.size());
  for (const Eigen::Vector3d& p : positions)
    result.points.emplace_back((p - result.origin).cast<float>());
  return result;
}

/// How many points have a coordinate that is NaN or infinite.
[[nodiscard]] inline std::size_t count_non_finite(std::span<const Eigen::Vector3f> points) {
  // All exponent bits set: looked for in one flat loop without branches, since most files have
  // none.
  const float* flat = points.empty() ? nullptr : points.front().data();
  std::uint32_t any = 0;
  for (std::size_t i = 0; i < 3 * points.size(); ++i)
    any |= (std::bit_cast<std::uint32_t>(flat[i]) & 0x7f800000u) == 0x7f800000u ? 1u : 0u;
  if (any == 0) return 0;
  return static_cast<std::size_t>(std::count_if(
      points.begin(), points.end(), [](const Eigen::Vector3f& p) { return !p.allFinite(); }));
}

/// The sentence that a reader leaves about non-finite points; nothing where all are finite.
[[nodiscard]] inline std::optional<std::string> non_finite_warning(
    std::span<const Eigen::Vector3f> points, std::string_view name) {
  const std::size_t n = count_non_finite(points);
  if (n == 0) return std::nullopt;
  return message(n, " of ", points.size(), " ", name, " are not finite");
}

}  // namespace aib::io

// aib/io/ply.hpp

namespace aib::io {

/// What to do with a PLY of 3D Gaussian splats, whose centres are not points of a surface.
enum class splat_rule { refuse, centres };

/// Reads the vertices of a PLY file: ascii and binary of both byte orders, properties in any order,
/// lists anywhere, other elements before or behind. Faces are passed over.
///
/// x y z       required; other types than binary float are kept as double, from a natural origin
/// nx ny nz    normals; all zero (as pi3 writes them) means none
/// red green blue   8 or 16 bits, or float 0..1
/// label       unsigned label of a point
///
/// Non-finite points stay, their number is in the warnings.
/// Throws format_error where the file is damaged or holds Gaussian splats that were not asked for.
/// Source of the format: Turk, "The PLY polygon file format", 1994.
cloud::cloud read_ply_cloud(const std::filesystem::path& path,
                            splat_rule splats = splat_rule::refuse);

/// Reads vertices and faces of a PLY file. Polygons become fans around their first vertex; a
/// polygon of less than three vertices is dropped with a warning.
///
/// vertex_indices or vertex_index   list of the face
/// label       unsigned label of a face; a comment "labels: 0=ground 1=tower" names them
///
/// Throws format_error where the file is damaged, has no faces, or an index has no vertex.
mesh::mesh read_ply_mesh(const std::filesystem::path& path);

namespace detail {

/// A colour channel as a byte: T is the type in the file, float channels are 0..1.
template <class T>
std::uint8_t color_byte(double value) {
  if (std::is_floating_point_v<T>) value *= 255;
  if (std::is_same_v<T, std::uint16_t>) value /= 257;
  return value > 0 ? static_cast<std::uint8_t>(std::min(value, 255.0) + 0.5) : std::uint8_t{0};
}

inline std::uint32_t label_of(double value) {
  return value >= 0 && value < 4294967296.0 ? static_cast<std::uint32_t>(value) : 0;
}

/// The scalar property of a name.
inline std::optional<std::size_t> find_scalar(const ply_element& element, std::string_view name) {
  const auto index = element.find(name);
  return index && !element.properties[*index].list_count ? index : std::nullopt;
}

using ply_triple = std::array<std::size_t, 3>;

inline std::optional<ply_triple> find_scalars(const ply_element& element,
                                              std::array<std::string_view, 3> names) {
  ply_triple columns{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto index = find_scalar(element, names[k]);
    if (!index) return std::nullopt;
    columns[k] = *index;
  }
  return columns;
}

/// The vertex element on its way to a cloud.
class ply_vertices {
 public:
  ply_vertices(const ply_element& element,
               const ply_header& header,
               const std::filesystem::path& path)
      : element_(element),
        order_(byte_order(header.format)),
        normal_(find_scalars(element, {"nx", "ny", "nz"})),
        color_(find_scalars(element, {"red", "green", "blue"})),
        label_(find_scalar(element, "label")) {
    const auto position = find_scalars(element, {"x", "y", "z"});
    if (!position) throw format_error(path, "ply: element vertex has no properties x, y and z");
    position_ = *position;
    is_float_ = header.format != ply_format::ascii &&
                std::all_of(position_.begin(), position_.end(),
                            [&](std::size_t i) { return type(i) == ply_type::float32; });
  }

  cloud::cloud read(ply_data& data) {
    const auto n = static_cast<std::size_t>(element_.count);
    is_float_ ? result_.points.resize(n) : doubles_.resize(n);
    if (normal_) result_.normals.resize(n);
    if (color_) result_.colors.resize(n);
    if (label_) result_.labels.resize(n);
    if (data.stream() && !element_.has_list()) {
      read_columns(*data.stream());
    } else {
      read_rows(data);
    }
    return finish();
  }

 private:
  /// Binary rows of equal length, in one piece.
  struct block {
    const char* bytes;
    std::size_t first;  ///< number of its first row
    std::size_t n;
  };

  ply_type type(std::size_t column) const { return element_.properties[column].type; }

  bool is_packed() const {
    return is_float_ && order_ == std::endian::native && position_ == ply_triple{0, 1, 2} &&
           element_.properties.size() == 3;
  }

  void read_columns(byte_stream& stream) {
    const std::size_t stride = element_.row_bytes();
    if (is_packed()) {
      stream.read(result_.points.data(), result_.points.size() * stride, element_.name);
      return;
    }
    const std::size_t rows = std::max<std::size_t>(1, (std::size_t{1} << 18) / stride);
    for (std::size_t first = 0; first < element_.count; first += rows) {
      const std::size_t n = std::min<std::size_t>(rows, element_.count - first);
      const block rows_here{stream.take(n * stride, element_.name), first, n};
      for (std::size_t k = 0; k < 3; ++k) set_columns(rows_here, k);
      if (label_) set_labels(rows_here);
    }
  }

  /// Calls `set(i, number)` for each row i of a block with its number in a column.
  template <class Set>
  void for_each_number(const block& rows, std::size_t column, Set set) const {
    const char* from = rows.bytes;
    for (std::size_t i = 0; i < column; ++i) from += size_of(type(i));
    const std::size_t stride = element_.row_bytes();
    with_type(type(column), [&]<class T>(std::type_identity<T>) {
      if (order_ == std::endian::native) {
        for (std::size_t i = 0; i < rows.n; ++i)
          set(rows.first + i, load<T>(from + i * stride, std::endian::native));
      } else {
        for (std::size_t i = 0; i < rows.n; ++i)
          set(rows.first + i, load<T>(from + i * stride, order_));
      }
    });
  }

  /// Coordinate k of positions and normals, channel k of colours.
  void set_columns(const block& rows, std::size_t k) {
    const auto axis = static_cast<int>(k);
    if (is_float_) {
      for_each_number(rows, position_[k], [&](std::size_t i, auto value) {
        result_.points[i][axis] = static_cast<float>(value);
      });
    } else {
      for_each_number(rows, position_[k], [&](std::size_t i, auto value) {
        doubles_[i][axis] = static_cast<double>(value);
      });
    }
    if (normal_) {
      for_each_number(rows, (*normal_)[k], [&](std::size_t i, auto value) {
        result_.normals[i][axis] = static_cast<float>(value);
      });
    }
    if (color_) {
      for_each_number(rows, (*color_)[k], [&](std::size_t i, auto value) {
        if constexpr (std::is_same_v<decltype(value), std::uint8_t>) {
          result_.colors[i][k] = value;
        } else {
          result_.colors[i][k] = color_byte<decltype(value)>(static_cast<double>(value));
        }
      });
    }
  }

  void set_labels(const block& rows) {
    for_each_number(rows, *label_, [&](std::size_t i, auto value) {
      result_.labels[i] = label_of(static_cast<double>(value));
    });
  }

  void read_rows(ply_data& data) {
    ply_row row;
    for (std::size_t i = 0; i < element_.count; ++i) {
      data.read_row(element_, no_list, row);
      for (std::size_t k = 0; k < 3; ++k) set_row(row, i, k);
      if (label_) result_.labels[i] = label_of(row.values[*label_]);
    }
  }

  void set_row(const ply_row& row, std::size_t i, std::size_t k) {
    const auto axis = static_cast<int>(k);
    const double coordinate = row.values[position_[k]];
    if (is_float_) {
      result_.points[i][axis] = static_cast<float>(coordinate);
    } else {
      doubles_[i][axis] = coordinate;
    }
    if (normal_) result_.normals[i][axis] = static_cast<float>(row.values[(*normal_)[k]]);
    if (color_) {
      const std::size_t column = (*color_)[k];
      result_.colors[i][k] = with_type(type(column), [&]<class T>(std::type_identity<T>) {
        return color_byte<T>(row.values[column]);
      });
    }
  }

  cloud::cloud finish() {
    if (!is_float_) {
      auto floats = to_floats(doubles_);
      result_.origin = floats.origin;
      result_.points = std::move(floats.points);
    }
    const auto is_zero = [](const Eigen::Vector3f& n) { return n.isZero(0); };
    if (std::all_of(result_.normals.begin(), result_.normals.end(), is_zero))
      result_.normals.clear();
    if (auto warning = non_finite_warning(result_.points, "points"))
      result_.warnings.push_back(std::move(*warning));
    return std::move(result_);
  }

  const ply_element& element_;
  std::endian order_;
  ply_triple position_{};
  std::optional<ply_triple> normal_;
  std::optional<ply_triple> color_;
  std::optional<std::size_t> label_;
  bool is_float_ = false;  ///< the file holds float: nothing to gain from double
  std::vector<Eigen::Vector3d> doubles_;
  cloud::cloud result_;
};

/// The face element on its way to triangles.
class ply_faces {
 public:
  ply_faces(const ply_element& element, std::uint64_t n_vertices, const std::filesystem::path& path)
      : element_(element), n_vertices_(n_vertices), label_(find_scalar(element, "label")) {
    auto list = element.find("vertex_indices");
    if (!list) list = element.find("vertex_index");
    if (!list || !element.properties[*list].list_count)
      throw format_error(path, "ply: element face has no list vertex_indices");
    list_ = *list;
  }

  void read(ply_data& data, mesh::mesh& result) const {
    result.triangles.reserve(static_cast<std::size_t>(element_.count));
    ply_row row;
    std::size_t n_dropped = 0;
    for (std::uint64_t i = 0; i < element_.count; ++i) {
      data.read_row(element_, list_, row);
      check(data, i, row.list);
      n_dropped += row.list.size() < 3 ? 1u : 0u;
      for (std::size_t k = 2; k < row.list.size(); ++k) {
        result.triangles.push_back({index(row, 0), index(row, k - 1), index(row, k)});
        if (label_) result.labels.push_back(label_of(row.values[*label_]));
      }
    }
    if (n_dropped > 0)
      result.warnings.push_back(message(n_dropped, " faces of less than 3 vertices were dropped"));
    if (result.triangles.empty()) result.warnings.push_back("no triangles");
  }

 private:
  static std::uint32_t index(const ply_row& row, std::size_t k) {
    return static_cast<std::uint32_t>(row.list[k]);
  }

  void check(const ply_data& data, std::uint64_t face, const std::vector<double>& list) const {
    for (const double v : list) {
      if (v >= 0 && v < static_cast<double>(n_vertices_) && v == std::floor(v)) continue;
      throw data.error(message("ply: face ", face, ": one of ", n_vertices_,
                               " vertices expected, found index ", v));
    }
  }

  const ply_element& element_;
  std::uint64_t n_vertices_;
  std::size_t list_ = 0;
  std::optional<std::size_t> label_;
};

/// Names of the comment "labels: 0=ground 1=tower".
inline std::vector<std::string> ply_label_names(const ply_header& header) {
  constexpr std::size_t max_labels = 65536;
  std::vector<std::string> names;
  std::vector<std::string_view> fields;
  for (const std::string& comment : header.comments) {
    if (!comment.starts_with("labels:")) continue;
    split(std::string_view(comment).substr(7), fields);
    for (const std::string_view field : fields) {
      const std::size_t equals = field.find('=');
      const auto label = parse<std::size_t>(field.substr(0, equals));
      if (equals == std::string_view::npos || !label || *label >= max_labels) continue;
      if (names.size() <= *label) names.resize(*label + 1);
      names[*label] = field.substr(equals + 1);
    }
  }
  return names;
}

inline const ply_element& ply_vertex_element(const ply_header& header,
                                             const std::filesystem::path& path) {
  if (const ply_element* vertex = header.find("vertex")) return *vertex;
  throw format_error(path, "ply: no element vertex");
}

}  // namespace detail

inline cloud::cloud read_ply_cloud(const std::filesystem::path& path, splat_rule splats) {
  const input_file file(path);
  const ply_header header = read_ply_header(file);
  const ply_element& vertex = detail::ply_vertex_element(header, path);
  const bool is_splats = vertex.find("f_dc_0") && vertex.find("opacity");
  if (is_splats && splats == splat_rule::refuse) {
    throw format_error(path,
                       "ply: 3D Gaussian splats (f_dc_0, opacity), whose centres are not points of "
                       "a surface; ask for splats = \"centres\" to read them all the same");
  }
  const auto data = detail::open_ply_data(file, header);
  cloud::cloud result;
  for (const ply_element& element : header.elements) {
    if (&element == &vertex) {
      result = detail::ply_vertices(vertex, header, path).read(*data);
    } else {
      data->skip(element);
    }
  }
  if (result.empty()) result.warnings.push_back("no points");
  if (is_splats) result.warnings.push_back("centres of 3D Gaussian splats");
  return result;
}

inline mesh::mesh read_ply_mesh(const std::filesystem::path& path) {
  const input_file file(path);
  const ply_header header = read_ply_header(file);
  const ply_element& vertex = detail::ply_vertex_element(header, path);
  const ply_element* face = header.find("face");
  if (!face) throw format_error(path, "ply: a mesh expected, found a cloud (no element face)");
  const detail::ply_faces faces(*face, vertex.count, path);
  mesh::mesh result;
  result.label_names = detail::ply_label_names(header);
  const auto data = detail::open_ply_data(file, header);
  for (const ply_element& element : header.elements) {
    if (&element == &vertex) {
      cloud::cloud vertices = detail::ply_vertices(vertex, header, path).read(*data);
      result.origin = vertices.origin;
      result.vertices = std::move(vertices.points);
      for (std::string& w : vertices.warnings) result.warnings.push_back(std::move(w));
    } else if (&element == face) {
      faces.read(*data, result);
    } else {
      data->skip(element);
    }
  }
  return result;
}

}  // namespace aib::io

// aib/io/ply_write.hpp

namespace aib::io {

/// A number for each point or face, written as a float property of this name.
struct ply_scalar {
  std::string name;
  std::span<const float> values;
};

struct ply_cloud_extras {
  std::vector<ply_scalar> scalars = {};       ///< one value a point
  std::span<const cloud::color> colors = {};  ///< instead of the cloud's own
  std::vector<std::string> comments = {};
};

struct ply_mesh_extras {
  std::span<const cloud::color> vertex_colors = {};
  std::span<const cloud::color> face_colors = {};
  std::vector<ply_scalar> face_scalars = {};  ///< one value a triangle
  std::vector<std::string> comments = {};
};

/// Writes a cloud as binary little-endian PLY: x y z as float, or as double where the cloud has an
/// origin; then what it has of normals, colours, label and the scalars.
///
/// Throws argument_error where a column is not as long as the cloud, io_error where the file cannot
/// be written.
void write_ply(const std::filesystem::path& path,
               const cloud::cloud& cloud,
               const ply_cloud_extras& extras = {});

/// Writes a mesh as binary little-endian PLY; labels become a face property, their names a comment.
void write_ply(const std::filesystem::path& path,
               const mesh::mesh& mesh,
               const ply_mesh_extras& extras = {});

namespace detail {

/// Builds header and rows of a PLY file and hands them on in large pieces.
class ply_writer {
 public:
  explicit ply_writer(const std::filesystem::path& path) : file_(path) {
    buffer_ = "ply\nformat binary_little_endian 1.0\n";
  }

  void comment(std::string_view text) {
    std::string line(text);
    std::replace(line.begin(), line.end(), '\n', ' ');
    buffer_ += message("comment ", line, "\n");
  }
  void element(std::string_view name, std::size_t count) {
    buffer_ += message("element ", name, " ", count, "\n");
  }
  void property(std::string_view type, std::string_view name) {
    buffer_ += message("property ", type, " ", name, "\n");
  }
  void color_properties() {
    for (const char* channel : {"red", "green", "blue"}) property("uchar", channel);
  }
  void end_header() { buffer_ += "end_header\n"; }

  template <class T>
  void number(T value) {
    store(buffer_, value);
  }
  void position(const Eigen::Vector3d& origin, const Eigen::Vector3f& point) {
    if (origin.isZero(0)) {
      for (int k = 0; k < 3; ++k) number(point[k]);
    } else {
      for (int k = 0; k < 3; ++k) number(origin[k] + static_cast<double>(point[k]));
    }
  }
  void color(const cloud::color& c) {
    for (const std::uint8_t channel : c) number(channel);
  }
  void end_row() {
    if (buffer_.size() >= std::size_t{1} << 20) flush();
  }
  void commit() {
    flush();
    file_.commit();
  }

 private:
  void flush() {
    file_.write(buffer_);
    buffer_.clear();
  }

  output_file file_;
  std::string buffer_;
};

inline void position_properties(ply_writer& out, const Eigen::Vector3d& origin) {
  const char* type = origin.isZero(0) ? "float" : "double";
  for (const char* axis : {"x", "y", "z"}) out.property(type, axis);
}

inline void demand_length(std::string_view column, std::size_t found, std::size_t expected) {
  if (found == 0 || found == expected) return;
  throw argument_error(
      message("io::write_ply: ", column, ": ", expected, " values expected, found ", found));
}

inline void check_scalars(const std::vector<ply_scalar>& scalars, std::size_t expected) {
  for (const ply_scalar& s : scalars) {
    if (s.name.empty() || s.name.find_first_of(" \t\r\n") != std::string::npos)
      throw argument_error(message("io::write_ply: \"", s.name, "\" is not a name of a property"));
    if (s.values.size() != expected)
      throw argument_error(message("io::write_ply: ", s.name, ": ", expected,
                                   " values expected, found ", s.values.size()));
  }
}

inline std::string label_comment(const std::vector<std::string>& names) {
  std::string comment = "labels:";
  for (std::size_t i = 0; i < names.size(); ++i) {
    std::string name = names[i];
    std::replace(name.begin(), name.end(), ' ', '_');
    if (!name.empty()) comment += message(" ", i, "=", name);
  }
  return comment;
}

}  // namespace detail

inline void write_ply(const std::filesystem::path& path,
                      const cloud::cloud& cloud,
                      const ply_cloud_extras& extras) {
  const auto colors =
      extras.colors.empty() ? std::span<const cloud::color>(cloud.colors) : extras.colors;
  detail::demand_length("normals", cloud.normals.size(), cloud.size());
  detail::demand_length("colors", colors.size(), cloud.size());
  detail::demand_length("labels", cloud.labels.size(), cloud.size());
  detail::check_scalars(extras.scalars, cloud.size());

  detail::ply_writer out(path);
  for (const std::string& c : extras.comments) out.comment(c);
  out.element("vertex", cloud.size());
  detail::position_properties(out, cloud.origin);
  if (!cloud.normals.empty())
    for (const char* axis : {"nx", "ny", "nz"}) out.property("float", axis);
  if (!colors.empty()) out.color_properties();
  if (!cloud.labels.empty()) out.property("uint", "label");
  for (const ply_scalar& s : extras.scalars) out.property("float", s.name);
  out.end_header();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    out.position(cloud.origin, cloud.points[i]);
    if (!cloud.normals.empty())
      for (int k = 0; k < 3; ++k) out.number(cloud.normals[i][k]);
    if (!colors.empty()) out.color(colors[i]);
    if (!cloud.labels.empty()) out.number(cloud.labels[i]);
    for (const ply_scalar& s : extras.scalars) out.number(s.values[i]);
    out.end_row();
  }
  out.commit();
}

inline void write_ply(const std::filesystem::path& path,
                      const mesh::mesh& mesh,
                      const ply_mesh_extras& extras) {
  const std::size_t n_faces = mesh.triangles.size();
  detail::demand_length("vertex_colors", extras.vertex_colors.size(), mesh.vertices.size());
  detail::demand_length("face_colors", extras.face_colors.size(), n_faces);
  detail::demand_length("labels", mesh.labels.size(), n_faces);
  detail::check_scalars(extras.face_scalars, n_faces);

  detail::ply_writer out(path);
  for (const std::string& c : extras.comments) out.comment(c);
  if (!mesh.label_names.empty()) out.comment(detail::label_comment(mesh.label_names));
  out.element("vertex", mesh.vertices.size());
  detail::position_properties(out, mesh.origin);
  if (!extras.vertex_colors.empty()) out.color_properties();
  out.element("face", n_faces);
  out.property("list uchar uint", "vertex_indices");
  if (!mesh.labels.empty()) out.property("uint", "label");
  if (!extras.face_colors.empty()) out.color_properties();
  for (const ply_scalar& s : extras.face_scalars) out.property("float", s.name);
  out.end_header();
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    out.position(mesh.origin, mesh.vertices[i]);
    if (!extras.vertex_colors.empty()) out.color(extras.vertex_colors[i]);
    out.end_row();
  }
  for (std::size_t i = 0; i < n_faces; ++i) {
    out.number(std::uint8_t{3});
    for (const std::uint32_t v : mesh.triangles[i]) out.number(v);
    if (!mesh.labels.empty()) out.number(mesh.labels[i]);
    if (!extras.face_colors.empty()) out.color(extras.face_colors[i]);
    for (const ply_scalar& s : extras.face_scalars) out.number(s.values[i]);
    out.end_row();
  }
  out.commit();
}

}  // namespace aib::io

// aib/io/cloud.hpp

namespace aib::io {

struct cloud_options {
  up_axis up = up_axis::z;                 ///< axis that points up in the file
  splat_rule splats = splat_rule::refuse;  ///< PLY files of 3D Gaussian splats
};

/// Reads a cloud; the format is told from the content, then from the extension. Of a mesh file the
/// vertices are read.
///
/// Throws format_error where the format is not known or the file is damaged, io_error where it
/// cannot be read.
inline cloud::cloud read_cloud(const std::filesystem::path& path,
                               const cloud_options& options = {}) {
  cloud::cloud result;
  switch (kind_of(path)) {
    case file_kind::ply:
      result = read_ply_cloud(path, options.splats);
      break;
    default:
      throw format_error(path, "a cloud expected: PLY");
  }
  turn_z_up(result, options.up);
  return result;
}

/// Writes a cloud as PLY. Throws argument_error for another extension.
inline void write_cloud(const std::filesystem::path& path,
                        const cloud::cloud& cloud,
                        const ply_cloud_extras& extras = {}) {
  if (extension_of(path) != ".ply") {
    throw argument_error(message("io::write_cloud: the extension .ply expected, found \"",
                                 path.extension().string(), "\""));
  }
  write_ply(path, cloud, extras);
}

}  // namespace aib::io

// aib/io/fingerprint.hpp

namespace aib::io {

/// SHA-256 of bytes that come in pieces. Source: FIPS 180-4, sections 5 and 6.2.
class sha256 {
 public:
  sha256& add(std::string_view bytes);

  /// The digest of everything added, 64 hexadecimal digits. Nothing can be added after it.
  [[nodiscard]] std::string digest();

 private:
  void compress(const unsigned char* block);

  std::array<std::uint32_t, 8> state_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                      0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<unsigned char, 64> block_;
  std::size_t filled_ = 0;
  std::uint64_t length_ = 0;
};

/// What tells whether a file is still the same.
struct fingerprint {
  std::uint64_t bytes;
  std::string sha256;
};

/// Size and hash of a file's content. Throws io_error where it cannot be read.
fingerprint fingerprint_of(const std::filesystem::path& path);

namespace detail {

inline constexpr std::array<std::uint32_t, 64> sha256_constants{
    0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4, 0xab1c5ed5,
    0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174,
    0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f, 0x4a7484aa, 0x5cb0a9dc, 0x76f988da,
    0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967,
    0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85,
    0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070,
    0x19a4c116, 0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
    0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2};

}  // namespace detail

inline sha256& sha256::add(std::string_view bytes) {
  length_ += bytes.size();
  while (!bytes.empty()) {
    const std::size_t n = std::min(bytes.size(), block_.size() - filled_);
    std::memcpy(block_.data() + filled_, bytes.data(), n);
    filled_ += n;
    bytes.remove_prefix(n);
    if (filled_ == block_.size()) {
      compress(block_.data());
      filled_ = 0;
    }
  }
  return *this;
}

inline std::string sha256::digest() {
  const std::uint64_t bits = length_ * 8;
  std::string padding(1 + (119 - filled_) % 64, '\0');
  padding[0] = '\x80';
  for (int shift = 56; shift >= 0; shift -= 8) padding += static_cast<char>(bits >> shift & 0xff);
  add(padding);
  std::string hex;
  for (const std::uint32_t word : state_) {
    for (int shift = 28; shift >= 0; shift -= 4) hex += "0123456789abcdef"[word >> shift & 0xf];
  }
  return hex;
}

inline void sha256::compress(const unsigned char* block) {
  std::array<std::uint32_t, 64> w;
  for (std::size_t i = 0; i < 16; ++i) {
    const unsigned char* b = block + 4 * i;
    w[i] = std::uint32_t{b[0]} << 24 | std::uint32_t{b[1]} << 16 | std::uint32_t{b[2]} << 8 | b[3];
  }
  for (std::size_t i = 16; i < 64; ++i) {
    const auto near = std::rotr(w[i - 2], 17) ^ std::rotr(w[i - 2], 19) ^ w[i - 2] >> 10;
    const auto far = std::rotr(w[i - 15], 7) ^ std::rotr(w[i - 15], 18) ^ w[i - 15] >> 3;
    w[i] = near + w[i - 7] + far + w[i - 16];
  }
  auto [a, b, c, d, e, f, g, h] = state_;
  for (std::size_t i = 0; i < 64; ++i) {
    const auto sum_e = std::rotr(e, 6) ^ std::rotr(e, 11) ^ std::rotr(e, 25);
    const auto sum_a = std::rotr(a, 2) ^ std::rotr(a, 13) ^ std::rotr(a, 22);
    const auto first = h + sum_e + ((e & f) ^ (~e & g)) + detail::sha256_constants[i] + w[i];
    const auto second = sum_a + ((a & b) ^ (a & c) ^ (b & c));
    h = g;
    g = f;
    f = e;
    e = d + first;
    d = c;
    c = b;
    b = a;
    a = first + second;
  }
  const std::array<std::uint32_t, 8> change{a, b, c, d, e, f, g, h};
  for (std::size_t i = 0; i < 8; ++i) state_[i] += change[i];
}

inline fingerprint fingerprint_of(const std::filesystem::path& path) {
  const input_file file(path);
  sha256 hash;
  std::vector<char> piece(std::size_t{1} << 20);
  for (std::uint64_t at = 0; at < file.size(); at += piece.size()) {
    const auto n =
        static_cast<std::size_t>(std::min<std::uint64_t>(piece.size(), file.size() - at));
    file.read_at(at, piece.data(), n);
    hash.add({piece.data(), n});
  }
  return {file.size(), hash.digest()};
}

}  // namespace aib::io

// aib/io/half.hpp

namespace aib::io {

/// The value of an IEEE 754 half-precision number from its bits; exact.
[[nodiscard]] constexpr float float_from_half(std::uint16_t bits) {
  const std::uint32_t sign = std::uint32_t{bits & 0x8000u} << 16;
  const std::uint32_t exponent = (bits >> 10) & 0x1fu;
  const std::uint32_t mantissa = bits & 0x3ffu;
  if (exponent == 0) {  // zero and subnormals: mantissa * 2^-24
    const float magnitude = static_cast<float>(mantissa) * 0x1p-24f;
    return sign != 0 ? -magnitude : magnitude;
  }
  const std::uint32_t wide = exponent == 31 ? 255 : exponent + (127 - 15);
  return std::bit_cast<float>(sign | (wide << 23) | (mantissa << 13));
}

}  // namespace aib::io

// aib/io/mesh.hpp

namespace aib::io {

struct mesh_options {
  up_axis up = up_axis::z;  ///< axis that points up in the file
};

/// Reads a mesh; the format is told from the content, then from the extension.
///
/// Throws format_error where the format is not known or the file is damaged, io_error where it
/// cannot be read.
inline mesh::mesh read_mesh(const std::filesystem::path& path, const mesh_options& options = {}) {
  mesh::mesh result;
  switch (kind_of(path)) {
    case file_kind::ply:
      result = read_ply_mesh(path);
      break;
    default:
      throw format_error(path, "a mesh expected: PLY");
  }
  turn_z_up(result, options.up);
  return result;
}

/// Writes a mesh as PLY. Throws argument_error for another extension.
inline void write_mesh(const std::filesystem::path& path,
                       const mesh::mesh& mesh,
                       const ply_mesh_extras& extras = {}) {
  if (extension_of(path) != ".ply") {
    throw argument_error(message("io::write_mesh: the extension .ply expected, found \"",
                                 path.extension().string(), "\""));
  }
  write_ply(path, mesh, extras);
}

}  // namespace aib::io

// aib/io/npy.hpp

namespace aib::io {

/// Element types of arrays, with NumPy's names: kind and bytes.
enum class dtype { b1, i1, i2, i4, i8, u1, u2, u4, u8, f2, f4, f8 };

/// "f4" and the like.
[[nodiscard]] std::string_view name(dtype type);

/// Bytes of an element.
[[nodiscard]] std::size_t size_of(dtype type);

/// The type that holds T: bool, the integers and floats of 1 to 8 bytes.
template <class T>
[[nodiscard]] constexpr dtype dtype_of();

/// A dense array of numbers of any shape. The elements lie in C order (last index fastest) and in
/// the machine's byte order, whatever the file had.
struct array {
  dtype type = dtype::f8;
  std::vector<std::size_t> shape = {};  ///< empty: a single number
  std::string bytes = {};               ///< size() * size_of(type)

  [[nodiscard]] std::size_t size() const;
  /// The sub-array at an index of the first axis: `a[index]`. Throws argument_error if there is
  /// none.
  [[nodiscard]] array at(std::size_t index) const;
  /// Element `i` in C order, as a double. Integers beyond 2^53 are rounded.
  [[nodiscard]] double operator[](std::size_t i) const;
  /// All elements in C order, as float or double.
  template <std::floating_point Scalar>
  [[nodiscard]] std::vector<Scalar> values() const;
};

/// The shape as NumPy prints it: "(8, 5)", "(3,)", "()".
[[nodiscard]] std::string text_of_shape(std::span<const std::size_t> shape);

/// An array of the given shape over a copy of `values`. Throws argument_error where their number
/// is another.
template <class T>
[[nodiscard]] array make_array(std::vector<std::size_t> shape, std::span<const T> values);

/// An NPY file: versions 1 to 3, both byte orders, C and Fortran order, bool, integers and floats
/// of 1 to 8 bytes. Bytes after the elements are ignored, as NumPy does.
///
/// Throws format_error for pickled objects, structures, complex numbers, strings and long doubles,
/// and where the file is shorter than its shape.
/// Source: NumPy Enhancement Proposal 1, and numpy.lib.format of NumPy 2.
[[nodiscard]] array read_npy(const std::filesystem::path& path);

/// The same from bytes in memory; `path` names them in errors.
[[nodiscard]] array parse_npy(std::string bytes, const std::filesystem::path& path);

/// What NumPy writes for an array: version 1, C order, little endian, elements from a multiple of
/// 64 bytes on.
[[nodiscard]] std::string npy_bytes(const array& a);

void write_npy(const std::filesystem::path& path, const array& a);

namespace detail {

struct dtype_info {
  std::string_view name;
  std::size_t bytes;
};

inline constexpr std::array<dtype_info, 12> dtypes{{{"b1", 1},
                                                    {"i1", 1},
                                                    {"i2", 2},
                                                    {"i4", 4},
                                                    {"i8", 8},
                                                    {"u1", 1},
                                                    {"u2", 2},
                                                    {"u4", 4},
                                                    {"u8", 8},
                                                    {"f2", 2},
                                                    {"f4", 4},
                                                    {"f8", 8}}};

/// What the header of an NPY file says.
struct npy_header {
  dtype type = dtype::f8;
  std::endian order = std::endian::little;
  bool fortran = false;
  std::vector<std::size_t> shape;
  std::size_t begin = 0;  ///< byte of the first element
};

/// Reads the header's Python dictionary: no more of the language than NumPy writes there.
class npy_dictionary {
 public:
  npy_dictionary(std::string_view text, std::size_t at_byte, const std::filesystem::path& path)
      : text_(text), offset_(at_byte), path_(path) {}

  npy_header read() {
    expect('{');
    while (!accept('}')) {
      const std::string_view key = quoted();
      expect(':');
      value(key);
      if (!accept(',') && peek() != '}') fail("',' or '}' expected");
    }
    skip_blanks();
    if (at_ < text_.size()) fail("text after the dictionary");
    if (!seen_type_ || !seen_order_ || !seen_shape_)
      fail("the keys descr, fortran_order and shape expected");
    return std::move(header_);
  }

 private:
  void value(std::string_view key) {
    if (key == "descr") {
      once(seen_type_, key);
      type();
    } else if (key == "fortran_order") {
      once(seen_order_, key);
      header_.fortran = boolean();
    } else if (key == "shape") {
      once(seen_shape_, key);
      shape();
    } else {
      fail(message("unknown key '", key, "'"));
    }
  }

  void once(bool& seen, std::string_view key) const {
    if (std::exchange(seen, true)) fail(message("the key ", key, " comes twice"));
  }

  void type() {
    if (peek() == '[') fail("structured elements are not supported; save the fields apart");
    const std::string_view descr = quoted();
    const std::string_view type = descr.size() > 1 ? descr.substr(1) : descr;
    if (type.starts_with('O'))
      fail("the elements are pickled Python objects, which are never loaded");
    const auto known = std::find_if(dtypes.begin(), dtypes.end(),
                                    [&](const dtype_info& info) { return info.name == type; });
    const char order = descr.empty() ? '\0' : descr.front();
    const bool ordered = order == '<' || order == '>' || order == '=';
    if (known == dtypes.end() || !(ordered || (order == '|' && known->bytes == 1))) {
      fail(message("element type '", descr,
                   "' is not supported; bool, integers and floats of 1 to 8 bytes are"));
    }
    header_.type = static_cast<dtype>(known - dtypes.begin());
    if (order == '>') header_.order = std::endian::big;
    if (order == '=') header_.order = std::endian::native;
  }

  bool boolean() {
    if (accept_word("True")) return true;
    if (accept_word("False")) return false;
    fail("fortran_order: True or False expected");
  }

  void shape() {
    constexpr std::size_t max_axes = 32;
    expect('(');
    while (!accept(')')) {
      skip_blanks();
      const std::size_t end = std::min(text_.find_first_not_of("0123456789", at_), text_.size());
      const auto extent = parse<std::size_t>(text_.substr(at_, end - at_));
      if (!extent) fail("shape: a whole number expected");
      at_ = end;
      accept('L');  // Python 2 wrote long integers so
      header_.shape.push_back(*extent);
      if (header_.shape.size() > max_axes) fail("shape: more than 32 axes");
      if (!accept(',') && peek() != ')') fail("shape: ',' or ')' expected");
    }
  }

  std::string_view quoted() {
    const char quote = peek();
    if (quote != '\'' && quote != '"') fail("a quoted name expected");
    const std::size_t end = text_.find(quote, at_ + 1);
    if (end == std::string_view::npos) fail("a quoted name without an end");
    const std::string_view content = text_.substr(at_ + 1, end - at_ - 1);
    at_ = end + 1;
    return content;
  }

  void skip_blanks() { at_ = std::min(text_.find_first_not_of(" \t\r\n", at_), text_.size()); }
  char peek() {
    skip_blanks();
    return at_ < text_.size() ? text_[at_] : '\0';
  }
  bool accept(char c) {
    if (peek() != c || at_ == text_.size()) return false;
    ++at_;
    return true;
  }
  bool accept_word(std::string_view word) {
    skip_blanks();
    if (!text_.substr(at_).starts_with(word)) return false;
    at_ += word.size();
    return true;
  }
  void expect(char c) {
    if (!accept(c)) fail(message("'", c, "' expected"));
  }
  [[noreturn]] void fail(std::string_view what) const {
    throw format_error(path_, at_byte{offset_ + at_}, message("npy: header: ", what));
  }

  std::string_view text_;
  std::size_t offset_;
  const std::filesystem::path& path_;
  std::size_t at_ = 0;
  npy_header header_;
  bool seen_type_ = false;
  bool seen_order_ = false;
  bool seen_shape_ = false;
};

/// Number of elements; nothing where it does not fit in memory's arithmetic.
inline std::optional<std::size_t> element_count(std::span<const std::size_t> shape) {
  constexpr std::size_t limit = std::numeric_limits<std::size_t>::max() / 16;
  std::size_t count = 1;
  bool empty = false;
  for (const std::size_t extent : shape) {
    empty |= extent == 0;
    if (extent > limit / count) return std::nullopt;
    count *= std::max<std::size_t>(extent, 1);
  }
  return empty ? 0 : count;
}

/// The bytes before the header's text: magic, version and its length.
struct npy_preamble {
  std::size_t text_begin;
  std::size_t text_size;
};

inline npy_preamble read_npy_preamble(std::string_view bytes, const std::filesystem::path& path) {
  byte_reader in(bytes, path);
  if (in.take(std::min<std::size_t>(6, bytes.size()), "npy: magic") != "\x93NUMPY")
    throw format_error(path, at_byte{0}, "npy: not an NPY file: it does not begin with \\x93NUMPY");
  const auto version = in.read<std::uint8_t>("npy: version");
  in.read<std::uint8_t>("npy: version");
  if (version < 1 || version > 3)
    in.fail(message("npy: version 1, 2 or 3 expected, found ", unsigned{version}));
  const std::size_t size = version == 1 ? in.read<std::uint16_t>("npy: header length")
                                        : in.read<std::uint32_t>("npy: header length");
  return {in.position(), size};
}

/// The header from the first bytes of a file that holds `file_size`.
/// Refuses a shape that the file cannot hold.
inline npy_header read_npy_header(std::string_view bytes,
                                  std::uint64_t file_size,
                                  const std::filesystem::path& path) {
  const npy_preamble preamble = read_npy_preamble(bytes, path);
  byte_reader in(bytes, path);
  in.take(preamble.text_begin, "npy: magic");
  const std::string_view text = in.take(preamble.text_size, "npy: header");
  npy_header header = npy_dictionary(text, preamble.text_begin, path).read();
  header.begin = in.position();
  const std::uint64_t left = file_size - header.begin;
  const auto count = element_count(header.shape);
  if (!count || *count > left / size_of(header.type)) {
    in.fail(message("npy: ", text_of_shape(header.shape), " elements of type ", name(header.type),
                    " do not fit in the ", left, " bytes left"));
  }
  return header;
}

inline void reverse_elements(std::string& bytes, std::size_t element) {
  for (std::size_t i = 0; i + element <= bytes.size(); i += element)
    std::reverse(bytes.data() + i, bytes.data() + i + element);
}

/// The elements of a Fortran-ordered array in C order.
inline std::string c_ordered(const std::string& bytes,
                             std::span<const std::size_t> shape,
                             std::size_t element) {
  std::vector<std::size_t> stride(shape.size());
  std::size_t step = element;
  for (std::size_t axis = 0; axis < shape.size(); ++axis) {
    stride[axis] = step;
    step *= shape[axis];
  }
  std::string out(bytes.size(), '\0');
  std::vector<std::size_t> index(shape.size(), 0);
  std::size_t from = 0;
  for (std::size_t to = 0; to < out.size(); to += element) {
    std::memcpy(out.data() + to, bytes.data() + from, element);
    for (std::size_t axis = shape.size(); axis-- > 0;) {
      from += stride[axis];
      if (++index[axis] < shape[axis]) break;
      from -= stride[axis] * shape[axis];
      index[axis] = 0;
    }
  }
  return out;
}

inline array make_array(npy_header header, std::string bytes) {
  const std::size_t element = size_of(header.type);
  if (header.order != std::endian::native) reverse_elements(bytes, element);
  if (header.fortran && header.shape.size() > 1) bytes = c_ordered(bytes, header.shape, element);
  return {header.type, std::move(header.shape), std::move(bytes)};
}

template <class T>
double load_native(const char* from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  return static_cast<double>(value);
}

inline double load_half(const char* from) {
  std::uint16_t bits;
  std::memcpy(&bits, from, sizeof bits);
  return static_cast<double>(float_from_half(bits));
}

inline double load_boolean(const char* from) { return *from != 0 ? 1 : 0; }

/// The function that reads an element of a type.
inline double (*loader(dtype type))(const char*) {
  switch (type) {
    case dtype::b1:
      return load_boolean;
    case dtype::i1:
      return load_native<std::int8_t>;
    case dtype::i2:
      return load_native<std::int16_t>;
    case dtype::i4:
      return load_native<std::int32_t>;
    case dtype::i8:
      return load_native<std::int64_t>;
    case dtype::u1:
      return load_native<std::uint8_t>;
    case dtype::u2:
      return load_native<std::uint16_t>;
    case dtype::u4:
      return load_native<std::uint32_t>;
    case dtype::u8:
      return load_native<std::uint64_t>;
    case dtype::f2:
      return load_half;
    case dtype::f4:
      return load_native<float>;
    case dtype::f8:
      break;
  }
  return load_native<double>;
}

}  // namespace detail

inline std::string_view name(dtype type) {
  return detail::dtypes[static_cast<std::size_t>(type)].name;
}

inline std::size_t size_of(dtype type) {
  return detail::dtypes[static_cast<std::size_t>(type)].bytes;
}

template <class T>
constexpr dtype dtype_of() {
  static_assert(std::is_arithmetic_v<T> && sizeof(T) <= 8, "no element type of arrays");
  if constexpr (std::is_same_v<T, bool>) return dtype::b1;
  if constexpr (std::is_floating_point_v<T>) return sizeof(T) == 4 ? dtype::f4 : dtype::f8;
  const int power = std::countr_zero(sizeof(T));
  return static_cast<dtype>(static_cast<int>(std::is_signed_v<T> ? dtype::i1 : dtype::u1) + power);
}

inline std::size_t array::size() const { return detail::element_count(shape).value_or(0); }

inline array array::at(std::size_t index) const {
  if (shape.empty() || index >= shape.front()) {
    throw argument_error(
        message("array: no element ", index, " on the first axis of ", text_of_shape(shape)));
  }
  const std::size_t n = bytes.size() / shape.front();
  return {type, {shape.begin() + 1, shape.end()}, bytes.substr(index * n, n)};
}

inline double array::operator[](std::size_t i) const {
  return detail::loader(type)(bytes.data() + i * size_of(type));
}

template <std::floating_point Scalar>
std::vector<Scalar> array::values() const {
  std::vector<Scalar> out(size());
  if (type == dtype_of<Scalar>()) {
    if (!out.empty()) std::memcpy(out.data(), bytes.data(), bytes.size());
    return out;
  }
  const auto load = detail::loader(type);
  const std::size_t element = size_of(type);
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = static_cast<Scalar>(load(bytes.data() + i * element));
  return out;
}

inline std::string text_of_shape(std::span<const std::size_t> shape) {
  std::string text = "(";
  for (std::size_t i = 0; i < shape.size(); ++i)
    text += message(shape[i], i + 1 < shape.size() ? ", " : "");
  return text + (shape.size() == 1 ? ",)" : ")");
}

template <class T>
array make_array(std::vector<std::size_t> shape, std::span<const T> values) {
  array a{dtype_of<std::remove_const_t<T>>(), std::move(shape), {}};
  if (detail::element_count(a.shape) != values.size()) {
    throw argument_error(
        message("make_array: ", values.size(), " values for shape ", text_of_shape(a.shape)));
  }
  a.bytes.assign(reinterpret_cast<const char*>(values.data()), values.size_bytes());
  return a;
}

inline array read_npy(const std::filesystem::path& path) {
  const input_file file(path);
  const auto part = [&](std::uint64_t offset, std::uint64_t n) {
    std::string bytes(static_cast<std::size_t>(std::min(n, file.size() - offset)), '\0');
    file.read_at(offset, bytes.data(), bytes.size());
    return bytes;
  };
  const std::string start = part(0, 12);
  const detail::npy_preamble preamble = detail::read_npy_preamble(start, path);
  const std::string text = part(0, preamble.text_begin + preamble.text_size);
  detail::npy_header header = detail::read_npy_header(text, file.size(), path);
  std::string elements =
      part(header.begin, *detail::element_count(header.shape) * size_of(header.type));
  return detail::make_array(std::move(header), std::move(elements));
}

inline array parse_npy(std::string bytes, const std::filesystem::path& path) {
  detail::npy_header header = detail::read_npy_header(bytes, bytes.size(), path);
  bytes.erase(0, header.begin);
  bytes.resize(*detail::element_count(header.shape) * size_of(header.type));
  return detail::make_array(std::move(header), std::move(bytes));
}

inline std::string npy_bytes(const array& a) {
  std::string text = message("{'descr': '", size_of(a.type) == 1 ? '|' : '<', name(a.type),
                             "', 'fortran_order': False, 'shape': ", text_of_shape(a.shape), ", }");
  text.append(63 - (10 + text.size()) % 64, ' ');
  text += '\n';
  std::string bytes("\x93NUMPY\x01\x00", 8);
  store(bytes, static_cast<std::uint16_t>(text.size()));
  std::string elements = a.bytes;
  if (std::endian::native != std::endian::little)
    detail::reverse_elements(elements, size_of(a.type));
  return bytes + text + elements;
}

inline void write_npy(const std::filesystem::path& path, const array& a) {
  write_file(path, npy_bytes(a));
}

}  // namespace aib::io
