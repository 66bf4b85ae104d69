// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/io/bytes.hpp>
#include <aib/io/file.hpp>
#include <aib/io/limits.hpp>
#include <aib/io/npy.hpp>

#include <zlib.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace aib::io {

/// What an array is, without its elements.
struct array_info {
  dtype type = dtype::f8;
  std::vector<std::size_t> shape = {};
};

/// Where the bytes of a member lie in the file, as they are or deflated.
struct npz_place {
  std::uint64_t begin;
  std::uint64_t packed;
  bool is_deflated;
};

/// An NPZ file: a zip of NPY arrays, stored or deflated, also beyond 4 GB (zip64). Sizes and places
/// come from the central directory, contents are checked against their CRC-32. Members are read
/// when asked for; of two of the same name there is the last alone, as NumPy has it.
///
/// Needs zlib.
/// Source: PKWARE, APPNOTE.TXT 6.3.10; numpy.savez.
class npz_file {
 public:
  /// Throws io_error where the file cannot be opened, format_error where it is not a zip.
  explicit npz_file(const std::filesystem::path& path, const io::limits& limits = {});

  [[nodiscard]] const std::filesystem::path& path() const { return file_.path(); }

  /// Names of the arrays, without ".npy", in the order of the file.
  [[nodiscard]] std::vector<std::string> names() const;
  /// The same for a message: "a, b, c".
  [[nodiscard]] std::string list() const;
  [[nodiscard]] bool contains(std::string_view name) const { return find(name) != nullptr; }

  /// Reads an array. Throws argument_error where there is none of that name, format_error where it
  /// is damaged, encrypted, of another compression, or pickled.
  [[nodiscard]] array read(std::string_view name) const;

  /// Shape and type from the array's header alone.
  /// Throws as read does.
  [[nodiscard]] array_info read_header(std::string_view name) const;

  /// The same with where the elements begin.
  [[nodiscard]] detail::npy_header npy_header_of(std::string_view name) const;

  /// For readers of a part of a member. Throws as read does.
  [[nodiscard]] npz_place place_of(std::string_view name) const;

  /// Whether the member is no array of numbers (a pickled object for one) and thus never loaded.
  [[nodiscard]] bool is_unreadable(std::string_view name) const;

 private:
  struct member {
    std::string name;
    std::uint64_t offset = 0;  ///< of the local header
    std::uint64_t packed = 0;
    std::uint64_t size = 0;
    std::uint32_t crc = 0;
    std::uint16_t method = 0;
    bool encrypted = false;
  };
  struct directory {
    std::uint64_t offset;
    std::uint64_t bytes;
    std::uint64_t members;
  };

  [[nodiscard]] std::string part(std::uint64_t offset, std::uint64_t n) const;
  [[nodiscard]] directory find_directory() const;
  [[nodiscard]] directory find_directory64(std::uint64_t end) const;
  [[nodiscard]] static member read_entry(byte_reader& in);
  static void read_zip64(std::string_view extra,
                         member& m,
                         std::uint32_t packed,
                         std::uint32_t size,
                         std::uint32_t offset,
                         byte_reader& in);
  [[nodiscard]] const member* find(std::string_view name) const;
  [[nodiscard]] const member& get(std::string_view name) const;
  [[nodiscard]] std::uint64_t data_offset(const member& m) const;
  /// The first `n` bytes of a member's content.
  [[nodiscard]] std::string content(const member& m, std::uint64_t n) const;
  [[nodiscard]] std::string inflated(const member& m, std::uint64_t n) const;
  [[noreturn]] void fail(const member& m, std::string_view what) const;

  input_file file_;
  io::limits limits_;
  std::vector<member> members_;
  std::map<std::string, std::size_t, std::less<>> places_;  ///< of members_, by name
};

/// All arrays of an NPZ file by name are too much at once as a rule; this reads one.
[[nodiscard]] inline array read_npz(const std::filesystem::path& path, std::string_view name) {
  return npz_file(path).read(name);
}

namespace detail {

inline constexpr std::uint32_t zip_local = 0x04034b50;
inline constexpr std::uint32_t zip_central = 0x02014b50;
inline constexpr std::uint32_t zip_end = 0x06054b50;
inline constexpr std::uint32_t zip64_end = 0x06064b50;
inline constexpr std::uint32_t zip64_locator = 0x07064b50;
inline constexpr std::uint32_t in_zip64 = 0xffffffff;  ///< the true number is in the extra field

/// Inflates raw deflate data block by block.
class deflate_stream {
 public:
  deflate_stream() { ready_ = ::inflateInit2(&stream_, -MAX_WBITS) == Z_OK; }
  deflate_stream(const deflate_stream&) = delete;
  deflate_stream& operator=(const deflate_stream&) = delete;
  ~deflate_stream() { ::inflateEnd(&stream_); }

  void input(std::string_view packed) {
    stream_.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(packed.data()));
    stream_.avail_in = static_cast<uInt>(packed.size());
  }
  /// Fills `out` from `from` on as far as the input goes; false where the data is damaged.
  bool fill(std::string& out, std::size_t& from) {
    while (ready_ && !ended_ && from < out.size()) {
      const std::size_t room = std::min<std::size_t>(out.size() - from, 1u << 30);
      stream_.next_out = reinterpret_cast<Bytef*>(out.data() + from);
      stream_.avail_out = static_cast<uInt>(room);
      const int code = ::inflate(&stream_, Z_NO_FLUSH);
      from += room - stream_.avail_out;
      ended_ = code == Z_STREAM_END;
      if (code == Z_BUF_ERROR || (code == Z_OK && stream_.avail_in == 0)) return true;
      if (code != Z_OK && code != Z_STREAM_END) return false;
    }
    return ready_;
  }

 private:
  z_stream stream_ = {};
  bool ready_ = false;
  bool ended_ = false;
};

inline std::uint32_t crc32_of(std::string_view bytes) {
  uLong crc = ::crc32(0, nullptr, 0);
  while (!bytes.empty()) {
    const std::size_t n = std::min<std::size_t>(bytes.size(), 1u << 30);
    crc = ::crc32(crc, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(n));
    bytes.remove_prefix(n);
  }
  return static_cast<std::uint32_t>(crc);
}

}  // namespace detail

inline npz_file::npz_file(const std::filesystem::path& path, const io::limits& limits)
    : file_(path), limits_(limits) {
  const directory d = find_directory();
  const std::string bytes = part(d.offset, d.bytes);
  byte_reader in(bytes, path);
  constexpr std::size_t entry_bytes = 46;
  if (d.members > bytes.size() / entry_bytes)
    throw format_error(path, message("npz: ", d.members, " members do not fit in the directory"));
  for (std::uint64_t i = 0; i < d.members; ++i) {
    member m = read_entry(in);
    if (!m.name.ends_with(".npy")) continue;
    m.name.resize(m.name.size() - 4);
    const auto [known, is_new] = places_.try_emplace(m.name, members_.size());
    if (is_new) {
      members_.push_back(std::move(m));
    } else {
      members_[known->second] = std::move(m);
    }
  }
}

inline std::vector<std::string> npz_file::names() const {
  std::vector<std::string> names;
  for (const member& m : members_) names.push_back(m.name);
  return names;
}

inline std::string npz_file::list() const {
  std::string text;
  for (const member& m : members_) text += (text.empty() ? "" : ", ") + m.name;
  return text;
}

inline array npz_file::read(std::string_view name) const {
  const member& m = get(name);
  const std::filesystem::path inside = message(path().string(), "[", m.name, "]");
  std::string bytes = content(m, m.size);
  if (detail::crc32_of(bytes) != m.crc) fail(m, "the content does not fit its checksum");
  return parse_npy(std::move(bytes), inside);
}

inline array_info npz_file::read_header(std::string_view name) const {
  detail::npy_header header = npy_header_of(name);
  return {header.type, std::move(header.shape)};
}

inline npz_place npz_file::place_of(std::string_view name) const {
  const member& m = get(name);
  static_cast<void>(content(m, std::min<std::uint64_t>(m.size, 1)));  // checks all but the end
  const std::uint64_t begin = data_offset(m);
  if (begin > file_.size() || m.packed > file_.size() - begin) fail(m, "cut off");
  return {begin, m.packed, m.method != 0};
}

inline detail::npy_header npz_file::npy_header_of(std::string_view name) const {
  const member& m = get(name);
  const std::filesystem::path inside = message(path().string(), "[", m.name, "]");
  const auto preamble =
      detail::read_npy_preamble(content(m, std::min<std::uint64_t>(m.size, 12)), inside);
  const std::uint64_t n = std::min<std::uint64_t>(m.size, preamble.text_begin + preamble.text_size);
  return detail::read_npy_header(content(m, n), m.size, inside);
}

inline bool npz_file::is_unreadable(std::string_view name) const {
  try {
    static_cast<void>(read_header(name));
    return false;
  } catch (const format_error&) {
    return true;
  }
}

inline std::string npz_file::part(std::uint64_t offset, std::uint64_t n) const {
  if (offset > file_.size() || n > file_.size() - offset) {
    throw format_error(path(), message("npz: bytes ", offset, " to ", offset + n,
                                       " expected, the file has ", file_.size()));
  }
  std::string bytes(static_cast<std::size_t>(n), '\0');
  file_.read_at(offset, bytes.data(), bytes.size());
  return bytes;
}

inline npz_file::directory npz_file::find_directory() const {
  constexpr std::uint64_t end_bytes = 22;
  constexpr std::uint64_t max_comment = 65535;
  const std::uint64_t tail = std::min(file_.size(), end_bytes + max_comment);
  const std::uint64_t begin = file_.size() - tail;
  const std::string bytes = part(begin, tail);
  const std::size_t at = bytes.rfind("PK\x05\x06");
  if (at == std::string::npos || tail - at < end_bytes)
    throw format_error(path(), "npz: not a zip file, or cut off: no end of the central directory");
  byte_reader in(std::string_view(bytes).substr(at + 8), path());
  in.read<std::uint16_t>("npz: members");
  const auto members = in.read<std::uint16_t>("npz: members");
  const auto size = in.read<std::uint32_t>("npz: directory size");
  const auto offset = in.read<std::uint32_t>("npz: directory offset");
  if (members == 0xffff || size == detail::in_zip64 || offset == detail::in_zip64)
    return find_directory64(begin + at);
  return {offset, size, members};
}

inline npz_file::directory npz_file::find_directory64(std::uint64_t end) const {
  constexpr std::uint64_t locator_bytes = 20;
  if (end < locator_bytes) throw format_error(path(), "npz: zip64 locator expected");
  const std::string bytes = part(end - locator_bytes, locator_bytes);
  byte_reader locator(bytes, path());
  if (locator.read<std::uint32_t>("npz: zip64 locator") != detail::zip64_locator)
    throw format_error(path(), at_byte{end - locator_bytes}, "npz: zip64 locator expected");
  locator.read<std::uint32_t>("npz: disk");
  const auto at = locator.read<std::uint64_t>("npz: zip64 end");
  const std::string record = part(at, 56);
  byte_reader in(record, path());
  if (in.read<std::uint32_t>("npz: zip64 end") != detail::zip64_end)
    throw format_error(path(), at_byte{at}, "npz: zip64 end of the central directory expected");
  in.take(28, "npz: zip64 end");
  const auto members = in.read<std::uint64_t>("npz: members");
  const auto size = in.read<std::uint64_t>("npz: directory size");
  return {in.read<std::uint64_t>("npz: directory offset"), size, members};
}

inline npz_file::member npz_file::read_entry(byte_reader& in) {
  if (in.read<std::uint32_t>("npz: entry") != detail::zip_central)
    in.fail("npz: an entry of the central directory expected");
  member m;
  in.take(4, "npz: versions");
  m.encrypted = (in.read<std::uint16_t>("npz: flags") & 1) != 0;
  m.method = in.read<std::uint16_t>("npz: method");
  in.take(4, "npz: time");
  m.crc = in.read<std::uint32_t>("npz: checksum");
  const auto packed = in.read<std::uint32_t>("npz: packed size");
  const auto size = in.read<std::uint32_t>("npz: size");
  const auto name_bytes = in.read<std::uint16_t>("npz: name length");
  const auto extra_bytes = in.read<std::uint16_t>("npz: extra length");
  const auto comment_bytes = in.read<std::uint16_t>("npz: comment length");
  in.take(8, "npz: attributes");
  const auto offset = in.read<std::uint32_t>("npz: offset");
  m.name = in.take(name_bytes, "npz: name");
  read_zip64(in.take(extra_bytes, "npz: extra field"), m, packed, size, offset, in);
  in.take(comment_bytes, "npz: comment");
  return m;
}

inline void npz_file::read_zip64(std::string_view extra,
                                 member& m,
                                 std::uint32_t packed,
                                 std::uint32_t size,
                                 std::uint32_t offset,
                                 byte_reader& in) {
  m.packed = packed;
  m.size = size;
  m.offset = offset;
  while (extra.size() >= 4) {
    const auto id = load<std::uint16_t>(extra.data());
    const auto bytes = load<std::uint16_t>(extra.data() + 2);
    std::string_view field = extra.substr(4, bytes);
    extra.remove_prefix(std::min<std::size_t>(extra.size(), 4u + bytes));
    if (id != 1) continue;
    for (auto* value : {size == detail::in_zip64 ? &m.size : nullptr,
                        packed == detail::in_zip64 ? &m.packed : nullptr,
                        offset == detail::in_zip64 ? &m.offset : nullptr}) {
      if (value == nullptr) continue;
      if (field.size() < 8) in.fail("npz: the zip64 extra field is too short");
      *value = load<std::uint64_t>(field.data());
      field.remove_prefix(8);
    }
  }
}

inline const npz_file::member* npz_file::find(std::string_view name) const {
  const auto place = places_.find(name);
  return place == places_.end() ? nullptr : &members_[place->second];
}

inline const npz_file::member& npz_file::get(std::string_view name) const {
  if (const member* m = find(name)) return *m;
  throw argument_error(
      message(path().string(), ": npz: no array '", name, "'; there are: ", list()));
}

inline std::uint64_t npz_file::data_offset(const member& m) const {
  constexpr std::uint64_t local_bytes = 30;
  const std::string bytes = part(m.offset, local_bytes);
  byte_reader in(bytes, path());
  if (in.read<std::uint32_t>("npz: local header") != detail::zip_local)
    fail(m, message("no local header at byte ", m.offset));
  in.take(22, "npz: local header");
  const auto name_bytes = in.read<std::uint16_t>("npz: name length");
  const auto extra_bytes = in.read<std::uint16_t>("npz: extra length");
  return m.offset + local_bytes + name_bytes + extra_bytes;
}

inline std::string npz_file::content(const member& m, std::uint64_t n) const {
  constexpr std::uint16_t stored = 0;
  constexpr std::uint16_t deflated = 8;
  if (m.encrypted) fail(m, "encrypted");
  if (m.method == deflated) return inflated(m, n);
  if (m.method != stored)
    fail(m, message("compression method ", m.method, " is not supported; 0 and 8 are"));
  if (m.packed != m.size) fail(m, "stored, but of two sizes");
  return part(data_offset(m), n);
}

inline std::string npz_file::inflated(const member& m, std::uint64_t n) const {
  constexpr std::uint64_t best_ratio = 1032;  // of deflate
  const std::uint64_t begin = data_offset(m);
  if (begin > file_.size() || m.packed > file_.size() - begin) fail(m, "cut off");
  const double ratio = static_cast<double>(m.size) / static_cast<double>(m.packed + 1);
  if (m.size / best_ratio > m.packed || (ratio > limits_.max_ratio && m.size > limits_.max_bytes)) {
    fail(m, message("inflates from ", m.packed, " to ", m.size, " bytes, which no array does"));
  }
  std::string out(static_cast<std::size_t>(n), '\0');
  std::size_t filled = 0;
  detail::deflate_stream stream;
  constexpr std::uint64_t block_bytes = std::uint64_t{1} << 20;
  for (std::uint64_t at = 0; at < m.packed && filled < out.size();) {
    const std::string block = part(begin + at, std::min(block_bytes, m.packed - at));
    stream.input(block);
    if (!stream.fill(out, filled)) fail(m, "the deflated data is damaged");
    at += block.size();
  }
  if (filled < out.size())
    fail(m, message(out.size(), " bytes expected, the deflated data holds ", filled));
  return out;
}

inline void npz_file::fail(const member& m, std::string_view what) const {
  throw format_error(path(), message("npz: '", m.name, "': ", what));
}

}  // namespace aib::io
