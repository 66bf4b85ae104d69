// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/core/executor.hpp>

#include <doctest/doctest.h>

#include <atomic>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

using namespace aib;

namespace test_executor {

namespace {

double harmonic(unsigned threads) {
  return reduce_chunks(
      100'003, 1000, threads, {}, 0.0,
      [](const chunk& c) {
        double sum = 0;
        for (std::size_t i = c.begin; i < c.end; ++i) sum += 1 / static_cast<double>(i + 1);
        return sum;
      },
      [](double a, double b) { return a + b; });
}

}  // namespace

TEST_CASE("every item is visited once, in chunks that do not depend on the number of threads") {
  for (const unsigned threads : {1u, 2u, 5u}) {
    std::vector<std::atomic<int>> visits(1001);
    for_each_chunk(visits.size(), 100, threads, {}, [&](const chunk& c) {
      CHECK(c.begin == c.index * 100);
      for (std::size_t i = c.begin; i < c.end; ++i) ++visits[i];
    });
    for (const auto& n : visits) REQUIRE(n == 1);
  }
}

TEST_CASE("a sum has the same bits for any number of threads") {
  const double one = harmonic(1);
  CHECK(one == doctest::Approx(std::log(100'003) + 0.5772156649).epsilon(1e-6));
  CHECK(harmonic(2) == one);
  CHECK(harmonic(5) == one);
}

TEST_CASE("nothing to do calls nothing, a chunk size of 0 is refused") {
  for_each_chunk(0, 10, 2, {}, [](const chunk&) { FAIL("called"); });
  CHECK_THROWS_AS(for_each_chunk(5, 0, 2, {}, [](const chunk&) {}), argument_error);
}

TEST_CASE("the exception of the lowest chunk reaches the caller") {
  for (const unsigned threads : {1u, 3u}) {
    CHECK_THROWS_WITH_AS(for_each_chunk(100, 1, threads, {},
                                        [](const chunk& c) {
                                          if (c.index == 0) throw std::runtime_error("chunk 0");
                                          if (c.index == 99) throw std::runtime_error("chunk 99");
                                        }),
                         "chunk 0", std::runtime_error);
  }
}

TEST_CASE("a stop request ends the work with stopped_error") {
  std::stop_source source;
  std::atomic<int> done = 0;
  const control control{.stop = source.get_token()};
  CHECK_THROWS_AS(for_each_chunk(1000, 1, 2, control,
                                 [&](const chunk&) {
                                   if (++done == 10) source.request_stop();
                                 }),
                  stopped_error);
  CHECK(done < 1000);
}

TEST_CASE("progress rises to 1") {
  double last = 0;
  const control control{.progress = [&](double share) {
    CHECK(share > last);
    last = share;
  }};
  for_each_chunk(50, 1, 2, control, [](const chunk&) {});
  CHECK(last == 1);
}

TEST_CASE("parallel work inside parallel work runs on its own thread") {
  std::atomic<int> wrong = 0;
  for_each_chunk(4, 1, 2, {}, [&](const chunk&) {
    const auto outer = std::this_thread::get_id();
    for_each_chunk(4, 1, 2, {},
                   [&](const chunk&) { wrong += std::this_thread::get_id() != outer; });
  });
  CHECK(wrong == 0);
}

}  // namespace test_executor
