// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
//
// The test programs' main. AIB_TEST_LOCALE names a locale that they run in:
// tests/hostile/variants.py.
#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include <cstdlib>
#include <locale>

int main(int count, char** arguments) {
  if (const char* name = std::getenv("AIB_TEST_LOCALE")) std::locale::global(std::locale(name));
  return doctest::Context(count, arguments).run();
}
