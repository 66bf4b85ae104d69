// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace aib::bind {

/// What to add to "unknown X 'name'": ", did you mean 'Y'?" for the nearest of the known names, the
/// list of them where none is near, nothing where there is none.
std::string suggestion(std::string_view name, const std::vector<std::string>& known);

/// Edits that turn one name into another: insertions, deletions, replacements, swaps of neighbours.
std::size_t edit_distance(std::string_view a, std::string_view b);

}  // namespace aib::bind
