// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/stream/compare_clouds.hpp>

#include "cloud.hpp"
#include "kit.hpp"
#include <cctype>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <string>

namespace aib::bind {

namespace {

/// Bytes of "2GB", "512 MB", "100000".
std::uint64_t bytes_of(const std::string& text, options& o) {
  double n = 0;
  const char* end = text.data() + text.size();
  const char* at = std::from_chars(text.data(), end, n).ptr;
  while (at < end && *at == ' ') ++at;
  std::string unit(at, end);
  for (char& c : unit) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  const double factor = unit.empty() || unit == "B" ? 1
                        : unit == "KB"              ? 1e3
                        : unit == "MB"              ? 1e6
                        : unit == "GB"              ? 1e9
                                                    : 0;
  if (!(n > 0 && n < 1e15) || factor == 0)
    o.reject("memory", message("a size as \"2GB\" or \"500MB\" expected, found '", text, "'"));
  return static_cast<std::uint64_t>(n * factor);
}

stream::compare_clouds_options compare_options(options& o, const session& s) {
  stream::compare_clouds_options c;
  c.memory = bytes_of(o.text("memory", "2GB"), o);
  c.folder = o.get<std::filesystem::path>("folder").value_or(c.folder);
  const auto how = distance_options(o, s);
  c.compare = {.tau = o.numbers("tau", {}),
               .max_distance = how.max_distance,
               .rule = how.rule,
               .threads = how.threads,
               .control = how.control};
  if (const auto watch = o.get<sol::protected_function>("progress")) {
    c.compare.control.progress = [watch = *watch](double share) {
      const sol::protected_function_result told = watch(share);
      if (!told.valid()) throw argument_error(told.get<sol::error>().what());
    };
  }
  return c;
}

}  // namespace

void bind_stream(lua_State* state) {
  module(state, "stream")
      .function("compare_clouds", {"est_path", "ref_path", "options"},
                [](lua_State* l, session& s, const std::filesystem::path& est,
                   const std::filesystem::path& ref, options& o) {
                  const auto how = compare_options(o, s);
                  o.done();
                  return as_record(l, stream::compare_clouds(est, ref, how));
                });
}

}  // namespace aib::bind
