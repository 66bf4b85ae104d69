// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/cloud.hpp>
#include <aib/core/error.hpp>
#include <aib/io/file.hpp>
#include <aib/io/numbers.hpp>
#include <aib/io/positions.hpp>
#include <aib/io/text.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace aib::io {

/// Reads points from text, one a line: XYZ, CSV, PTS, ASC. Numbers are parted by blanks, commas or
/// semicolons; lines that begin with # or // are comments; a first line of names is understood
/// (x y z, nx ny nz, r g b or red green blue); a first line with one number is the count of PTS.
///
/// Without names the columns behind x y z are: one of intensity (passed over), then three that are
/// colours where all of them are whole numbers 0..255 and normals where they are of length 1, then
/// three of the other kind. What is neither is passed over with a warning.
///
/// Throws format_error where a row has another number of columns than the first, or less than 3.
cloud::cloud read_xyz(const std::filesystem::path& path);

namespace detail {

/// A table of numbers in a text file.
class xyz_table {
 public:
  explicit xyz_table(const std::filesystem::path& path)
      : path_(path), text_(read_file(path)), lines_(text_, path) {
    while (lines_.next()) {
      const std::string_view line = trim(lines_.line());
      if (line.empty()) continue;
      if (line.front() == '#' || line.starts_with("//")) {
        if (columns_ == 0)
          read_names(line.substr(std::min(line.find_first_not_of("#/"), line.size())));
        continue;
      }
      read_row(line);
    }
    if (announced_ && *announced_ != static_cast<double>(rows()))
      lines_.fail(message("xyz: ", *announced_, " points announced, found ", rows()));
  }

  [[nodiscard]] std::size_t rows() const { return columns_ == 0 ? 0 : values_.size() / columns_; }
  [[nodiscard]] std::size_t columns() const { return columns_; }
  [[nodiscard]] double operator()(std::size_t row, std::size_t column) const {
    return values_[row * columns_ + column];
  }

  /// First of three neighbouring columns with these names.
  [[nodiscard]] std::optional<std::size_t> find(std::string_view a,
                                                std::string_view b,
                                                std::string_view c) const {
    if (names_.size() != columns_) return std::nullopt;
    for (std::size_t i = 0; i + 2 < names_.size(); ++i)
      if (names_[i] == a && names_[i + 1] == b && names_[i + 2] == c) return i;
    return std::nullopt;
  }
  [[nodiscard]] bool has_names() const { return columns_ > 0 && names_.size() == columns_; }

 private:
  static constexpr std::string_view separators = " \t\r\v\f,;";

  void read_names(std::string_view line) {
    names_.clear();
    std::string name;
    for (const char c : lower_case(line) + ' ') {
      if (separators.find(c) == std::string_view::npos) {
        if (c != '"') name += c;
      } else if (!name.empty()) {
        names_.push_back(std::exchange(name, {}));
      }
    }
  }

  void read_row(std::string_view line) {
    std::string_view rest = line;
    const std::size_t before = values_.size();
    while (const auto value = take_number(rest, separators)) values_.push_back(*value);
    const std::size_t n = values_.size() - before;
    rest.remove_prefix(std::min(rest.find_first_not_of(separators), rest.size()));
    const bool is_first = columns_ == 0 && !announced_;
    if (is_first && n == 0) return read_names(line);
    if (is_first && n == 1 && rest.empty()) {
      announced_ = values_.back();
      values_.pop_back();
      return;
    }
    if (!rest.empty())
      lines_.fail(message("xyz: a number expected, found \"", rest.substr(0, 40), "\""));
    if (columns_ == 0) columns_ = n;
    if (n < 3 || n != columns_)
      lines_.fail(
          message("xyz: ", std::max<std::size_t>(columns_, 3), " numbers expected, found ", n));
  }

  std::filesystem::path path_;
  std::string text_;
  line_reader lines_;
  std::vector<double> values_;
  std::vector<std::string> names_;
  std::optional<double> announced_;
  std::size_t columns_ = 0;
};

/// Which columns of a table hold what.
struct xyz_columns {
  std::size_t position = 0;
  std::optional<std::size_t> color, normal;
  bool has_unknown = false;
};

inline bool are_colors(const xyz_table& table, std::size_t first) {
  for (std::size_t i = 0; i < table.rows(); ++i) {
    for (std::size_t k = first; k < first + 3; ++k) {
      const double v = table(i, k);
      if (!(v >= 0 && v <= 255) || v != std::floor(v)) return false;
    }
  }
  return true;
}

inline bool are_normals(const xyz_table& table, std::size_t first) {
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const Eigen::Vector3d v(table(i, first), table(i, first + 1), table(i, first + 2));
    if (!(std::abs(v.norm() - 1) < 0.01 || v.isZero(0))) return false;
  }
  return true;
}

inline xyz_columns find_columns(const xyz_table& table, const std::filesystem::path& path) {
  xyz_columns columns;
  if (table.has_names()) {
    const auto position = table.find("x", "y", "z");
    if (!position) throw format_error(path, "xyz: no columns x, y, z in the first line");
    columns.position = *position;
    columns.normal = table.find("nx", "ny", "nz");
    columns.color = table.find("r", "g", "b");
    if (!columns.color) columns.color = table.find("red", "green", "blue");
    return columns;
  }
  const std::size_t extra = table.columns() - 3;
  std::size_t at = 3 + (extra % 3 == 1 ? 1 : 0);
  for (; at + 3 <= table.columns(); at += 3) {
    if (!columns.color && are_colors(table, at)) {
      columns.color = at;
    } else if (!columns.normal && are_normals(table, at)) {
      columns.normal = at;
    } else {
      columns.has_unknown = true;
    }
  }
  columns.has_unknown = columns.has_unknown || at < table.columns();
  return columns;
}

}  // namespace detail

inline cloud::cloud read_xyz(const std::filesystem::path& path) {
  const detail::xyz_table table(path);
  cloud::cloud result;
  if (table.rows() == 0) {
    set_positions(result, {});
    return result;
  }
  const auto columns = detail::find_columns(table, path);
  std::vector<Eigen::Vector3d> positions(table.rows());
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const auto triple = [&](std::size_t first) {
      return Eigen::Vector3d(table(i, first), table(i, first + 1), table(i, first + 2));
    };
    positions[i] = triple(columns.position);
    if (columns.normal) result.normals.push_back(triple(*columns.normal).cast<float>());
    if (columns.color) {
      const Eigen::Vector3d c = triple(*columns.color);
      result.colors.push_back({channel_of(c[0]), channel_of(c[1]), channel_of(c[2])});
    }
  }
  if (columns.has_unknown)
    result.warnings.push_back("columns that are neither colours nor normals were passed over");
  set_positions(result, to_floats(positions));
  return result;
}

}  // namespace aib::io
