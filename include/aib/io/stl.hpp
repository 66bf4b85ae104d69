// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/io/byte_stream.hpp>
#include <aib/io/bytes.hpp>
#include <aib/io/file.hpp>
#include <aib/io/file_kind.hpp>
#include <aib/io/numbers.hpp>
#include <aib/io/positions.hpp>
#include <aib/io/text.hpp>
#include <aib/mesh/mesh.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace aib::io {

/// Reads a binary or ascii STL file; which of them is told from the size, since binary files may
/// begin with "solid" too. Corners at the same place become one vertex. Normals are passed over.
///
/// Throws format_error where the file is damaged.
/// Source: 3D Systems, "StereoLithography Interface Specification".
mesh::mesh read_stl(const std::filesystem::path& path);

namespace detail {

/// Numbers equal corners alike: vertices in the order of their first use. At most 2^32 corners.
inline mesh::mesh weld(const std::vector<Eigen::Vector3f>& corners) {
  std::vector<std::uint32_t> order(corners.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](std::uint32_t i) {
    std::array<std::uint32_t, 4> k{0, 0, 0, i};  // bits, so that NaN has a place; ties by order
    for (int axis = 0; axis < 3; ++axis)
      k[static_cast<std::size_t>(axis)] = std::bit_cast<std::uint32_t>(corners[i][axis] + 0.0f);
    return k;
  };
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return key(a) < key(b); });
  std::vector<std::uint32_t> first(corners.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const auto here = key(order[i]);
    const bool same =
        i > 0 && std::equal(here.begin(), here.begin() + 3, key(order[i - 1]).begin());
    first[order[i]] = same ? first[order[i - 1]] : order[i];
  }
  mesh::mesh result;
  float_positions vertices;
  std::vector<std::uint32_t> number(corners.size());
  for (std::uint32_t i = 0; i < corners.size(); ++i) {
    if (first[i] == i) {
      number[i] = static_cast<std::uint32_t>(vertices.points.size());
      vertices.points.push_back(corners[i]);
    } else {
      number[i] = number[first[i]];
    }
  }
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
    result.triangles.push_back({number[i], number[i + 1], number[i + 2]});
  set_vertices(result, std::move(vertices));
  return result;
}

inline std::vector<Eigen::Vector3f> read_binary_stl(const input_file& file) {
  byte_stream in(file);
  in.skip(80, "stl: header");
  const auto n = in.read_number<std::uint32_t>("stl: number of triangles");
  in.demand(std::uint64_t{50} * n, "stl: triangles");
  std::vector<Eigen::Vector3f> corners;
  corners.reserve(std::size_t{3} * n);
  for (std::uint32_t i = 0; i < n; ++i) {
    const char* triangle = in.take(50, "stl: triangle") + 12;
    for (std::size_t k = 0; k < 3; ++k, triangle += 12)
      corners.emplace_back(load<float>(triangle), load<float>(triangle + 4),
                           load<float>(triangle + 8));
  }
  return corners;
}

inline std::vector<Eigen::Vector3f> read_ascii_stl(const std::filesystem::path& path) {
  const std::string text = read_file(path);
  line_reader lines(text, path);
  std::vector<Eigen::Vector3f> corners;
  bool in_facet = false;
  while (lines.next_content()) {
    std::string_view rest = trim(lines.line());
    const std::string word = lower_case(rest.substr(0, rest.find_first_of(" \t")));
    rest.remove_prefix(word.size());
    if (word == "vertex") {
      Eigen::Vector3f corner;
      for (int k = 0; k < 3; ++k) {
        const auto number = take_number(rest);
        if (!number || !in_facet) lines.fail("stl: a vertex of 3 numbers within a facet expected");
        corner[k] = static_cast<float>(*number);
      }
      corners.push_back(corner);
    } else if (word == "facet" || word == "endfacet") {
      if (in_facet == (word == "facet") || corners.size() % 3 != 0)
        lines.fail("stl: facets of 3 vertices expected");
      in_facet = word == "facet";
    } else if (word != "solid" && word != "outer" && word != "endloop" && word != "endsolid") {
      lines.fail(message("stl: facet, outer loop, vertex, endloop or endfacet expected, found \"",
                         word.substr(0, 40), "\""));
    }
  }
  if (in_facet) lines.fail("stl: the file ends within a facet");
  return corners;
}

}  // namespace detail

inline mesh::mesh read_stl(const std::filesystem::path& path) {
  const input_file file(path);
  constexpr std::uint64_t most = (std::uint64_t{1} << 32) / 3;  // corners have numbers of 32 bits
  if (file.size() / 50 > most)
    throw format_error(
        path, message("stl: at most ", most, " triangles of 50 bytes expected, found ", file.size(),
                      " bytes"));
  const std::string begin = file.begin(84);
  const bool is_ascii = !detail::is_binary_stl(begin, file.size()) &&
                        (begin.starts_with("solid") || begin.starts_with("SOLID"));
  return detail::weld(is_ascii ? detail::read_ascii_stl(path) : detail::read_binary_stl(file));
}

}  // namespace aib::io
