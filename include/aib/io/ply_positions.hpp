// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/io/file.hpp>
#include <aib/io/ply.hpp>
#include <aib/io/ply_data.hpp>
#include <aib/io/ply_header.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace aib::io {

/// Walks the vertices of a binary PLY file block by block: for files larger than memory.
///
/// Throws format_error where the file is no binary PLY, is damaged, or holds Gaussian splats.
class ply_positions {
 public:
  explicit ply_positions(const std::filesystem::path& path)
      : file_(path),
        header_(read_ply_header(file_)),
        vertex_(detail::ply_vertex_element(header_, path)),
        data_(file_, header_.data_offset, detail::byte_order(header_.format)) {
    if (header_.format == ply_format::ascii)
      throw format_error(path, "ply: a binary file expected, found ascii");
    if (vertex_.find("f_dc_0") && vertex_.find("opacity"))
      throw format_error(path, "ply: a cloud expected, found 3D Gaussian splats");
    const auto columns = detail::find_scalars(vertex_, {"x", "y", "z"});
    if (!columns) throw format_error(path, "ply: element vertex has no properties x, y and z");
    columns_ = *columns;
    for (const ply_element& element : header_.elements) {
      if (&element == &vertex_) break;
      data_.skip(element);
    }
  }
  ply_positions(const ply_positions&) = delete;
  ply_positions& operator=(const ply_positions&) = delete;

  [[nodiscard]] std::uint64_t size() const { return vertex_.count; }

  /// Whether the file holds float: its points count from the world's origin.
  [[nodiscard]] bool is_float() const {
    return std::all_of(columns_.begin(), columns_.end(), [&](std::size_t i) {
      return vertex_.properties[i].type == ply_type::float32;
    });
  }

  /// Makes `block` the next up to 65 536 positions; false at the end.
  [[nodiscard]] bool next(std::vector<Eigen::Vector3d>& block) {
    const auto n = static_cast<std::size_t>(std::min<std::uint64_t>(size() - read_, 1 << 16));
    block.resize(n);
    if (n == 0) return false;
    if (vertex_.has_list()) {
      for (Eigen::Vector3d& p : block) p = next_row();
    } else {
      read_columns(block);
    }
    read_ += n;
    return true;
  }

 private:
  [[nodiscard]] Eigen::Vector3d next_row() {
    data_.read_row(vertex_, detail::no_list, row_);
    return {row_.values[columns_[0]], row_.values[columns_[1]], row_.values[columns_[2]]};
  }

  void read_columns(std::vector<Eigen::Vector3d>& block) {
    const std::size_t stride = vertex_.row_bytes();
    const char* rows = data_.stream()->take(block.size() * stride, vertex_.name);
    for (int axis = 0; axis < 3; ++axis) {
      const std::size_t column = columns_[static_cast<std::size_t>(axis)];
      const char* from = rows;
      for (std::size_t i = 0; i < column; ++i) from += size_of(vertex_.properties[i].type);
      with_type(vertex_.properties[column].type, [&]<class T>(std::type_identity<T>) {
        const std::endian order = detail::byte_order(header_.format);
        for (std::size_t i = 0; i < block.size(); ++i)
          block[i][axis] = static_cast<double>(load<T>(from + i * stride, order));
      });
    }
  }

  input_file file_;
  ply_header header_;
  const ply_element& vertex_;
  detail::ply_binary_data data_;
  detail::ply_triple columns_{};
  detail::ply_row row_;
  std::uint64_t read_ = 0;
};

}  // namespace aib::io
