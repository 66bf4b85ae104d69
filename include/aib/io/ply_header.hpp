// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/io/file.hpp>
#include <aib/io/text.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace aib::io {

enum class ply_format { ascii, binary_little_endian, binary_big_endian };

enum class ply_type : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// Calls `body(std::type_identity<T>{})` with the C++ type.
template <class Body>
decltype(auto) with_type(ply_type type, Body&& body) {
  switch (type) {
    case ply_type::int8:
      return body(std::type_identity<std::int8_t>{});
    case ply_type::uint8:
      return body(std::type_identity<std::uint8_t>{});
    case ply_type::int16:
      return body(std::type_identity<std::int16_t>{});
    case ply_type::uint16:
      return body(std::type_identity<std::uint16_t>{});
    case ply_type::int32:
      return body(std::type_identity<std::int32_t>{});
    case ply_type::uint32:
      return body(std::type_identity<std::uint32_t>{});
    case ply_type::float32:
      return body(std::type_identity<float>{});
    default:
      return body(std::type_identity<double>{});
  }
}

[[nodiscard]] constexpr std::size_t size_of(ply_type type) {
  constexpr std::array<std::size_t, 8> sizes{1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[static_cast<std::size_t>(type)];
}

/// A column of an element: one number a row, or a list of them.
struct ply_property {
  std::string name;
  ply_type type;
  std::optional<ply_type> list_count = {};  ///< type of the count, where the property is a list
};

/// A table of the file: rows of equal properties.
struct ply_element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<ply_property> properties = {};

  [[nodiscard]] bool has_list() const {
    return std::any_of(properties.begin(), properties.end(),
                       [](const ply_property& p) { return p.list_count.has_value(); });
  }

  /// Bytes of a binary row; where the element has lists, those of a row of empty lists.
  [[nodiscard]] std::size_t row_bytes() const {
    std::size_t n = 0;
    for (const ply_property& p : properties) n += size_of(p.list_count.value_or(p.type));
    return n;
  }

  /// Index of a property, nothing where there is none of this name.
  [[nodiscard]] std::optional<std::size_t> find(std::string_view property) const {
    for (std::size_t i = 0; i < properties.size(); ++i) {
      if (properties[i].name == property) return i;
    }
    return std::nullopt;
  }
};

/// What stands before the data of a PLY file.
struct ply_header {
  ply_format format = ply_format::ascii;
  std::vector<ply_element> elements = {};
  std::vector<std::string> comments = {};
  std::uint64_t data_offset = 0;
  std::size_t lines = 0;

  [[nodiscard]] const ply_element* find(std::string_view element) const {
    for (const ply_element& e : elements) {
      if (e.name == element) return &e;
    }
    return nullptr;
  }
};

/// Reads the header of a PLY file; LF and CRLF line ends. Throws format_error where it is damaged,
/// longer than a megabyte, or announces more rows than the file can hold.
ply_header read_ply_header(const input_file& file);

namespace detail {

inline std::optional<ply_type> find_ply_type(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, ply_type>, 16> types{{
      {"char", ply_type::int8},
      {"int8", ply_type::int8},
      {"uchar", ply_type::uint8},
      {"uint8", ply_type::uint8},
      {"short", ply_type::int16},
      {"int16", ply_type::int16},
      {"ushort", ply_type::uint16},
      {"uint16", ply_type::uint16},
      {"int", ply_type::int32},
      {"int32", ply_type::int32},
      {"uint", ply_type::uint32},
      {"uint32", ply_type::uint32},
      {"float", ply_type::float32},
      {"float32", ply_type::float32},
      {"double", ply_type::float64},
      {"float64", ply_type::float64},
  }};
  for (const auto& [known, type] : types) {
    if (known == name) return type;
  }
  return std::nullopt;
}

/// The lines of the header one by one.
class ply_header_parser {
 public:
  explicit ply_header_parser(const input_file& file) : file_(file) { load_text(); }

  ply_header parse() {
    if (file_.size() == 0) throw format_error(file_.path(), "ply: the file is empty");
    if (!next() || trim(line_) != "ply") fail("ply: the first line must be \"ply\"");
    bool has_format = false;
    while (next()) {
      split(line_, fields_);
      if (fields_.empty() || fields_[0] == "obj_info") continue;
      if (fields_[0] == "comment") {
        header_.comments.emplace_back(trim(line_.substr(line_.find("comment") + 7)));
      } else if (fields_[0] == "format") {
        parse_format();
        has_format = true;
      } else if (fields_[0] == "element") {
        parse_element();
      } else if (fields_[0] == "property") {
        parse_property();
      } else if (fields_[0] == "end_header") {
        if (!has_format) fail("ply: no format line in the header");
        header_.data_offset = at_;
        header_.lines = number_;
        check_sizes();
        return std::move(header_);
      } else {
        fail(message("ply: format, element, property, comment or end_header expected, found \"",
                     fields_[0].substr(0, 40), "\""));
      }
    }
    fail(message("ply: no end_header in the first ", text_.size(), " bytes"));
  }

 private:
  static constexpr std::size_t max_header = std::size_t{1} << 20;

  void load_text() {
    text_ = file_.begin(4096);
    while (text_.find("end_header") == std::string::npos && text_.size() < max_header &&
           text_.size() < file_.size() && text_.starts_with("ply"))
      text_ = file_.begin(std::min(max_header, 4 * text_.size()));
  }

  bool next() {
    const std::size_t end = text_.find('\n', at_);
    if (end == std::string::npos) return false;
    line_ = std::string_view(text_).substr(at_, end - at_);
    if (line_.ends_with('\r')) line_.remove_suffix(1);
    at_ = end + 1;
    ++number_;
    return true;
  }

  void parse_format() {
    const std::string_view name = fields_.size() > 1 ? fields_[1] : "";
    if (name == "ascii") {
      header_.format = ply_format::ascii;
    } else if (name == "binary_little_endian") {
      header_.format = ply_format::binary_little_endian;
    } else if (name == "binary_big_endian") {
      header_.format = ply_format::binary_big_endian;
    } else {
      fail(
          message("ply: format ascii, binary_little_endian or binary_big_endian expected, found \"",
                  name.substr(0, 40), "\""));
    }
  }

  void parse_element() {
    if (fields_.size() != 3) fail("ply: expected \"element NAME COUNT\"");
    const auto count = io::parse<std::uint64_t>(fields_[2]);
    if (!count) {
      fail(message("ply: count of element ", fields_[1].substr(0, 40), " expected, found \"",
                   fields_[2].substr(0, 40), "\""));
    }
    header_.elements.push_back({std::string(fields_[1]), *count});
  }

  void parse_property() {
    if (header_.elements.empty()) fail("ply: property before the first element");
    ply_property property;
    if (fields_.size() == 5 && fields_[1] == "list") {
      property = {std::string(fields_[4]), type_named(fields_[3]), type_named(fields_[2])};
      if (*property.list_count >= ply_type::float32)
        fail("ply: the count of a list must be an integer type");
    } else if (fields_.size() == 3) {
      property = {std::string(fields_[2]), type_named(fields_[1])};
    } else {
      fail("ply: expected \"property TYPE NAME\" or \"property list TYPE TYPE NAME\"");
    }
    header_.elements.back().properties.push_back(std::move(property));
  }

  ply_type type_named(std::string_view name) const {
    if (const auto type = find_ply_type(name)) return *type;
    fail(message("ply: unknown type \"", name.substr(0, 40), "\""));
  }

  void check_sizes() const {
    const bool ascii = header_.format == ply_format::ascii;
    // An ascii number takes a digit and a blank; the last line may lack its end.
    std::uint64_t left = file_.size() - header_.data_offset + (ascii ? 1 : 0);
    for (const ply_element& e : header_.elements) {
      const std::uint64_t row = ascii ? 2 * e.properties.size() : e.row_bytes();
      if (row == 0) continue;
      if (e.count > left / row) {
        throw format_error(
            file_.path(), message("ply: element ", e.name, ": ", e.count, " rows of at least ", row,
                                  " bytes expected, the file has ", left, " bytes for them"));
      }
      left -= e.count * row;
    }
  }

  [[noreturn]] void fail(std::string_view what) const {
    throw format_error(file_.path(), at_line{number_}, what);
  }

  const input_file& file_;
  std::string text_;
  std::size_t at_ = 0;
  std::string_view line_;
  std::size_t number_ = 0;
  std::vector<std::string_view> fields_;
  ply_header header_;
};

}  // namespace detail

inline ply_header read_ply_header(const input_file& file) {
  return detail::ply_header_parser(file).parse();
}

}  // namespace aib::io
