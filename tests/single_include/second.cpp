// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/aib.hpp>

double median_of_second(const std::vector<double>& values) {
  return aib::stats::quantile(std::span(values), 0.5);
}
