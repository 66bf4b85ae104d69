// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/aib.hpp>

#include <cmath>
#include <cstdio>

double median_of_second(const std::vector<double>& values);

int main() {
  const std::vector<double> values = {3, 1, 2};
  aib::stats::moments first;
  for (const double value : values) first.add(value);
  std::printf("mean %g, median %g\n", first.mean(), median_of_second(values));
  const bool is_right = first.mean() == 2 && median_of_second(values) == 2;
  std::printf("%d passed, %d failed\n", is_right, !is_right);
  return is_right ? 0 : 1;
}
