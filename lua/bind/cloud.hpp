// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/box.hpp>
#include <aib/cloud/by_label.hpp>
#include <aib/cloud/compare.hpp>
#include <aib/cloud/distances.hpp>
#include <aib/cloud/offsets.hpp>

#include "kit.hpp"
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace aib::bind {

// What the bindings of clouds and of meshes share; defined in cloud.cpp and cloud_scores.cpp.

/// 1204331 as "1 204 331".
std::string grouped(std::size_t n);

/// ", bbox 12.1 x 8.0 x 3.2 m", nothing for an empty box.
std::string extent_text(const cloud::box& box);

/// { min = {x, y, z}, max = {x, y, z} }, as aib.cloud.crop takes it.
record as_record(lua_State* state, const cloud::box& box);

/// Scores at several thresholds, a list for each.
struct threshold_columns {
  explicit threshold_columns(const std::vector<cloud::threshold_scores>& scores);

  std::vector<double> tau = {}, precision = {}, recall = {}, f_score = {};
};

record as_record(lua_State* state, const cloud::comparison& c);

/// A comparison for each label that both clouds have points of, else the numbers of points alone.
std::vector<record> as_records(lua_State* state,
                               const std::vector<cloud::label_distances>& labels,
                               const std::vector<double>& tau);

/// Distances, offsets or a list of numbers as numbers; nothing of anything else.
std::optional<std::vector<float>> values_in(const sol::object& values);

/// The same; throws argument_error for anything else.
std::vector<float> values_of(const sol::object& values, const char* function);

/// max_distance and rule.
cloud::distance_options distance_options(options& o, const session& s);

}  // namespace aib::bind
