// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/io/file.hpp>
#include <aib/io/numbers.hpp>
#include <aib/io/positions.hpp>
#include <aib/io/text.hpp>
#include <aib/mesh/mesh.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace aib::io {

/// Reads vertices and faces of a Wavefront OBJ file. Polygons become fans around their first
/// vertex; indices may be negative (from the end); everything else in the file is passed over.
/// Faces of less than three vertices are dropped with a warning.
///
/// Throws format_error where a number is damaged or an index has no vertex.
/// Source: Wavefront, "Object Files (.obj)", appendix B of the Advanced Visualizer manual.
mesh::mesh read_obj(const std::filesystem::path& path);

namespace detail {

class obj_reader {
 public:
  obj_reader(std::string_view text, const std::filesystem::path& path)
      : lines_(text, path), path_(path) {}

  mesh::mesh read() {
    while (next_statement()) {
      const std::string_view keyword = take_word();
      if (keyword == "v") {
        add_vertex();
      } else if (keyword == "f") {
        add_face();
      }
    }
    if (highest_ >= vertices_.size() && !result_.triangles.empty()) {
      throw format_error(path_, at_line{highest_line_},
                         message("obj: vertex ", highest_ + 1, " of ", vertices_.size()));
    }
    return finish();
  }

 private:
  /// Moves to the next statement; a backslash at the end of a line goes on in the next.
  bool next_statement() {
    if (!lines_.next()) return false;
    rest_ = trim(lines_.line());
    if (!rest_.ends_with('\\')) return true;
    joined_.clear();
    while (rest_.ends_with('\\')) {
      joined_ += rest_.substr(0, rest_.size() - 1);
      joined_ += ' ';
      rest_ = lines_.next() ? trim(lines_.line()) : std::string_view();
    }
    joined_ += rest_;
    rest_ = joined_;
    return true;
  }

  std::string_view take_word() {
    constexpr std::string_view blank = " \t\v\f";
    rest_.remove_prefix(std::min(rest_.find_first_not_of(blank), rest_.size()));
    const std::size_t end = std::min(rest_.find_first_of(blank), rest_.size());
    const std::string_view word = rest_.substr(0, end);
    rest_.remove_prefix(end);
    return word;
  }

  void add_vertex() {
    Eigen::Vector3d v;
    for (int k = 0; k < 3; ++k) {
      const auto number = take_number(rest_);
      if (!number) lines_.fail(message("obj: 3 coordinates of a vertex expected, found ", k));
      v[k] = *number;
    }
    vertices_.push_back(v);
  }

  void add_face() {
    corners_.clear();
    for (std::string_view word = take_word(); !word.empty(); word = take_word())
      corners_.push_back(vertex_of(word.substr(0, word.find('/'))));
    n_dropped_ += corners_.size() < 3 ? 1u : 0u;
    for (std::size_t k = 2; k < corners_.size(); ++k)
      result_.triangles.push_back({corners_[0], corners_[k - 1], corners_[k]});
  }

  /// "3" is the third vertex, "-1" the last one so far. A vertex may come after its face: that it
  /// exists is checked at the end.
  std::uint32_t vertex_of(std::string_view word) {
    const auto index = parse<std::int64_t>(word);
    const auto n = static_cast<std::int64_t>(vertices_.size());
    if (!index || *index == 0 || *index < -n ||
        *index > std::int64_t{std::numeric_limits<std::uint32_t>::max()}) {
      lines_.fail(message("obj: the index of a vertex (1 to ", n, ", or -1 to -", n,
                          ") expected, found \"", word.substr(0, 40), "\""));
    }
    const std::int64_t vertex = *index > 0 ? *index - 1 : n + *index;
    if (highest_line_ == 0 || static_cast<std::size_t>(vertex) > highest_) {
      highest_ = static_cast<std::size_t>(vertex);
      highest_line_ = lines_.number();
    }
    return static_cast<std::uint32_t>(vertex);
  }

  mesh::mesh finish() {
    if (n_dropped_ > 0)
      result_.warnings.push_back(
          message(n_dropped_, " faces of less than 3 vertices were dropped"));
    set_vertices(result_, to_floats(vertices_));
    return std::move(result_);
  }

  line_reader lines_;
  std::filesystem::path path_;
  std::string_view rest_;
  std::string joined_;
  std::vector<Eigen::Vector3d> vertices_;
  std::vector<std::uint32_t> corners_;
  std::size_t highest_ = 0;
  std::size_t highest_line_ = 0;
  std::size_t n_dropped_ = 0;
  mesh::mesh result_;
};

}  // namespace detail

inline mesh::mesh read_obj(const std::filesystem::path& path) {
  const std::string text = read_file(path);
  return detail::obj_reader(text, path).read();
}

}  // namespace aib::io
