// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/io/half.hpp>
#include <aib/io/npy.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <string>
#include <support/scratch.hpp>
#include <vector>

using namespace aib;
using namespace std::string_literals;

namespace test_npy {

namespace {

/// An NPY file of version 1 around a header and the bytes of its elements.
std::string npy(std::string header, const std::string& elements) {
  std::string bytes = "\x93NUMPY\x01\x00"s;
  io::store(bytes, static_cast<std::uint16_t>(header.size()));
  return bytes + header + elements;
}

std::string header(const std::string& descr, const std::string& order, const std::string& shape) {
  return "{'descr': '" + descr + "', 'fortran_order': " + order + ", 'shape': " + shape + ", }\n";
}

template <class T>
std::string bytes_of(const std::vector<T>& values, std::endian order = std::endian::little) {
  std::string bytes;
  for (const T value : values) io::store(bytes, value, order);
  return bytes;
}

std::string error_of(const std::string& bytes) {
  try {
    static_cast<void>(io::parse_npy(bytes, "a.npy"));
  } catch (const format_error& e) {
    return e.what();
  }
  return "no error";
}

}  // namespace

TEST_CASE("half-precision numbers become floats without loss") {
  CHECK(io::float_from_half(0x3c00) == 1.0f);
  CHECK(io::float_from_half(0xc000) == -2.0f);
  CHECK(io::float_from_half(0x7bff) == 65504.0f);
  CHECK(io::float_from_half(0x0001) == 0x1p-24f);
  CHECK(io::float_from_half(0x8000) == 0.0f);
  CHECK(std::signbit(io::float_from_half(0x8000)));
  CHECK(io::float_from_half(0x7c00) == std::numeric_limits<float>::infinity());
  CHECK(std::isnan(io::float_from_half(0x7e00)));
}

TEST_CASE_TEMPLATE("every element type is read in both byte orders",
                   T,
                   std::int8_t,
                   std::int16_t,
                   std::int32_t,
                   std::int64_t,
                   std::uint8_t,
                   std::uint16_t,
                   std::uint32_t,
                   std::uint64_t,
                   float,
                   double) {
  const std::vector<T> values{T{1}, T{2}, std::numeric_limits<T>::max()};
  const std::string type(name(io::dtype_of<T>()));
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    const std::string mark = sizeof(T) == 1 ? "|" : order == std::endian::big ? ">" : "<";
    const io::array a =
        io::parse_npy(npy(header(mark + type, "False", "(3,)"), bytes_of(values, order)), "a.npy");
    CHECK(a.type == io::dtype_of<T>());
    CHECK(a.values<double>() == std::vector<double>{1, 2, static_cast<double>(values[2])});
    CHECK(a[2] == static_cast<double>(values[2]));
  }
}

TEST_CASE("booleans and halves are numbers") {
  const io::array flags = io::parse_npy(npy(header("|b1", "False", "(3,)"), "\x00\x01\x01"s), "a");
  CHECK(flags.values<float>() == std::vector<float>{0, 1, 1});
  const io::array halves = io::parse_npy(
      npy(header("<f2", "False", "(2,)"), bytes_of(std::vector<std::uint16_t>{0x3c00, 0xb800})),
      "a");
  CHECK(halves.values<float>() == std::vector<float>{1, -0.5});
}

TEST_CASE("Fortran order becomes C order") {
  // Columns of [[1, 2, 3], [4, 5, 6]] one after another.
  const auto columns = bytes_of(std::vector<float>{1, 4, 2, 5, 3, 6});
  const io::array a = io::parse_npy(npy(header("<f4", "True", "(2, 3)"), columns), "a.npy");
  CHECK(a.shape == std::vector<std::size_t>{2, 3});
  CHECK(a.values<float>() == std::vector<float>{1, 2, 3, 4, 5, 6});
}

TEST_CASE("a sub-array is what the first index leaves") {
  const std::vector<int> values{1, 2, 3, 4, 5, 6};
  const io::array a = io::make_array<int>({3, 2}, values);
  CHECK(a.at(1).shape == std::vector<std::size_t>{2});
  CHECK(a.at(1).values<double>() == std::vector<double>{3, 4});
  CHECK(a.at(1).at(1)[0] == 4);
  CHECK_THROWS_WITH_AS(a.at(3), "array: no element 3 on the first axis of (3, 2)", argument_error);
  CHECK_THROWS_WITH_AS(a.at(1).at(0).at(0), "array: no element 0 on the first axis of ()",
                       argument_error);
}

TEST_CASE("an array needs as many values as its shape says") {
  const std::vector<float> values{1, 2, 3};
  CHECK_THROWS_WITH_AS(io::make_array<float>({2, 2}, values),
                       "make_array: 3 values for shape (2, 2)", argument_error);
}

TEST_CASE("a single number has no axis, an empty array no element") {
  CHECK(io::parse_npy(npy(header("<f8", "False", "()"), bytes_of<double>({3.25})), "a")[0] == 3.25);
  CHECK(io::parse_npy(npy(header("<f8", "False", "(0, 3)"), ""), "a").size() == 0);
}

TEST_CASE("arrays come back as they were written") {
  const support::scratch scratch;
  const std::vector<double> values{1, -0.5, 1e300, std::numeric_limits<double>::infinity()};
  const io::array a = io::make_array<double>({2, 1, 2}, values);
  const auto path = scratch.folder() / "a.npy";
  io::write_npy(path, a);
  const io::array b = io::read_npy(path);
  CHECK(b.type == a.type);
  CHECK(b.shape == a.shape);
  CHECK(b.bytes == a.bytes);
  CHECK(io::npy_bytes(a).find('\n') % 64 == 63);  // elements begin at a multiple of 64
}

TEST_CASE("headers of later versions and other writers are understood") {
  std::string text = header("<f4", "False", "(1,)");
  std::string version_2 = "\x93NUMPY\x02\x00"s;
  io::store(version_2, static_cast<std::uint32_t>(text.size()));
  CHECK(io::parse_npy(version_2 + text + bytes_of<float>({7}), "a")[0] == 7);
  const std::string reordered = "{\"shape\":(1L,),\"fortran_order\":False,\"descr\":\"<f4\"}";
  CHECK(io::parse_npy(npy(reordered, bytes_of<float>({7})), "a")[0] == 7);
}

TEST_CASE("what is not an array of numbers is refused in a sentence") {
  const std::string elements(24, '\0');
  CHECK(error_of("") == "a.npy: byte 0: npy: not an NPY file: it does not begin with \\x93NUMPY");
  CHECK(error_of("\x93NUMPY\x09\x00\x01\x00"s) ==
        "a.npy: byte 8: npy: version 1, 2 or 3 expected, found 9");
  CHECK(error_of(npy(header("|O", "False", "(3,)"), elements)) ==
        "a.npy: byte 24: npy: header: the elements are pickled Python objects, which are never "
        "loaded");
  CHECK(error_of(npy(header("<c16", "False", "(1,)"), elements)) ==
        "a.npy: byte 26: npy: header: element type '<c16' is not supported; bool, integers and "
        "floats of 1 to 8 bytes are");
  CHECK(
      error_of(npy("{'descr': [('x', '<f4')], 'fortran_order': False, 'shape': (3,)}", "")) ==
      "a.npy: byte 20: npy: header: structured elements are not supported; save the fields apart");
  CHECK(error_of(npy("{'descr': '<f4', 'shape': (3,)}", elements)) ==
        "a.npy: byte 41: npy: header: the keys descr, fortran_order and shape expected");
  CHECK(error_of(npy("{'descr': '<f4', 'descr': '<f8'}", "")) ==
        "a.npy: byte 35: npy: header: the key descr comes twice");
  CHECK(error_of(npy(header("<f4", "0", "(3,)"), elements)) ==
        "a.npy: byte 44: npy: header: fortran_order: True or False expected");
  CHECK(error_of(npy(header("<f4", "False", "(-3,)"), elements)) ==
        "a.npy: byte 61: npy: header: shape: a whole number expected");
  CHECK(error_of(npy(header("<f4", "False", "(7,)"), elements)) ==
        "a.npy: byte 68: npy: (7,) elements of type f4 do not fit in the 24 bytes left");
  CHECK(error_of(npy(header("<f4", "False", "(4294967296, 4294967296, 2)"), elements)) ==
        "a.npy: byte 91: npy: (4294967296, 4294967296, 2) elements of type f4 do not fit in the "
        "24 bytes left");
}

}  // namespace test_npy
