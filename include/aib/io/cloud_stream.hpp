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
  /// (normals, colours, label); throws argument_error where a later one has something else, or
  /// where the stream is closed: by commit, or by a piece that could not be written.
  void add(const cloud::cloud& piece);

  [[nodiscard]] std::uint64_t size() const { return size_; }  ///< points added

  /// Makes it the file and closes the stream.
  void commit();

 private:
  struct columns {
    bool normals, colors, labels;
    friend bool operator==(const columns&, const columns&) = default;
  };

  void demand_open() const;
  void begin(const cloud::cloud& piece);

  detail::ply_writer out_;
  bool is_open_ = true;
  std::optional<columns> columns_ = {};
  std::uint64_t size_ = 0;
};

inline void cloud_stream::demand_open() const {
  if (!is_open_) throw argument_error("io::cloud_stream: an open stream expected, this is closed");
}

inline void cloud_stream::begin(const cloud::cloud& piece) {
  out_.element_for_later("vertex");
  detail::cloud_properties(out_, detail::coordinate::wide, piece, piece.colors);
  out_.end_header();
}

inline void cloud_stream::add(const cloud::cloud& piece) {
  demand_open();
  if (piece.empty()) return;
  detail::check_columns(piece, piece.colors);
  const columns found{!piece.normals.empty(), !piece.colors.empty(), !piece.labels.empty()};
  if (columns_ && found != *columns_) {
    throw argument_error(
        "io::cloud_stream: a piece with the normals, colours and labels of the first expected, or "
        "without them where that had none");
  }
  is_open_ = false;  // until the piece is whole
  if (!columns_) begin(piece);
  columns_ = found;
  for (std::size_t i = 0; i < piece.size(); ++i) {
    detail::cloud_row(out_, detail::coordinate::wide, piece, piece.colors, i);
    out_.end_row();
  }
  size_ += piece.size();
  is_open_ = true;
}

inline void cloud_stream::commit() {
  demand_open();
  is_open_ = false;
  if (!columns_) begin({});
  out_.set_count("vertex", size_);
  out_.commit();
}

}  // namespace aib::io
