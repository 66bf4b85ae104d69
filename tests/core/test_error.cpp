// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/core/error.hpp>

#include <doctest/doctest.h>

using namespace aib;

namespace test_error {

TEST_CASE("a message writes numbers in their shortest exact form") {
  CHECK(message("x = ", 0.1, ", n = ", 3, ", ", true, '!') == "x = 0.1, n = 3, true!");
  CHECK(message(1e300) == "1e+300");
}

TEST_CASE("a format error names the file and the place") {
  CHECK_THROWS_WITH_AS(throw format_error("walk.txt", at_line{17}, "tum: found 7"),
                       "walk.txt:17: tum: found 7", error);
  CHECK_THROWS_WITH_AS(throw format_error("a.bin", at_byte{8}, "cut"), "a.bin: byte 8: cut",
                       format_error);
  CHECK_THROWS_WITH_AS(throw io_error("a b.bin", "cannot open"), "a b.bin: cannot open", io_error);
}

}  // namespace test_error
