// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/cloud.hpp>
#include <aib/core/error.hpp>
#include <aib/io/bytes.hpp>
#include <aib/io/file.hpp>
#include <aib/io/limits.hpp>
#include <aib/io/numbers.hpp>
#include <aib/io/positions.hpp>
#include <aib/io/text.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace aib::io {

/// Reads a PCD file of the Point Cloud Library: ascii, binary and binary_compressed; fields x y z,
/// normal_x normal_y normal_z, rgb or rgba (packed), label; of fields of the same name the first.
/// The viewpoint is not applied.
///
/// Throws format_error where the file is damaged, WIDTH x HEIGHT are not POINTS, or it has more
/// points than the limits.
/// Source: Point Cloud Library, "The PCD (Point Cloud Data) file format".
cloud::cloud read_pcd(const std::filesystem::path& path, const limits& limits = {});

namespace detail {

struct pcd_field {
  std::string name;
  char type = 'F';         ///< F, I or U
  std::size_t bytes = 4;   ///< of one number
  std::size_t count = 1;   ///< numbers a point
  std::size_t offset = 0;  ///< in a binary row
};

struct pcd_header {
  std::vector<pcd_field> fields = {};
  std::uint64_t n = 0;
  std::string data = {};
  std::size_t end = 0;  ///< byte of the first datum
  std::size_t lines = 0;
  bool has_viewpoint = false;

  [[nodiscard]] std::size_t row_bytes() const {
    return fields.empty() ? 0 : fields.back().offset + fields.back().bytes * fields.back().count;
  }
  [[nodiscard]] const pcd_field* find(std::string_view name) const {
    for (const pcd_field& f : fields)
      if (f.name == name) return &f;
    return nullptr;
  }
};

class pcd_header_parser {
 public:
  pcd_header_parser(std::string_view text, const std::filesystem::path& path)
      : text_(text), lines_(text, path) {}

  pcd_header parse() {
    while (lines_.next_content()) {
      split(lines_.line(), words_);
      const std::string_view key = words_[0];
      if (key == "FIELDS" || key == "COLUMNS") parse_names();
      if (key == "SIZE") each([](pcd_field& f, std::size_t v) { f.bytes = v; });
      if (key == "COUNT") each([](pcd_field& f, std::size_t v) { f.count = v; });
      if (key == "TYPE") parse_types();
      if (key == "WIDTH") width_ = number(1);
      if (key == "HEIGHT") height_ = std::max<std::uint64_t>(1, number(1));
      if (key == "POINTS") points_ = number(1);
      if (key == "VIEWPOINT") parse_viewpoint();
      if (key == "DATA") return finish();
    }
    lines_.fail("pcd: no DATA line");
  }

 private:
  static constexpr std::uint64_t most = std::uint64_t{1} << 40;

  void parse_names() {
    for (std::size_t i = 1; i < words_.size(); ++i)
      header_.fields.push_back({std::string(words_[i])});
  }

  template <class Set>
  void each(Set set) {
    if (words_.size() != header_.fields.size() + 1)
      lines_.fail(message("pcd: ", header_.fields.size(), " values expected"));
    for (std::size_t i = 0; i < header_.fields.size(); ++i)
      set(header_.fields[i], static_cast<std::size_t>(number(i + 1)));
  }

  void parse_types() {
    if (words_.size() != header_.fields.size() + 1) lines_.fail("pcd: a TYPE a field expected");
    for (std::size_t i = 0; i < header_.fields.size(); ++i) {
      if (words_[i + 1] != "F" && words_[i + 1] != "I" && words_[i + 1] != "U")
        lines_.fail("pcd: TYPE F, I or U expected");
      header_.fields[i].type = words_[i + 1][0];
    }
  }

  void parse_viewpoint() {
    constexpr std::array<std::string_view, 8> identity{"VIEWPOINT", "0", "0", "0",
                                                       "1",         "0", "0", "0"};
    for (std::size_t i = 0; i < identity.size() && i < words_.size(); ++i)
      header_.has_viewpoint = header_.has_viewpoint || words_[i] != identity[i];
  }

  std::uint64_t number(std::size_t i) const {
    const auto value = i < words_.size() ? io::parse<std::uint64_t>(words_[i]) : std::nullopt;
    if (!value || *value > most)
      lines_.fail(message("pcd: a whole number expected behind ", words_[0]));
    return *value;
  }

  std::uint64_t count() const {
    if (!width_ && !points_) lines_.fail("pcd: WIDTH or POINTS expected");
    if (width_.value_or(0) == 0) return points_.value_or(0);
    if (*width_ > most / height_)
      lines_.fail(
          message("pcd: ", *width_, " x ", height_, " points, at most ", most, " expected"));
    const std::uint64_t n = *width_ * height_;
    if (points_ && *points_ != n)
      lines_.fail(message("pcd: POINTS of WIDTH x HEIGHT = ", n, " expected, found ", *points_));
    return n;
  }

  pcd_header finish() {
    if (words_.size() != 2) lines_.fail("pcd: DATA ascii, binary or binary_compressed expected");
    header_.data = words_[1];
    header_.n = count();
    std::size_t offset = 0;
    for (pcd_field& f : header_.fields) {
      const bool known = f.bytes == 1 || f.bytes == 2 || f.bytes == 4 || f.bytes == 8;
      if (!known || (f.type == 'F' && f.bytes < 4) || f.count == 0 || f.count > 65536)
        lines_.fail(
            message("pcd: field ", f.name, " of ", f.count, " numbers of ", f.bytes, " bytes"));
      f.offset = offset;
      offset += f.bytes * f.count;
    }
    for (const char* axis : {"x", "y", "z"})
      if (!header_.find(axis)) lines_.fail("pcd: fields x, y and z expected");
    const std::string_view line = lines_.line();
    header_.end = static_cast<std::size_t>(line.data() + line.size() - text_.data());
    header_.end = std::min(text_.find('\n', header_.end), text_.size() - 1) + 1;
    header_.lines = lines_.number();
    return std::move(header_);
  }

  std::string_view text_;
  line_reader lines_;
  std::vector<std::string_view> words_;
  pcd_header header_;
  std::optional<std::uint64_t> width_, points_;
  std::uint64_t height_ = 1;
};

/// Expands LibLZF; false where the result has not exactly `to.size()` bytes.
inline bool expand_lzf(std::string_view from, std::span<char> to) {
  std::size_t n = 0;
  for (std::size_t i = 0; i < from.size();) {
    const std::size_t control = static_cast<unsigned char>(from[i++]);
    const auto next = [&] { return std::size_t{static_cast<unsigned char>(from[i++])}; };
    if (control < 32) {
      const std::size_t run = control + 1;
      if (run > from.size() - i || run > to.size() - n) return false;
      std::memcpy(to.data() + n, from.data() + i, run);
      i += run;
      n += run;
      continue;
    }
    std::size_t run = control >> 5;
    if (from.size() - i < (run == 7 ? 2u : 1u)) return false;
    if (run == 7) run += next();
    run += 2;
    const std::size_t back = ((control & 31) << 8) + next() + 1;
    if (back > n || run > to.size() - n) return false;
    for (std::size_t k = 0; k < run; ++k, ++n) to[n] = to[n - back];
  }
  return n == to.size();
}

inline double pcd_number(const pcd_field& field, const char* at) {
  const auto as = [&]<class I, class U>(I, U) {
    return field.type == 'I' ? static_cast<double>(load<I>(at)) : static_cast<double>(load<U>(at));
  };
  if (field.type == 'F')
    return field.bytes == 4 ? static_cast<double>(load<float>(at)) : load<double>(at);
  switch (field.bytes) {
    case 1:
      return as(std::int8_t{}, std::uint8_t{});
    case 2:
      return as(std::int16_t{}, std::uint16_t{});
    case 4:
      return as(std::int32_t{}, std::uint32_t{});
    default:
      return as(std::int64_t{}, std::uint64_t{});
  }
}

/// Red, green, blue in the lower bytes of a number, which may be stored as the bits of a float.
inline cloud::color pcd_color(const pcd_field& field, double value) {
  const bool is_whole = value > -2147483649.0 && value < 4294967296.0;
  const auto bits = field.type == 'F' ? std::bit_cast<std::uint32_t>(static_cast<float>(value))
                    : is_whole        ? static_cast<std::uint32_t>(static_cast<std::int64_t>(value))
                                      : 0;
  return {static_cast<std::uint8_t>(bits >> 16), static_cast<std::uint8_t>(bits >> 8),
          static_cast<std::uint8_t>(bits)};
}

/// The same from a binary field. As a number, colours that are the bits of a NaN would be changed.
inline cloud::color pcd_color(const pcd_field& field, const char* at) {
  if (field.bytes != 4) return pcd_color(field, pcd_number(field, at));
  return {load<std::uint8_t>(at + 2), load<std::uint8_t>(at + 1), load<std::uint8_t>(at)};
}

/// The wanted fields, point by point.
class pcd_points {
 public:
  pcd_points(const pcd_header& header, std::string_view bytes, const std::filesystem::path& path)
      : header_(header), path_(path) {
    if (header.data == "ascii") {
      read_ascii(bytes);
    } else if (header.data == "binary") {
      read_binary(bytes.substr(header.end), header.row_bytes());
    } else if (header.data == "binary_compressed") {
      read_compressed(bytes.substr(header.end));
    } else {
      fail(message("DATA ascii, binary or binary_compressed expected, found ", header.data));
    }
  }

  cloud::cloud finish() {
    if (header_.has_viewpoint)
      result_.warnings.push_back("the viewpoint in the header was not applied");
    set_positions(result_, to_floats(positions_));
    return std::move(result_);
  }

 private:
  [[noreturn]] void fail(std::string_view what) const {
    throw format_error(path_, message("pcd: ", what));
  }

  void read_ascii(std::string_view text) {
    line_reader lines(text, path_);
    for (std::size_t i = 0; i < header_.lines; ++i) lines.next();
    std::vector<double> row(header_.fields.size());
    for (std::uint64_t i = 0; i < header_.n; ++i) {
      if (!lines.next_content())
        lines.fail(message("pcd: ", header_.n, " points expected, found ", i));
      read_line(lines, row);
      add([&](const pcd_field& f) { return row[index(f)]; },
          [&](const pcd_field& f) { return pcd_color(f, row[index(f)]); });
    }
  }

  [[nodiscard]] std::size_t index(const pcd_field& field) const {
    return static_cast<std::size_t>(&field - header_.fields.data());
  }

  /// The first number of each field.
  void read_line(const line_reader& lines, std::vector<double>& row) const {
    std::string_view rest = lines.line();
    for (const pcd_field& f : header_.fields) {
      for (std::size_t k = 0; k < f.count; ++k) {
        const auto number = take_number(rest);
        if (!number) lines.fail(message("pcd: a number expected for ", f.name));
        if (k == 0) row[index(f)] = *number;
      }
    }
    if (!trim(rest).empty())
      lines.fail(
          message("pcd: the end of the line expected, found '", trim(rest).substr(0, 40), "'"));
  }

  void read_binary(std::string_view bytes, std::size_t row) {
    if (header_.n > bytes.size() / row)
      fail(message(header_.n, " points of ", row, " bytes expected, the file has ", bytes.size(),
                   " bytes for them"));
    for (std::uint64_t i = 0; i < header_.n; ++i)
      add_binary([&](const pcd_field& f) { return bytes.data() + i * row + f.offset; });
  }

  /// Compressed data lie field after field.
  void read_compressed(std::string_view bytes) {
    byte_reader in(bytes, path_);
    const auto packed = in.read<std::uint32_t>("pcd: compressed size");
    const auto size = in.read<std::uint32_t>("pcd: size");
    const std::string_view block = in.take(packed, "pcd: compressed points");
    constexpr std::size_t most = 264;  // what three bytes of LZF can stand for
    if (header_.n > size / header_.row_bytes() || size != header_.n * header_.row_bytes() ||
        size / most > packed)
      fail(message(header_.n, " points of ", header_.row_bytes(), " bytes expected, found ", size,
                   " bytes in ", packed));
    std::vector<char> plain(size);
    if (!expand_lzf(block, plain)) fail("the compressed points are damaged");
    for (std::uint64_t i = 0; i < header_.n; ++i)
      add_binary([&](const pcd_field& f) {
        return plain.data() + f.offset * header_.n + i * f.count * f.bytes;
      });
  }

  /// Adds a point whose fields lie at `place(field)`.
  template <class Place>
  void add_binary(Place place) {
    add([&](const pcd_field& f) { return pcd_number(f, place(f)); },
        [&](const pcd_field& f) { return pcd_color(f, place(f)); });
  }

  /// Adds a point by the first number of a field, and what color it is.
  template <class Number, class Color>
  void add(Number number, Color color) {
    const auto triple = [&](const pcd_triple& f) {
      return Eigen::Vector3d(number(*f[0]), number(*f[1]), number(*f[2]));
    };
    positions_.push_back(triple(position_));
    if (has_normals_) result_.normals.push_back(triple(normal_).template cast<float>());
    if (color_) result_.colors.push_back(color(*color_));
    if (label_) result_.labels.push_back(label_of(number(*label_)));
  }

  using pcd_triple = std::array<const pcd_field*, 3>;

  const pcd_header& header_;
  std::filesystem::path path_;
  pcd_triple position_{header_.find("x"), header_.find("y"), header_.find("z")};
  pcd_triple normal_{header_.find("normal_x"), header_.find("normal_y"), header_.find("normal_z")};
  bool has_normals_ = normal_[0] && normal_[1] && normal_[2];
  const pcd_field* color_ = header_.find("rgb") ? header_.find("rgb") : header_.find("rgba");
  const pcd_field* label_ = header_.find("label");
  std::vector<Eigen::Vector3d> positions_;
  cloud::cloud result_;
};

}  // namespace detail

inline cloud::cloud read_pcd(const std::filesystem::path& path, const limits& limits) {
  const std::string bytes = read_file(path);
  const auto header = detail::pcd_header_parser(bytes, path).parse();
  demand_points(path, "points", header.n, limits);
  return detail::pcd_points(header, bytes, path).finish();
}

}  // namespace aib::io
