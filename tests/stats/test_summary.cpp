// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/stats/summary.hpp>

#include <doctest/doctest.h>

#include <vector>

using namespace aib;

namespace test_summary {

TEST_CASE("the statistics of 3 and 4") {
  const std::vector<double> errors{3, 4};
  const auto s = stats::summarize(errors);
  CHECK(s.count == 2);
  CHECK(s.rmse == doctest::Approx(std::sqrt(12.5)));
  CHECK(s.mean == 3.5);
  CHECK(s.median == 3.5);
  CHECK(s.std == 0.5);
  CHECK(s.min == 3);
  CHECK(s.max == 4);
  CHECK(s.sse == 25);
  CHECK_THROWS_AS(stats::summarize({}), undefined_error);
}

}  // namespace test_summary
