// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/io/bytes.hpp>
#include <aib/io/file.hpp>
#include <aib/io/half.hpp>
#include <aib/io/text.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace aib::io {

/// Element types of arrays, with NumPy's names: kind and bytes.
enum class dtype { b1, i1, i2, i4, i8, u1, u2, u4, u8, f2, f4, f8 };

/// "f4" and the like.
[[nodiscard]] std::string_view name(dtype type);

/// Bytes of an element.
[[nodiscard]] std::size_t size_of(dtype type);

/// The type that holds T: bool, the integers and floats of 1 to 8 bytes.
template <class T>
[[nodiscard]] constexpr dtype dtype_of();

/// A dense array of numbers of any shape. The elements lie in C order (last index fastest) and in
/// the machine's byte order, whatever the file had.
struct array {
  dtype type = dtype::f8;
  std::vector<std::size_t> shape = {};  ///< empty: a single number
  std::string bytes = {};               ///< size() * size_of(type)

  [[nodiscard]] std::size_t size() const;
  /// The sub-array at an index of the first axis: `a[index]`. Throws argument_error if there is
  /// none.
  [[nodiscard]] array at(std::size_t index) const;
  /// Element `i` in C order, as a double. Integers beyond 2^53 are rounded.
  [[nodiscard]] double operator[](std::size_t i) const;
  /// All elements in C order, as float or double.
  template <std::floating_point Scalar>
  [[nodiscard]] std::vector<Scalar> values() const;
};

/// The shape as NumPy prints it: "(8, 5)", "(3,)", "()".
[[nodiscard]] std::string text_of_shape(std::span<const std::size_t> shape);

/// An array of the given shape over a copy of `values`. Throws argument_error where their number
/// is another.
template <class T>
[[nodiscard]] array make_array(std::vector<std::size_t> shape, std::span<const T> values);

/// An NPY file: versions 1 to 3, both byte orders, C and Fortran order, bool, integers and floats
/// of 1 to 8 bytes. Bytes after the elements are ignored, as NumPy does.
///
/// Throws format_error for pickled objects, structures, complex numbers, strings and long doubles,
/// and where the file is shorter than its shape.
/// Source: NumPy Enhancement Proposal 1, and numpy.lib.format of NumPy 2.
[[nodiscard]] array read_npy(const std::filesystem::path& path);

/// The same from bytes in memory; `path` names them in errors.
[[nodiscard]] array parse_npy(std::string bytes, const std::filesystem::path& path);

/// What NumPy writes for an array: version 1, C order, little endian, elements from a multiple of
/// 64 bytes on.
[[nodiscard]] std::string npy_bytes(const array& a);

void write_npy(const std::filesystem::path& path, const array& a);

namespace detail {

struct dtype_info {
  std::string_view name;
  std::size_t bytes;
};

inline constexpr std::array<dtype_info, 12> dtypes{{{"b1", 1},
                                                    {"i1", 1},
                                                    {"i2", 2},
                                                    {"i4", 4},
                                                    {"i8", 8},
                                                    {"u1", 1},
                                                    {"u2", 2},
                                                    {"u4", 4},
                                                    {"u8", 8},
                                                    {"f2", 2},
                                                    {"f4", 4},
                                                    {"f8", 8}}};

/// What the header of an NPY file says.
struct npy_header {
  dtype type = dtype::f8;
  std::endian order = std::endian::little;
  bool fortran = false;
  std::vector<std::size_t> shape;
  std::size_t begin = 0;  ///< byte of the first element
};

/// Reads the header's Python dictionary: no more of the language than NumPy writes there.
class npy_dictionary {
 public:
  npy_dictionary(std::string_view text, std::size_t at_byte, const std::filesystem::path& path)
      : text_(text), offset_(at_byte), path_(path) {}

  npy_header read() {
    expect('{');
    while (!accept('}')) {
      const std::string_view key = quoted();
      expect(':');
      value(key);
      if (!accept(',') && peek() != '}') fail("',' or '}' expected");
    }
    skip_blanks();
    if (at_ < text_.size()) fail("text after the dictionary");
    if (!seen_type_ || !seen_order_ || !seen_shape_)
      fail("the keys descr, fortran_order and shape expected");
    return std::move(header_);
  }

 private:
  void value(std::string_view key) {
    if (key == "descr") {
      once(seen_type_, key);
      type();
    } else if (key == "fortran_order") {
      once(seen_order_, key);
      header_.fortran = boolean();
    } else if (key == "shape") {
      once(seen_shape_, key);
      shape();
    } else {
      fail(message("unknown key '", key, "'"));
    }
  }

  void once(bool& seen, std::string_view key) const {
    if (std::exchange(seen, true)) fail(message("the key ", key, " comes twice"));
  }

  void type() {
    if (peek() == '[') fail("structured elements are not supported; save the fields apart");
    const std::string_view descr = quoted();
    const std::string_view type = descr.size() > 1 ? descr.substr(1) : descr;
    if (type.starts_with('O'))
      fail("the elements are pickled Python objects, which are never loaded");
    const auto known = std::find_if(dtypes.begin(), dtypes.end(),
                                    [&](const dtype_info& info) { return info.name == type; });
    const char order = descr.empty() ? '\0' : descr.front();
    const bool ordered = order == '<' || order == '>' || order == '=';
    if (known == dtypes.end() || !(ordered || (order == '|' && known->bytes == 1))) {
      fail(message("element type '", descr,
                   "' is not supported; bool, integers and floats of 1 to 8 bytes are"));
    }
    header_.type = static_cast<dtype>(known - dtypes.begin());
    if (order == '>') header_.order = std::endian::big;
    if (order == '=') header_.order = std::endian::native;
  }

  bool boolean() {
    if (accept_word("True")) return true;
    if (accept_word("False")) return false;
    fail("fortran_order: True or False expected");
  }

  void shape() {
    constexpr std::size_t max_axes = 32;
    expect('(');
    while (!accept(')')) {
      skip_blanks();
      const std::size_t end = std::min(text_.find_first_not_of("0123456789", at_), text_.size());
      const auto extent = parse<std::size_t>(text_.substr(at_, end - at_));
      if (!extent) fail("shape: a whole number expected");
      at_ = end;
      accept('L');  // Python 2 wrote long integers so
      header_.shape.push_back(*extent);
      if (header_.shape.size() > max_axes) fail("shape: more than 32 axes");
      if (!accept(',') && peek() != ')') fail("shape: ',' or ')' expected");
    }
  }

  std::string_view quoted() {
    const char quote = peek();
    if (quote != '\'' && quote != '"') fail("a quoted name expected");
    const std::size_t end = text_.find(quote, at_ + 1);
    if (end == std::string_view::npos) fail("a quoted name without an end");
    const std::string_view content = text_.substr(at_ + 1, end - at_ - 1);
    at_ = end + 1;
    return content;
  }

  void skip_blanks() { at_ = std::min(text_.find_first_not_of(" \t\r\n", at_), text_.size()); }
  char peek() {
    skip_blanks();
    return at_ < text_.size() ? text_[at_] : '\0';
  }
  bool accept(char c) {
    if (peek() != c || at_ == text_.size()) return false;
    ++at_;
    return true;
  }
  bool accept_word(std::string_view word) {
    skip_blanks();
    if (!text_.substr(at_).starts_with(word)) return false;
    at_ += word.size();
    return true;
  }
  void expect(char c) {
    if (!accept(c)) fail(message("'", c, "' expected"));
  }
  [[noreturn]] void fail(std::string_view what) const {
    throw format_error(path_, at_byte{offset_ + at_}, message("npy: header: ", what));
  }

  std::string_view text_;
  std::size_t offset_;
  const std::filesystem::path& path_;
  std::size_t at_ = 0;
  npy_header header_;
  bool seen_type_ = false;
  bool seen_order_ = false;
  bool seen_shape_ = false;
};

/// Number of elements; nothing where it does not fit in memory's arithmetic.
inline std::optional<std::size_t> element_count(std::span<const std::size_t> shape) {
  constexpr std::size_t limit = std::numeric_limits<std::size_t>::max() / 16;
  std::size_t count = 1;
  bool empty = false;
  for (const std::size_t extent : shape) {
    empty |= extent == 0;
    if (extent > limit / count) return std::nullopt;
    count *= std::max<std::size_t>(extent, 1);
  }
  return empty ? 0 : count;
}

/// The bytes before the header's text: magic, version and its length.
struct npy_preamble {
  std::size_t text_begin;
  std::size_t text_size;
};

inline npy_preamble read_npy_preamble(std::string_view bytes, const std::filesystem::path& path) {
  byte_reader in(bytes, path);
  if (in.take(std::min<std::size_t>(6, bytes.size()), "npy: magic") != "\x93NUMPY")
    throw format_error(path, at_byte{0}, "npy: not an NPY file: it does not begin with \\x93NUMPY");
  const auto version = in.read<std::uint8_t>("npy: version");
  in.read<std::uint8_t>("npy: version");
  if (version < 1 || version > 3)
    in.fail(message("npy: version 1, 2 or 3 expected, found ", unsigned{version}));
  const std::size_t size = version == 1 ? in.read<std::uint16_t>("npy: header length")
                                        : in.read<std::uint32_t>("npy: header length");
  return {in.position(), size};
}

/// The header from the first bytes of a file that holds `file_size`.
/// Refuses a shape that the file cannot hold.
inline npy_header read_npy_header(std::string_view bytes,
                                  std::uint64_t file_size,
                                  const std::filesystem::path& path) {
  const npy_preamble preamble = read_npy_preamble(bytes, path);
  byte_reader in(bytes, path);
  in.take(preamble.text_begin, "npy: magic");
  const std::string_view text = in.take(preamble.text_size, "npy: header");
  npy_header header = npy_dictionary(text, preamble.text_begin, path).read();
  header.begin = in.position();
  const std::uint64_t left = file_size - header.begin;
  const auto count = element_count(header.shape);
  if (!count || *count > left / size_of(header.type)) {
    in.fail(message("npy: ", text_of_shape(header.shape), " elements of type ", name(header.type),
                    " do not fit in the ", left, " bytes left"));
  }
  return header;
}

inline void reverse_elements(std::string& bytes, std::size_t element) {
  for (std::size_t i = 0; i + element <= bytes.size(); i += element)
    std::reverse(bytes.data() + i, bytes.data() + i + element);
}

/// The elements of a Fortran-ordered array in C order.
inline std::string c_ordered(const std::string& bytes,
                             std::span<const std::size_t> shape,
                             std::size_t element) {
  std::vector<std::size_t> stride(shape.size());
  std::size_t step = element;
  for (std::size_t axis = 0; axis < shape.size(); ++axis) {
    stride[axis] = step;
    step *= shape[axis];
  }
  std::string out(bytes.size(), '\0');
  std::vector<std::size_t> index(shape.size(), 0);
  std::size_t from = 0;
  for (std::size_t to = 0; to < out.size(); to += element) {
    std::memcpy(out.data() + to, bytes.data() + from, element);
    for (std::size_t axis = shape.size(); axis-- > 0;) {
      from += stride[axis];
      if (++index[axis] < shape[axis]) break;
      from -= stride[axis] * shape[axis];
      index[axis] = 0;
    }
  }
  return out;
}

inline array make_array(npy_header header, std::string bytes) {
  const std::size_t element = size_of(header.type);
  if (header.order != std::endian::native) reverse_elements(bytes, element);
  if (header.fortran && header.shape.size() > 1) bytes = c_ordered(bytes, header.shape, element);
  return {header.type, std::move(header.shape), std::move(bytes)};
}

template <class T>
double load_native(const char* from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  return static_cast<double>(value);
}

inline double load_half(const char* from) {
  std::uint16_t bits;
  std::memcpy(&bits, from, sizeof bits);
  return static_cast<double>(float_from_half(bits));
}

inline double load_boolean(const char* from) { return *from != 0 ? 1 : 0; }

/// The function that reads an element of a type.
inline double (*loader(dtype type))(const char*) {
  switch (type) {
    case dtype::b1:
      return load_boolean;
    case dtype::i1:
      return load_native<std::int8_t>;
    case dtype::i2:
      return load_native<std::int16_t>;
    case dtype::i4:
      return load_native<std::int32_t>;
    case dtype::i8:
      return load_native<std::int64_t>;
    case dtype::u1:
      return load_native<std::uint8_t>;
    case dtype::u2:
      return load_native<std::uint16_t>;
    case dtype::u4:
      return load_native<std::uint32_t>;
    case dtype::u8:
      return load_native<std::uint64_t>;
    case dtype::f2:
      return load_half;
    case dtype::f4:
      return load_native<float>;
    case dtype::f8:
      break;
  }
  return load_native<double>;
}

}  // namespace detail

inline std::string_view name(dtype type) {
  return detail::dtypes[static_cast<std::size_t>(type)].name;
}

inline std::size_t size_of(dtype type) {
  return detail::dtypes[static_cast<std::size_t>(type)].bytes;
}

template <class T>
constexpr dtype dtype_of() {
  static_assert(std::is_arithmetic_v<T> && sizeof(T) <= 8, "no element type of arrays");
  if constexpr (std::is_same_v<T, bool>) return dtype::b1;
  if constexpr (std::is_floating_point_v<T>) return sizeof(T) == 4 ? dtype::f4 : dtype::f8;
  const int power = std::countr_zero(sizeof(T));
  return static_cast<dtype>(static_cast<int>(std::is_signed_v<T> ? dtype::i1 : dtype::u1) + power);
}

inline std::size_t array::size() const { return detail::element_count(shape).value_or(0); }

inline array array::at(std::size_t index) const {
  if (shape.empty() || index >= shape.front()) {
    throw argument_error(
        message("array: no element ", index, " on the first axis of ", text_of_shape(shape)));
  }
  const std::size_t n = bytes.size() / shape.front();
  return {type, {shape.begin() + 1, shape.end()}, bytes.substr(index * n, n)};
}

inline double array::operator[](std::size_t i) const {
  return detail::loader(type)(bytes.data() + i * size_of(type));
}

template <std::floating_point Scalar>
std::vector<Scalar> array::values() const {
  std::vector<Scalar> out(size());
  if (type == dtype_of<Scalar>()) {
    if (!out.empty()) std::memcpy(out.data(), bytes.data(), bytes.size());
    return out;
  }
  const auto load = detail::loader(type);
  const std::size_t element = size_of(type);
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = static_cast<Scalar>(load(bytes.data() + i * element));
  return out;
}

inline std::string text_of_shape(std::span<const std::size_t> shape) {
  std::string text = "(";
  for (std::size_t i = 0; i < shape.size(); ++i)
    text += message(shape[i], i + 1 < shape.size() ? ", " : "");
  return text + (shape.size() == 1 ? ",)" : ")");
}

template <class T>
array make_array(std::vector<std::size_t> shape, std::span<const T> values) {
  array a{dtype_of<std::remove_const_t<T>>(), std::move(shape), {}};
  if (detail::element_count(a.shape) != values.size()) {
    throw argument_error(
        message("make_array: ", values.size(), " values for shape ", text_of_shape(a.shape)));
  }
  a.bytes.assign(reinterpret_cast<const char*>(values.data()), values.size_bytes());
  return a;
}

inline array read_npy(const std::filesystem::path& path) {
  const input_file file(path);
  const detail::npy_preamble preamble = detail::read_npy_preamble(file.begin(12), path);
  detail::npy_header header = detail::read_npy_header(
      file.begin(preamble.text_begin + preamble.text_size), file.size(), path);
  std::string elements(*detail::element_count(header.shape) * size_of(header.type), '\0');
  file.read_at(header.begin, elements.data(), elements.size());
  return detail::make_array(std::move(header), std::move(elements));
}

inline array parse_npy(std::string bytes, const std::filesystem::path& path) {
  detail::npy_header header = detail::read_npy_header(bytes, bytes.size(), path);
  bytes.erase(0, header.begin);
  bytes.resize(*detail::element_count(header.shape) * size_of(header.type));
  return detail::make_array(std::move(header), std::move(bytes));
}

inline std::string npy_bytes(const array& a) {
  std::string text = message("{'descr': '", size_of(a.type) == 1 ? '|' : '<', name(a.type),
                             "', 'fortran_order': False, 'shape': ", text_of_shape(a.shape), ", }");
  text.append(63 - (10 + text.size()) % 64, ' ');
  text += '\n';
  std::string bytes("\x93NUMPY\x01\x00", 8);
  store(bytes, static_cast<std::uint16_t>(text.size()));
  std::string elements = a.bytes;
  if (std::endian::native != std::endian::little)
    detail::reverse_elements(elements, size_of(a.type));
  return bytes + text + elements;
}

inline void write_npy(const std::filesystem::path& path, const array& a) {
  write_file(path, npy_bytes(a));
}

}  // namespace aib::io
