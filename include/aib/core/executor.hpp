// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <fstream>
#include <functional>
#include <mutex>
#include <stop_token>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

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

/// Throws stopped_error when `control.stop` was requested: for long loops that are no chunks.
inline void demand_go(const control& control) {
  if (control.stop.stop_requested()) throw stopped_error("stopped");
}

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
/// threads   0: available_threads(); fewer where the system gives no more
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
    try {
      for (std::size_t i = 1; i < workers; ++i) pool.emplace_back([&] { region.work(body); });
    } catch (const std::system_error&) {  // a limit of threads or memory: fewer do the work
    }
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
