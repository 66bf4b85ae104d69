// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/cloud.hpp>
#include <aib/core/large_pages.hpp>
#include <aib/io/byte_stream.hpp>
#include <aib/io/bytes.hpp>
#include <aib/io/file.hpp>
#include <aib/io/ply_data.hpp>
#include <aib/io/ply_header.hpp>
#include <aib/io/positions.hpp>
#include <aib/io/text.hpp>
#include <aib/mesh/mesh.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace aib::io {

/// What to do with a PLY of 3D Gaussian splats, whose centres are not points of a surface.
enum class splat_rule { refuse, centres };

/// Reads the vertices of a PLY file: ascii and binary of both byte orders, properties in any order,
/// lists anywhere, other elements before or behind. Faces are passed over. Of elements or
/// properties of the same name the first counts.
///
/// x y z       required; other types than binary float are kept as double, from a natural origin
/// nx ny nz    normals; all zero (as pi3 writes them) means none
/// red green blue   8 or 16 bits, or float 0..1
/// label       unsigned label of a point
///
/// Non-finite points stay, their number is in the warnings.
/// Throws format_error where the file is damaged or holds Gaussian splats that were not asked for.
/// Source of the format: Turk, "The PLY polygon file format", 1994.
cloud::cloud read_ply_cloud(const std::filesystem::path& path,
                            splat_rule splats = splat_rule::refuse);

/// Reads vertices and faces of a PLY file. Polygons become fans around their first vertex; a
/// polygon of less than three vertices is dropped with a warning.
///
/// vertex_indices or vertex_index   list of the face
/// label       unsigned label of a face; a comment "labels: 0=ground 1=tower" names them
///
/// Throws format_error where the file is damaged, has no faces, or an index has no vertex.
mesh::mesh read_ply_mesh(const std::filesystem::path& path);

namespace detail {

/// A colour channel as a byte: T is the type in the file, float channels are 0..1.
template <class T>
std::uint8_t color_byte(double value) {
  if (std::is_floating_point_v<T>) value *= 255;
  if (std::is_same_v<T, std::uint16_t>) value /= 257;
  return channel_of(value + 0.5);
}

/// The scalar property of a name.
inline std::optional<std::size_t> find_scalar(const ply_element& element, std::string_view name) {
  const auto index = element.find(name);
  return index && !element.properties[*index].list_count ? index : std::nullopt;
}

using ply_triple = std::array<std::size_t, 3>;

inline std::optional<ply_triple> find_scalars(const ply_element& element,
                                              std::array<std::string_view, 3> names) {
  ply_triple columns{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto index = find_scalar(element, names[k]);
    if (!index) return std::nullopt;
    columns[k] = *index;
  }
  return columns;
}

/// The vertex element on its way to a cloud.
class ply_vertices {
 public:
  ply_vertices(const ply_element& element,
               const ply_header& header,
               const std::filesystem::path& path)
      : element_(element),
        order_(byte_order(header.format)),
        normal_(find_scalars(element, {"nx", "ny", "nz"})),
        color_(find_scalars(element, {"red", "green", "blue"})),
        label_(find_scalar(element, "label")) {
    const auto position = find_scalars(element, {"x", "y", "z"});
    if (!position) throw format_error(path, "ply: element vertex has no properties x, y and z");
    position_ = *position;
    is_float_ = header.format != ply_format::ascii &&
                std::all_of(position_.begin(), position_.end(),
                            [&](std::size_t i) { return type(i) == ply_type::float32; });
  }

  cloud::cloud read(ply_data& data) {
    const auto n = static_cast<std::size_t>(element_.count);
    is_float_ ? resize_in_large_pages(result_.points, n) : doubles_.resize(n);
    if (normal_) result_.normals.resize(n);
    if (color_) result_.colors.resize(n);
    if (label_) result_.labels.resize(n);
    if (data.stream() && !element_.has_list()) {
      read_columns(*data.stream());
    } else {
      read_rows(data);
    }
    return finish();
  }

 private:
  /// Binary rows of equal length, in one piece.
  struct block {
    const char* bytes;
    std::size_t first;  ///< number of its first row
    std::size_t n;
  };

  ply_type type(std::size_t column) const { return element_.properties[column].type; }

  bool is_packed() const {
    return is_float_ && order_ == std::endian::native && position_ == ply_triple{0, 1, 2} &&
           element_.properties.size() == 3;
  }

  void read_columns(byte_stream& stream) {
    const std::size_t stride = element_.row_bytes();
    if (is_packed()) {
      stream.read(result_.points.data(), result_.points.size() * stride, element_.name);
      return;
    }
    const std::size_t rows = std::max<std::size_t>(1, (std::size_t{1} << 18) / stride);
    for (std::size_t first = 0; first < element_.count; first += rows) {
      const std::size_t n = std::min<std::size_t>(rows, element_.count - first);
      const block rows_here{stream.take(n * stride, element_.name), first, n};
      for (std::size_t k = 0; k < 3; ++k) set_columns(rows_here, k);
      if (label_) set_labels(rows_here);
    }
  }

  /// Calls `set(i, number)` for each row i of a block with its number in a column.
  template <class Set>
  void for_each_number(const block& rows, std::size_t column, Set set) const {
    const char* from = rows.bytes;
    for (std::size_t i = 0; i < column; ++i) from += size_of(type(i));
    const std::size_t stride = element_.row_bytes();
    with_type(type(column), [&]<class T>(std::type_identity<T>) {
      if (order_ == std::endian::native) {
        for (std::size_t i = 0; i < rows.n; ++i)
          set(rows.first + i, load<T>(from + i * stride, std::endian::native));
      } else {
        for (std::size_t i = 0; i < rows.n; ++i)
          set(rows.first + i, load<T>(from + i * stride, order_));
      }
    });
  }

  /// Coordinate k of positions and normals, channel k of colours.
  void set_columns(const block& rows, std::size_t k) {
    const auto axis = static_cast<int>(k);
    if (is_float_) {
      for_each_number(rows, position_[k], [&](std::size_t i, auto value) {
        result_.points[i][axis] = static_cast<float>(value);
      });
    } else {
      for_each_number(rows, position_[k], [&](std::size_t i, auto value) {
        doubles_[i][axis] = static_cast<double>(value);
      });
    }
    if (normal_) {
      for_each_number(rows, (*normal_)[k], [&](std::size_t i, auto value) {
        result_.normals[i][axis] = static_cast<float>(value);
      });
    }
    if (color_) {
      for_each_number(rows, (*color_)[k], [&](std::size_t i, auto value) {
        if constexpr (std::is_same_v<decltype(value), std::uint8_t>) {
          result_.colors[i][k] = value;
        } else {
          result_.colors[i][k] = color_byte<decltype(value)>(static_cast<double>(value));
        }
      });
    }
  }

  void set_labels(const block& rows) {
    for_each_number(rows, *label_, [&](std::size_t i, auto value) {
      result_.labels[i] = label_of(static_cast<double>(value));
    });
  }

  void read_rows(ply_data& data) {
    ply_row row;
    for (std::size_t i = 0; i < element_.count; ++i) {
      data.read_row(element_, no_list, row);
      for (std::size_t k = 0; k < 3; ++k) set_row(row, i, k);
      if (label_) result_.labels[i] = label_of(row.values[*label_]);
    }
  }

  void set_row(const ply_row& row, std::size_t i, std::size_t k) {
    const auto axis = static_cast<int>(k);
    const double coordinate = row.values[position_[k]];
    if (is_float_) {
      result_.points[i][axis] = static_cast<float>(coordinate);
    } else {
      doubles_[i][axis] = coordinate;
    }
    if (normal_) result_.normals[i][axis] = static_cast<float>(row.values[(*normal_)[k]]);
    if (color_) {
      const std::size_t column = (*color_)[k];
      result_.colors[i][k] = with_type(type(column), [&]<class T>(std::type_identity<T>) {
        return color_byte<T>(row.values[column]);
      });
    }
  }

  cloud::cloud finish() {
    if (!is_float_) {
      auto floats = to_floats(doubles_);
      result_.origin = floats.origin;
      result_.points = std::move(floats.points);
    }
    const auto is_zero = [](const Eigen::Vector3f& n) { return n.isZero(0); };
    if (std::all_of(result_.normals.begin(), result_.normals.end(), is_zero))
      result_.normals.clear();
    if (auto warning = non_finite_warning(result_.points, "points"))
      result_.warnings.push_back(std::move(*warning));
    return std::move(result_);
  }

  const ply_element& element_;
  std::endian order_;
  ply_triple position_{};
  std::optional<ply_triple> normal_;
  std::optional<ply_triple> color_;
  std::optional<std::size_t> label_;
  bool is_float_ = false;  ///< the file holds float: nothing to gain from double
  std::vector<Eigen::Vector3d> doubles_;
  cloud::cloud result_;
};

/// The face element on its way to triangles.
class ply_faces {
 public:
  ply_faces(const ply_element& element, std::uint64_t n_vertices, const std::filesystem::path& path)
      : element_(element), n_vertices_(n_vertices), label_(find_scalar(element, "label")) {
    auto list = element.find("vertex_indices");
    if (!list) list = element.find("vertex_index");
    if (!list || !element.properties[*list].list_count)
      throw format_error(path, "ply: element face has no list vertex_indices");
    list_ = *list;
  }

  void read(ply_data& data, mesh::mesh& result) const {
    result.triangles.reserve(static_cast<std::size_t>(element_.count));
    ply_row row;
    std::size_t n_dropped = 0;
    for (std::uint64_t i = 0; i < element_.count; ++i) {
      data.read_row(element_, list_, row);
      check(data, i, row.list);
      n_dropped += row.list.size() < 3 ? 1u : 0u;
      for (std::size_t k = 2; k < row.list.size(); ++k) {
        result.triangles.push_back({index(row, 0), index(row, k - 1), index(row, k)});
        if (label_) result.labels.push_back(label_of(row.values[*label_]));
      }
    }
    if (n_dropped > 0)
      result.warnings.push_back(message(n_dropped, " faces of less than 3 vertices were dropped"));
    if (result.triangles.empty()) result.warnings.push_back("no triangles");
  }

 private:
  static std::uint32_t index(const ply_row& row, std::size_t k) {
    return static_cast<std::uint32_t>(row.list[k]);
  }

  void check(const ply_data& data, std::uint64_t face, const std::vector<double>& list) const {
    for (const double v : list) {
      if (v >= 0 && v < static_cast<double>(n_vertices_) && v == std::floor(v)) continue;
      throw data.error(message("ply: face ", face, ": one of ", n_vertices_,
                               " vertices expected, found index ", v));
    }
  }

  const ply_element& element_;
  std::uint64_t n_vertices_;
  std::size_t list_ = 0;
  std::optional<std::size_t> label_;
};

/// Names of the comment "labels: 0=ground 1=tower".
inline std::vector<std::string> ply_label_names(const ply_header& header) {
  constexpr std::size_t max_labels = 65536;
  std::vector<std::string> names;
  std::vector<std::string_view> fields;
  for (const std::string& comment : header.comments) {
    if (!comment.starts_with("labels:")) continue;
    split(std::string_view(comment).substr(7), fields);
    for (const std::string_view field : fields) {
      const std::size_t equals = field.find('=');
      const auto label = parse<std::size_t>(field.substr(0, equals));
      if (equals == std::string_view::npos || !label || *label >= max_labels) continue;
      if (names.size() <= *label) names.resize(*label + 1);
      names[*label] = field.substr(equals + 1);
    }
  }
  return names;
}

inline const ply_element& ply_vertex_element(const ply_header& header,
                                             const std::filesystem::path& path) {
  if (const ply_element* vertex = header.find("vertex")) return *vertex;
  throw format_error(path, "ply: no element vertex");
}

}  // namespace detail

inline cloud::cloud read_ply_cloud(const std::filesystem::path& path, splat_rule splats) {
  const input_file file(path);
  const ply_header header = read_ply_header(file);
  const ply_element& vertex = detail::ply_vertex_element(header, path);
  const bool is_splats = vertex.find("f_dc_0") && vertex.find("opacity");
  if (is_splats && splats == splat_rule::refuse) {
    throw format_error(path,
                       "ply: 3D Gaussian splats (f_dc_0, opacity), whose centres are not points of "
                       "a surface; ask for splats = \"centres\" to read them all the same");
  }
  const auto data = detail::open_ply_data(file, header);
  cloud::cloud result;
  for (const ply_element& element : header.elements) {
    if (&element == &vertex) {
      result = detail::ply_vertices(vertex, header, path).read(*data);
    } else {
      data->skip(element);
    }
  }
  if (result.empty()) result.warnings.push_back("no points");
  if (is_splats) result.warnings.push_back("centres of 3D Gaussian splats");
  return result;
}

inline mesh::mesh read_ply_mesh(const std::filesystem::path& path) {
  const input_file file(path);
  const ply_header header = read_ply_header(file);
  const ply_element& vertex = detail::ply_vertex_element(header, path);
  const ply_element* face = header.find("face");
  if (!face) throw format_error(path, "ply: a mesh expected, found a cloud (no element face)");
  const detail::ply_faces faces(*face, vertex.count, path);
  mesh::mesh result;
  result.label_names = detail::ply_label_names(header);
  const auto data = detail::open_ply_data(file, header);
  for (const ply_element& element : header.elements) {
    if (&element == &vertex) {
      cloud::cloud vertices = detail::ply_vertices(vertex, header, path).read(*data);
      result.origin = vertices.origin;
      result.vertices = std::move(vertices.points);
      for (std::string& w : vertices.warnings) result.warnings.push_back(std::move(w));
    } else if (&element == face) {
      faces.read(*data, result);
    } else {
      data->skip(element);
    }
  }
  return result;
}

}  // namespace aib::io
