// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include "suggest.hpp"

#include <algorithm>

namespace aib::bind {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  const std::size_t width = b.size() + 1;
  std::vector<std::size_t> d((a.size() + 1) * width);
  for (std::size_t i = 0; i <= a.size(); ++i) d[i * width] = i;
  for (std::size_t j = 0; j < width; ++j) d[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j < width; ++j) {
      const std::size_t replaced = d[(i - 1) * width + j - 1] + (a[i - 1] != b[j - 1]);
      d[i * width + j] = std::min({d[(i - 1) * width + j] + 1, d[i * width + j - 1] + 1, replaced});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i * width + j] = std::min(d[i * width + j], d[(i - 2) * width + j - 2] + 1);
    }
  }
  return d.back();
}

std::string suggestion(std::string_view name, const std::vector<std::string>& known) {
  if (known.empty()) return "";
  const auto nearer = [&](const std::string& a, const std::string& b) {
    return edit_distance(name, a) < edit_distance(name, b);
  };
  const std::string& nearest = *std::min_element(known.begin(), known.end(), nearer);
  const std::size_t bound = std::max<std::size_t>(1, std::min(name.size(), nearest.size()) / 3);
  if (edit_distance(name, nearest) <= bound) return ", did you mean '" + nearest + "'?";
  std::string list;
  for (const std::string& k : known) list += (list.empty() ? "" : ", ") + k;
  return known.size() <= 24 ? " (known: " + list + ")" : "";
}

}  // namespace aib::bind
