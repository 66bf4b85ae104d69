// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
//
// Files written by other programs, and malformed ones: each must be read as expected, refused with
// a clear error, or either. A reader takes the path and what the manifest expects, checks the
// expectation and lets its errors through.
#include <aib/core/error.hpp>

#include <doctest/doctest.h>

#include "zoo.hpp"
#include <fstream>
#include <map>
#include <new>
#include <string>
#include <support/shared.hpp>

using namespace aib;
using nlohmann::json;

namespace test_zoo {

namespace {

struct outcome {
  bool read = false;
  std::string error = {};  ///< the sentence, where it was refused
};

outcome try_to_read(const zoo::reader& reader,
                    const std::filesystem::path& path,
                    const json& expect) {
  try {
    reader(path, expect);
    return {.read = true};
  } catch (const error& e) {
    return {.error = e.what()};
  }
}

void check(const outcome& o, const std::string& must) {
  if (must == "read") CHECK_MESSAGE(o.read, o.error);
  if (must == "fail") CHECK_FALSE(o.read);
  if (!o.read) CHECK(o.error.size() > 20);  // a sentence, not a word
}

}  // namespace

TEST_CASE("the zoo: files of other programs are read as expected, broken ones refused") {
  if (!support::has_shared("zoo of files")) return;
  const auto golden = support::shared() / "golden";
  std::ifstream file(golden / "manifest.json");
  const json manifest = json::parse(file);
  std::map<std::string, int> read_by;
  for (const json& entry : manifest.at("zoo")) {
    const auto format = entry.at("format").get<std::string>();
    const auto reader = zoo::readers().find(format.substr(0, format.find(' ')));
    if (reader == zoo::readers().end()) continue;
    const auto name = entry.at("file").get<std::string>();
    CAPTURE(name);
    json expect = entry.at("expect");
    if (expect.is_string()) {
      std::ifstream expected(golden / expect.get<std::string>());
      expect = json::parse(expected);
    }
    check(try_to_read(reader->second, golden / name, expect), entry.at("must").get<std::string>());
    ++read_by[reader->first];
  }
  for (const auto& reader : zoo::readers()) {
    CAPTURE(reader.first);
    CHECK(read_by[reader.first] > 0);
  }
}

}  // namespace test_zoo
