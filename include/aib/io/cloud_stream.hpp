// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/cloud/cloud.hpp>
#include <aib/core/error.hpp>
#include <aib/io/ply_write.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>

namespace aib::io {

/// A cloud that is written piece by piece as binary little-endian PLY: memory does not grow with
/// it. x y z are doubles, since the pieces may have several origins.
///
///   io::cloud_stream out("all.ply");
///   for (...) out.add(sample::unproject(...).points);
///   out.commit();
///
/// Without `commit` the old file stays as it was.
class cloud_stream {
 public:
  /// Throws io_error where the file cannot be written.
  explicit cloud_stream(const std::filesystem::path& path) : out_(path) {}

  /// Adds points, in their order. The first piece that is not empty says what every point has
  /// (normals, colours, label); throws argument_error where a later one has something else.
  void add(const cloud::cloud& piece);

  [[nodiscard]] std::uint64_t size() const { return size_; }  ///< points added

  /// Makes it the file; nothing can be added afterwards.
  void commit();

 private:
  struct columns {
    bool normals, colors, labels;
    friend bool operator==(const columns&, const columns&) = default;
  };

  void begin(const cloud::cloud& piece);

  detail::ply_writer out_;
  std::optional<columns> columns_ = {};
  std::uint64_t size_ = 0;
};

inline void cloud_stream::begin(const cloud::cloud& piece) {
  out_.element_for_later("vertex");
  detail::cloud_properties(out_, detail::coordinate::wide, piece, piece.colors);
  out_.end_header();
}

inline void cloud_stream::add(const cloud::cloud& piece) {
  if (piece.empty()) return;
  detail::check_columns(piece, piece.colors);
  const columns found{!piece.normals.empty(), !piece.colors.empty(), !piece.labels.empty()};
  if (!columns_) {
    begin(piece);
    columns_ = found;
  }
  if (found != *columns_) {
    throw argument_error(
        "io::cloud_stream: a piece with the normals, colours and labels of the first expected, or "
        "without them where that had none");
  }
  for (std::size_t i = 0; i < piece.size(); ++i) {
    detail::cloud_row(out_, detail::coordinate::wide, piece, piece.colors, i);
    out_.end_row();
  }
  size_ += piece.size();
}

inline void cloud_stream::commit() {
  if (!columns_) begin({});
  out_.set_count("vertex", size_);
  out_.commit();
}

}  // namespace aib::io
