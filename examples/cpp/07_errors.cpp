// One family of exceptions; a message says where, what was expected, what was found.
#include <aib/cloud/compare.hpp>
#include <aib/io/tum.hpp>

#include <cstdio>

int main() {
  try {
    (void)aib::io::read_tum("examples/data/nowhere.tum");
  } catch (const aib::io_error& e) {
    std::printf("io_error: %s\n", e.what());
  }
  try {
    (void)aib::cloud::compare({}, {});
  } catch (const aib::undefined_error& e) {
    std::printf("undefined_error: %s\n", e.what());
  }
}
