// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/io/byte_stream.hpp>
#include <aib/io/bytes.hpp>
#include <aib/io/file.hpp>
#include <aib/io/numbers.hpp>
#include <aib/io/ply_header.hpp>
#include <aib/io/text.hpp>

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace aib::io::detail {

/// A row of an element as numbers.
struct ply_row {
  std::vector<double> values;  ///< one a property; of a list its length
  std::vector<double> list;    ///< items of the list that was asked for
};

inline constexpr std::size_t no_list = ~std::size_t{0};

/// The data of a PLY file, element by element in file order.
class ply_data {
 public:
  virtual ~ply_data() = default;
  virtual void read_row(const ply_element& element, std::size_t wanted_list, ply_row& row) = 0;
  virtual void skip(const ply_element& element) = 0;
  /// The bytes that come next, where the data are binary.
  virtual byte_stream* stream() { return nullptr; }
  /// An error at the place where the data were last read.
  [[nodiscard]] virtual format_error error(std::string_view what) const = 0;
};

class ply_binary_data : public ply_data {
 public:
  ply_binary_data(const input_file& file, std::uint64_t offset, std::endian order)
      : path_(file.path()), stream_(file, offset), order_(order) {}

  void read_row(const ply_element& element, std::size_t wanted_list, ply_row& row) override {
    row.values.clear();
    row.list.clear();
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      const ply_property& p = element.properties[i];
      row.values.push_back(take(p.list_count.value_or(p.type), p));
      if (p.list_count) read_list(p, i == wanted_list, row);
    }
  }

  void skip(const ply_element& element) override {
    if (!element.has_list()) {
      stream_.skip(element.count * element.row_bytes(), element.name);
      return;
    }
    ply_row row;
    for (std::uint64_t i = 0; i < element.count; ++i) read_row(element, no_list, row);
  }

  byte_stream* stream() override { return &stream_; }
  [[nodiscard]] format_error error(std::string_view what) const override {
    return format_error(path_, at_byte{stream_.offset()}, what);
  }

 private:
  double number(ply_type type, const char* from) const {
    return with_type(type, [&]<class T>(std::type_identity<T>) {
      return static_cast<double>(load<T>(from, order_));
    });
  }

  double take(ply_type type, const ply_property& p) {
    return number(type, stream_.take(size_of(type), p.name));
  }

  void read_list(const ply_property& p, bool wanted, ply_row& row) {
    const double count = row.values.back();
    if (count < 0) throw error(message("ply: list ", p.name, " of ", count, " items"));
    const auto n = static_cast<std::size_t>(count);
    const char* items = stream_.take(n * size_of(p.type), p.name);
    if (!wanted) return;
    for (std::size_t k = 0; k < n; ++k)
      row.list.push_back(number(p.type, items + k * size_of(p.type)));
  }

  std::filesystem::path path_;
  byte_stream stream_;
  std::endian order_;
};

/// A row is a line; blank lines between rows are passed over.
class ply_ascii_data : public ply_data {
 public:
  ply_ascii_data(const input_file& file, std::size_t header_lines)
      : path_(file.path()), text_(read_file(path_)), lines_(text_, path_) {
    for (std::size_t i = 0; i < header_lines; ++i) lines_.next();
  }

  void read_row(const ply_element& element, std::size_t wanted_list, ply_row& row) override {
    row.values.clear();
    row.list.clear();
    do {
      if (!lines_.next()) throw error(message("ply: the file ends within element ", element.name));
      rest_ = trim(lines_.line());
    } while (rest_.empty());
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      const ply_property& p = element.properties[i];
      row.values.push_back(take(p));
      if (p.list_count) read_list(p, i == wanted_list, row);
    }
    if (rest_.empty()) return;
    throw error(message("ply: ", element.name, " has ", element.properties.size(),
                        " properties, the line goes on with \"", trim(rest_).substr(0, 40), "\""));
  }

  void skip(const ply_element& element) override {
    if (element.properties.empty()) return;
    ply_row row;
    for (std::uint64_t i = 0; i < element.count; ++i) read_row(element, no_list, row);
  }

  [[nodiscard]] format_error error(std::string_view what) const override {
    return format_error(path_, at_line{lines_.number()}, what);
  }

 private:
  double take(const ply_property& p) {
    if (const auto value = take_number(rest_)) return *value;
    if (rest_.empty()) throw error(message("ply: the line ends where ", p.name, " is expected"));
    throw error(message("ply: a number expected for ", p.name, ", found \"",
                        trim(rest_).substr(0, 40), "\""));
  }

  void read_list(const ply_property& p, bool wanted, ply_row& row) {
    const double count = row.values.back();
    if (!(count >= 0) || count != std::floor(count))
      throw error(message("ply: list ", p.name, " of ", count, " items"));
    for (double k = 0; k < count; ++k) {
      const double item = take(p);
      if (wanted) row.list.push_back(item);
    }
  }

  std::filesystem::path path_;
  std::string text_;
  line_reader lines_;
  std::string_view rest_;
};

inline std::endian byte_order(ply_format format) {
  return format == ply_format::binary_big_endian ? std::endian::big : std::endian::little;
}

inline std::unique_ptr<ply_data> open_ply_data(const input_file& file, const ply_header& header) {
  if (header.format == ply_format::ascii)
    return std::make_unique<ply_ascii_data>(file, header.lines);
  return std::make_unique<ply_binary_data>(file, header.data_offset, byte_order(header.format));
}

}  // namespace aib::io::detail
