// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/cloud.hpp>
#include <aib/core/error.hpp>
#include <aib/io/bytes.hpp>
#include <aib/io/file.hpp>
#include <aib/io/limits.hpp>
#include <aib/io/positions.hpp>
#include <aib/mesh/mesh.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

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

/// Reads the triangles of a binary glTF 2.0 file (.glb): lists, strips and fans, each node's
/// transformation applied. A label for each node with a mesh, named as the node. Y is up in glTF.
///
/// Throws format_error where the file is damaged, an index has no vertex, nodes repeat meshes
/// beyond the limits (max_ratio, max_bytes), or the file has what is not read: compressed,
/// quantised or sparse meshes, buffers outside of the file. Source: Khronos, glTF 2.0
/// specification.
mesh::mesh read_glb_mesh(const std::filesystem::path& path, const limits& limits = {});

/// Reads the points of a binary glTF 2.0 file with their colours; of a file without points, the
/// vertices of its meshes.
cloud::cloud read_glb_cloud(const std::filesystem::path& path, const limits& limits = {});

namespace detail {

/// What all primitives of a file together hold, in its world.
struct glb_content {
  std::vector<Eigen::Vector3d> vertices = {};
  std::vector<mesh::triangle> triangles = {};
  std::vector<std::uint32_t> labels = {};
  std::vector<std::string> label_names = {};
  std::vector<Eigen::Vector3d> points = {};
  std::vector<cloud::color> colors = {};
};

class glb_reader {
 public:
  using json = nlohmann::json;

  glb_reader(std::string_view bytes, const std::filesystem::path& path, const limits& limits)
      : path_(path), limits_(limits), file_bytes_(bytes.size()) {
    byte_reader in(bytes, path);
    if (in.take(4, "glb: magic") != "glTF") in.fail("glb: not a binary glTF file");
    const auto version = in.read<std::uint32_t>("glb: version");
    if (version != 2) in.fail(message("glb: version 2 expected, found ", version));
    in.take(4, "glb: length");
    while (in.left() >= 8) {
      const auto n = in.read<std::uint32_t>("glb: length of a chunk");
      const std::string_view type = in.take(4, "glb: type of a chunk");
      const std::string_view chunk = in.take(n, "glb: chunk");
      if (type == "JSON") root_ = json::parse(chunk, nullptr, false);
      if (type == std::string_view("BIN\0", 4) && buffer_.empty()) buffer_ = chunk;
    }
    if (!root_.is_object()) fail("no JSON description, or a damaged one");
    for (const json& extension : list(root_, "extensionsRequired")) {
      if (extension.is_string() && extension.get<std::string>().find("unlit") == std::string::npos)
        fail(message("the extension ", extension.get<std::string>(),
                     " is not supported; export the mesh without compression"));
    }
  }

  glb_content read() {
    const json& nodes = list(root_, "nodes");
    visited_.assign(nodes.size(), false);
    for (const std::size_t node : roots(nodes)) visit(node, Eigen::Affine3d::Identity(), 0);
    return std::move(content_);
  }

 private:
  static constexpr std::size_t points = 0, triangles = 4, strip = 5, fan = 6;  // modes
  static constexpr std::size_t max_vertices = std::size_t{1} << 28;

  static const json& list(const json& object, const char* name) {
    static const json empty = json::array();
    const auto found = object.find(name);
    return found != object.end() && found->is_array() ? *found : empty;
  }

  /// Element `index` of the top-level list `name`.
  const json& element(const char* name, std::size_t index) const {
    const json& all = list(root_, name);
    if (index >= all.size() || !all[index].is_object())
      fail(message("no element ", index, " in ", name));
    return all[index];
  }

  std::optional<std::size_t> number(const json& object, const char* name) const {
    const auto found = object.find(name);
    if (found == object.end()) return std::nullopt;
    return whole(*found, name);
  }

  std::size_t whole(const json& value, std::string_view name) const {
    if (!value.is_number_unsigned()) fail(message(name, ": a whole number expected"));
    return value.get<std::size_t>();
  }

  std::vector<std::size_t> roots(const json& nodes) const {
    std::vector<std::size_t> result;
    if (!list(root_, "scenes").empty()) {
      const json& scene = element("scenes", number(root_, "scene").value_or(0));
      for (const json& node : list(scene, "nodes")) result.push_back(whole(node, "scene"));
      return result;
    }
    std::vector<bool> is_child(nodes.size(), false);
    for (const json& node : nodes) {
      for (const json& child : list(node, "children")) {
        const std::size_t index = whole(child, "children");
        if (index < nodes.size()) is_child[index] = true;
      }
    }
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (!is_child[i]) result.push_back(i);
    return result;
  }

  void visit(std::size_t index, const Eigen::Affine3d& world_from_parent, int depth) {
    const json& node = element("nodes", index);
    if (visited_[index] || depth > 1000) fail("the nodes are not a tree");
    visited_[index] = true;
    const Eigen::Affine3d world_from_node = world_from_parent * transformation(node);
    if (const auto shape = number(node, "mesh"))
      add_mesh(element("meshes", *shape), node, world_from_node);
    for (const json& child : list(node, "children"))
      visit(whole(child, "children"), world_from_node, depth + 1);
  }

  template <std::size_t N>
  std::array<double, N> numbers(const json& node,
                                const char* name,
                                std::array<double, N> values) const {
    const json& found = list(node, name);
    if (found.empty()) return values;
    if (found.size() != N) fail(message(name, ": ", N, " numbers expected"));
    for (std::size_t i = 0; i < N; ++i) {
      if (!found[i].is_number()) fail(message(name, ": numbers expected"));
      values[i] = found[i].get<double>();
    }
    return values;
  }

  Eigen::Affine3d transformation(const json& node) const {
    if (node.contains("matrix")) {
      const auto m = numbers<16>(node, "matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
      Eigen::Affine3d result;
      for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
          result.matrix()(row, column) = m[static_cast<std::size_t>(4 * column + row)];
      return result;
    }
    const auto t = numbers<3>(node, "translation", {0, 0, 0});
    const auto q = numbers<4>(node, "rotation", {0, 0, 0, 1});
    const auto s = numbers<3>(node, "scale", {1, 1, 1});
    const Eigen::Quaterniond rotation(q[3], q[0], q[1], q[2]);
    if (!(rotation.norm() > 0) || !std::isfinite(rotation.norm()))
      fail("rotation: a quaternion of length 1 expected");
    return Eigen::Translation3d(t[0], t[1], t[2]) * rotation.normalized() *
           Eigen::Scaling(s[0], s[1], s[2]);
  }

  /// Counts what the content takes, which may be far more than the file has: each node repeats its
  /// mesh.
  void take_room(std::size_t n, std::size_t bytes) {
    room_ += static_cast<double>(n) * static_cast<double>(bytes);
    if (room_ <= static_cast<double>(limits_.max_bytes) ||
        room_ <= limits_.max_ratio * static_cast<double>(file_bytes_))
      return;
    fail(message("the meshes of a file of ", file_bytes_, " bytes need more than ",
                 limits_.max_bytes, " (max_bytes, max_ratio)"));
  }

  void add_mesh(const json& shape, const json& node, const Eigen::Affine3d& world_from_mesh) {
    const auto label = static_cast<std::uint32_t>(content_.label_names.size());
    const auto named = [](const json& o) {
      const auto name = o.find("name");
      return name != o.end() && name->is_string() ? name->get<std::string>() : std::string();
    };
    content_.label_names.push_back(named(node).empty() ? named(shape) : named(node));
    take_room(content_.label_names.back().size(), 1);
    for (const json& primitive : list(shape, "primitives")) {
      take_room(1, 1000);  // time, too, has its limit: a microsecond
      const auto attributes = primitive.find("attributes");
      if (attributes == primitive.end() || !attributes->is_object())
        fail("a primitive without attributes");
      const auto position = number(*attributes, "POSITION");
      if (!position) continue;
      add_primitive(primitive, *position, number(*attributes, "COLOR_0"), world_from_mesh, label);
    }
  }

  void add_primitive(const json& primitive,
                     std::size_t position,
                     std::optional<std::size_t> color,
                     const Eigen::Affine3d& world_from_mesh,
                     std::uint32_t label) {
    const std::size_t mode = number(primitive, "mode").value_or(triangles);
    const bool is_cloud = mode == points;
    if (!is_cloud && (mode < triangles || mode > fan)) return;  // lines
    std::vector<Eigen::Vector3d>& to = is_cloud ? content_.points : content_.vertices;
    const std::size_t first = to.size();
    const accessor source = open(position, 3, true);
    if (source.n > max_vertices - first) fail("more than 2^28 vertices");
    take_room(source.n, sizeof(Eigen::Vector3d));
    for (std::size_t i = 0; i < source.n; ++i) {
      Eigen::Vector3d p;
      for (int k = 0; k < 3; ++k) p[k] = source.value(i, static_cast<std::size_t>(k));
      to.push_back(world_from_mesh * p);
    }
    if (is_cloud) {
      add_colors(color, source.n);
    } else {
      add_triangles(indices(primitive, source.n), mode, first, label);
    }
  }

  void add_colors(std::optional<std::size_t> color, std::size_t n) {
    content_.colors.resize(content_.points.size(), {0, 0, 0});
    if (!color) return;
    const accessor source = open(*color, 3, false);
    if (source.n != n) fail(message("COLOR_0: ", n, " colours expected, found ", source.n));
    const double unit = source.type == 5126 ? 255 : source.type == 5123 ? 1 / 257.0 : 1;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t k = 0; k < 3; ++k)
        content_.colors[content_.colors.size() - n + i][k] =
            channel_of(source.value(i, k) * unit + 0.5);
  }

  std::vector<std::uint32_t> indices(const json& primitive, std::size_t n_vertices) const {
    std::vector<std::uint32_t> result;
    if (const auto index = number(primitive, "indices")) {
      const accessor source = open(*index, 1, false);
      if (source.type == 5126) fail("indices: whole numbers expected, found floats");
      for (std::size_t i = 0; i < source.n; ++i) {
        const double value = source.value(i, 0);
        if (!(value < static_cast<double>(n_vertices)))
          fail(message("one of ", n_vertices, " vertices expected, found index ", value));
        result.push_back(static_cast<std::uint32_t>(value));
      }
    } else {
      for (std::size_t i = 0; i < n_vertices; ++i) result.push_back(static_cast<std::uint32_t>(i));
    }
    return result;
  }

  void add_triangles(const std::vector<std::uint32_t>& corners,
                     std::size_t mode,
                     std::size_t first,
                     std::uint32_t label) {
    const auto vertex = [&](std::size_t i) {
      return static_cast<std::uint32_t>(first + corners[i]);
    };
    const std::size_t step = mode == strip || mode == fan ? 1 : 3;
    take_room(corners.size() / step, sizeof(mesh::triangle) + sizeof label);
    for (std::size_t i = 0; i + 2 < corners.size(); i += step) {
      const bool flipped = mode == strip && i % 2 == 1;
      const std::size_t a = mode == fan ? 0 : i;
      content_.triangles.push_back(
          {vertex(a), vertex(flipped ? i + 2 : i + 1), vertex(flipped ? i + 1 : i + 2)});
      content_.labels.push_back(label);
    }
  }

  /// A list of tuples in the binary chunk, checked against its end.
  struct accessor {
    const char* data;
    std::size_t n, stride, type, type_bytes;

    double value(std::size_t i, std::size_t k) const {
      const char* at = data + i * stride + k * type_bytes;
      switch (type) {
        case 5121:
          return load<std::uint8_t>(at);
        case 5123:
          return load<std::uint16_t>(at);
        case 5125:
          return load<std::uint32_t>(at);
        default:
          return static_cast<double>(load<float>(at));
      }
    }
  };

  accessor open(std::size_t index, std::size_t components, bool must_be_float) const {
    const json& a = element("accessors", index);
    const auto view_index = number(a, "bufferView");
    if (a.contains("sparse") || !view_index) fail("sparse or empty accessors are not supported");
    const json& view = element("bufferViews", *view_index);
    if (number(view, "buffer").value_or(0) != 0 ||
        (!list(root_, "buffers").empty() && list(root_, "buffers")[0].contains("uri")))
      fail("a buffer outside of the file is not supported");
    accessor result{};
    result.type = number(a, "componentType").value_or(0);
    result.type_bytes = result.type == 5121 ? 1u : result.type == 5123 ? 2u : 4u;
    const bool known =
        result.type == 5121 || result.type == 5123 || result.type == 5125 || result.type == 5126;
    if (!known || (must_be_float && result.type != 5126))
      fail(message("numbers of type ", result.type, " are not supported"));
    result.n = number(a, "count").value_or(0);
    const std::string kind = a.contains("type") && a["type"].is_string() ? a["type"] : "";
    const std::size_t found = kind == "SCALAR" ? 1u
                              : kind == "VEC3" ? 3u
                              : kind == "VEC4" ? 4u
                                               : 0u;
    if (found < components) fail(message("tuples of ", components, " expected, found ", kind));
    const std::size_t tuple = found * result.type_bytes;
    result.stride = number(view, "byteStride").value_or(tuple);
    const std::size_t begin = number(view, "byteOffset").value_or(0);
    const std::size_t offset = number(a, "byteOffset").value_or(0);
    const bool fits = begin <= buffer_.size() && offset <= buffer_.size() - begin &&
                      result.stride >= tuple &&
                      (result.n == 0 ||
                       (tuple <= buffer_.size() - begin - offset &&
                        result.n - 1 <= (buffer_.size() - begin - offset - tuple) / result.stride));
    if (!fits) fail(message("accessor ", index, " leads beyond the end of the file"));
    result.data = buffer_.data() + begin + offset;
    return result;
  }

  [[noreturn]] void fail(std::string_view what) const {
    throw format_error(path_, message("glb: ", what));
  }

  std::filesystem::path path_;
  const limits& limits_;
  std::size_t file_bytes_;
  double room_ = 0;  ///< bytes
  json root_;
  std::string_view buffer_;
  std::vector<bool> visited_;
  glb_content content_;
};

inline glb_content read_glb(const std::filesystem::path& path, const limits& limits) {
  const std::string bytes = read_file(path);
  return glb_reader(bytes, path, limits).read();
}

}  // namespace detail

inline mesh::mesh read_glb_mesh(const std::filesystem::path& path, const limits& limits) {
  auto content = detail::read_glb(path, limits);
  mesh::mesh result{.triangles = std::move(content.triangles),
                    .labels = std::move(content.labels),
                    .label_names = std::move(content.label_names)};
  set_vertices(result, to_floats(content.vertices));
  return result;
}

inline cloud::cloud read_glb_cloud(const std::filesystem::path& path, const limits& limits) {
  auto content = detail::read_glb(path, limits);
  const bool has_points = !content.points.empty();
  cloud::cloud result;
  if (has_points) result.colors = std::move(content.colors);
  set_positions(result, to_floats(has_points ? content.points : content.vertices));
  return result;
}

}  // namespace aib::io
