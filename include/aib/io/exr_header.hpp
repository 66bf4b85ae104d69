// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/io/byte_stream.hpp>
#include <aib/io/bytes.hpp>
#include <aib/io/file.hpp>
#include <aib/io/limits.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace aib::io {

enum class exr_pixel : std::int32_t { uint32 = 0, half = 1, float32 = 2 };

enum class exr_compression : std::uint8_t {
  none,
  rle,
  zips,
  zip,
  piz,
  pxr24,
  b44,
  b44a,
  dwaa,
  dwab
};

struct exr_channel_info {
  std::string name;
  exr_pixel type = exr_pixel::float32;
};

/// Rectangle of pixels, both corners within; y down.
struct exr_window {
  std::int32_t min_x = 0, min_y = 0, max_x = -1, max_y = -1;

  [[nodiscard]] std::size_t width() const {
    return static_cast<std::size_t>(std::int64_t{max_x} - min_x + 1);
  }
  [[nodiscard]] std::size_t height() const {
    return static_cast<std::size_t>(std::int64_t{max_y} - min_y + 1);
  }
  friend bool operator==(const exr_window&, const exr_window&) = default;
};

/// One of the images of a file; most files have one.
struct exr_part {
  std::string name = {};
  std::vector<exr_channel_info> channels = {};
  exr_compression compression = exr_compression::none;
  exr_window data = {};                         ///< pixels that are in the file
  exr_window display = {};                      ///< the picture that they are a part of
  std::size_t tile_width = 0, tile_height = 0;  ///< 0: scan lines
  std::uint64_t offsets_at = 0;                 ///< place of the table of blocks in the file

  [[nodiscard]] bool is_tiled() const { return tile_width > 0; }
  [[nodiscard]] std::size_t pixel_bytes() const {
    std::size_t n = 0;
    for (const exr_channel_info& c : channels) n += c.type == exr_pixel::half ? 2u : 4u;
    return n;
  }
};

struct exr_header {
  std::vector<exr_part> parts = {};
  bool is_multipart = false;  ///< blocks say which part they belong to
};

/// Reads and checks the header of an OpenEXR file. Throws format_error where it is damaged, where
/// the image is larger than the limits or than what the file can hold, and where it has what
/// aib does not read: deep data, sub-sampled channels. Source of the format: "OpenEXR File Layout",
/// openexr.com.
exr_header read_exr_header(const input_file& file, const limits& limits = {});

/// "ZIP" and the like.
[[nodiscard]] constexpr std::string_view name(exr_compression compression) {
  constexpr std::array<std::string_view, 10> names{"NONE",  "RLE", "ZIPS", "ZIP",  "PIZ",
                                                   "PXR24", "B44", "B44A", "DWAA", "DWAB"};
  return names[static_cast<std::size_t>(compression)];
}

/// What no codec that aib reads expands beyond: deflate makes 1032 bytes of one, and PXR24 four of
/// three.
inline constexpr std::uint64_t exr_best_ratio = 1376;

/// Scan lines in a block.
[[nodiscard]] constexpr std::size_t block_lines(exr_compression compression) {
  constexpr std::array<std::size_t, 10> lines{1, 1, 1, 16, 32, 16, 32, 32, 32, 256};
  return lines[static_cast<std::size_t>(compression)];
}

namespace detail {

class exr_header_parser {
 public:
  exr_header_parser(const input_file& file, const limits& limits)
      : file_(file), limits_(limits), stream_(file) {}

  exr_header parse() {
    constexpr std::uint32_t magic = 20000630;
    if (file_.size() < 8 || stream_.read_number<std::uint32_t>("exr: magic") != magic)
      throw format_error(file_.path(), "exr: not an OpenEXR file");
    parse_flags(stream_.read_number<std::uint32_t>("exr: version"));
    std::string attribute = take_name();
    do {
      if (header_.parts.size() == 4096) fail("exr: more than 4096 parts");
      parse_part(std::move(attribute));
    } while (header_.is_multipart && !(attribute = take_name()).empty());
    place_offsets();
    return std::move(header_);
  }

 private:
  void parse_flags(std::uint32_t version) {
    constexpr std::uint32_t tiled = 0x200, long_names = 0x400, deep = 0x800, multipart = 0x1000;
    if ((version & 0xff) != 2) fail(message("exr: version 2 expected, found ", version & 0xff));
    if ((version & ~(0xffu | tiled | long_names | deep | multipart)) != 0)
      fail("exr: unknown flags in the version");
    if ((version & deep) != 0)
      fail("exr: deep data are not supported; flatten the image and save it with ZIP");
    is_tiled_ = (version & tiled) != 0;
    header_.is_multipart = (version & multipart) != 0;
  }

  std::string take_name() { return stream_.take_name("exr: name of an attribute"); }

  void parse_part(std::string attribute) {
    exr_part part;
    seen_ = {};
    for (; !attribute.empty(); attribute = take_name()) {
      const std::string type = stream_.take_name("exr: type of an attribute");
      const auto size = stream_.read_number<std::int32_t>("exr: size of an attribute");
      if (size < 0) fail(message("exr: an attribute of ", size, " bytes"));
      const auto n = static_cast<std::size_t>(size);
      parse_attribute(part, attribute, type, {stream_.take(n, "exr: attribute"), n});
    }
    check(part);
    header_.parts.push_back(std::move(part));
  }

  struct seen_attributes {
    bool channels = false, compression = false, data = false, display = false, tiles = false;
    bool deep = false;
    std::int64_t n_blocks = -1;
  };

  void parse_attribute(exr_part& part,
                       std::string_view name,
                       std::string_view type,
                       std::string_view value) {
    byte_reader in(value, file_.path());
    const auto is = [&](std::string_view n, std::string_view t) { return name == n && type == t; };
    if (is("channels", "chlist")) {
      once(seen_.channels, name);
      parse_channels(part, in);
    } else if (is("compression", "compression")) {
      once(seen_.compression, name);
      const auto code = in.read<std::uint8_t>("exr: compression");
      if (code > static_cast<std::uint8_t>(exr_compression::dwab))
        fail(message("exr: unknown compression ", unsigned{code}));
      part.compression = static_cast<exr_compression>(code);
    } else if (is("dataWindow", "box2i")) {
      once(seen_.data, name);
      part.data = parse_window(in);
    } else if (is("displayWindow", "box2i")) {
      once(seen_.display, name);
      part.display = parse_window(in);
    } else if (is("tiles", "tiledesc")) {
      once(seen_.tiles, name);
      part.tile_width = in.read<std::uint32_t>("exr: tiles");
      part.tile_height = in.read<std::uint32_t>("exr: tiles");
    } else if (is("name", "string")) {
      part.name = value;
    } else if (is("type", "string")) {
      seen_.deep = value.starts_with("deep");
      if (header_.is_multipart) is_tiled_ = value == "tiledimage";
    } else if (is("chunkCount", "int")) {
      seen_.n_blocks = in.read<std::int32_t>("exr: chunkCount");
    }
  }

  void once(bool& seen, std::string_view name) const {
    if (std::exchange(seen, true)) fail(message("exr: the attribute ", name, " comes twice"));
  }

  void parse_channels(exr_part& part, byte_reader& in) {
    for (;;) {
      exr_channel_info channel;
      channel.name = in.read_name("exr: name of a channel");
      if (channel.name.empty()) return check_names(part);
      const auto type = in.read<std::int32_t>("exr: type of a channel");
      if (type < 0 || type > 2) fail(message("exr: channel ", channel.name, ": type ", type));
      channel.type = static_cast<exr_pixel>(type);
      in.take(4, "exr: channel");
      const auto x_sampling = in.read<std::int32_t>("exr: sampling of a channel");
      const auto y_sampling = in.read<std::int32_t>("exr: sampling of a channel");
      if (x_sampling != 1 || y_sampling != 1) {
        fail(message("exr: channel ", channel.name, " is sub-sampled (", x_sampling, "x",
                     y_sampling, "), which is not supported"));
      }
      part.channels.push_back(std::move(channel));
      if (part.channels.size() > 1024) fail("exr: more than 1024 channels");
    }
  }

  void check_names(const exr_part& part) const {
    std::vector<std::string_view> names;
    for (const exr_channel_info& channel : part.channels) names.push_back(channel.name);
    std::sort(names.begin(), names.end());
    const auto twice = std::adjacent_find(names.begin(), names.end());
    if (twice != names.end()) fail(message("exr: channel ", *twice, " comes twice"));
  }

  exr_window parse_window(byte_reader& in) {
    exr_window w;
    w.min_x = in.read<std::int32_t>("exr: window");
    w.min_y = in.read<std::int32_t>("exr: window");
    w.max_x = in.read<std::int32_t>("exr: window");
    w.max_y = in.read<std::int32_t>("exr: window");
    if (w.max_x < w.min_x || w.max_y < w.min_y)
      fail(message("exr: window (", w.min_x, ", ", w.min_y, ") to (", w.max_x, ", ", w.max_y,
                   ") is empty"));
    demand_pixels(file_.path(), "exr", w.width(), w.height(), limits_);
    return w;
  }

  void check(exr_part& part) {
    if (seen_.deep)
      fail("exr: deep data are not supported; flatten the image and save it with ZIP");
    if (!seen_.channels || part.channels.empty()) fail("exr: no channels in the header");
    if (!seen_.compression) fail("exr: no compression in the header");
    if (!seen_.data) fail("exr: no dataWindow in the header");
    if (!seen_.display) part.display = part.data;
    if (!is_tiled_) part.tile_width = part.tile_height = 0;
    if (is_tiled_ && (!seen_.tiles || part.tile_width == 0 || part.tile_height == 0 ||
                      part.tile_width > limits_.max_pixels / part.tile_height))
      fail("exr: no size of the tiles in the header");
    const std::uint64_t bytes = part.data.width() * part.data.height() * part.pixel_bytes();
    if (part.compression <= exr_compression::pxr24 && bytes / exr_best_ratio > file_.size())
      fail(message("exr: ", part.data.width(), "x", part.data.height(), " pixels of ",
                   part.pixel_bytes(), " bytes in a file of ", file_.size(), " bytes"));
    check_display(part);
    n_blocks_.push_back(block_count(part));
  }

  /// A display window far larger than its data is the memory of a picture that is not there.
  void check_display(const exr_part& part) {
    constexpr double small_picture = 1 << 24;
    const auto pixels = [](const exr_window& w) {
      return static_cast<double>(w.width()) * static_cast<double>(w.height());
    };
    const double shown = pixels(part.display);
    if (shown <= small_picture || shown <= limits_.max_ratio * pixels(part.data)) return;
    fail(message("exr: a display window of ", part.display.width(), "x", part.display.height(),
                 " around ", part.data.width(), "x", part.data.height(), " pixels, at most ",
                 limits_.max_ratio, " times as many are allowed (max_ratio)"));
  }

  std::uint64_t block_count(const exr_part& part) {
    const auto parts_of = [](std::size_t n, std::size_t size) { return (n + size - 1) / size; };
    const std::uint64_t needed = part.is_tiled()
                                     ? parts_of(part.data.width(), part.tile_width) *
                                           parts_of(part.data.height(), part.tile_height)
                                     : parts_of(part.data.height(), block_lines(part.compression));
    if (!header_.is_multipart) return needed;
    if (seen_.n_blocks < 0 || static_cast<std::uint64_t>(seen_.n_blocks) < needed)
      fail(message("exr: chunkCount of at least ", needed, " expected, found ", seen_.n_blocks));
    return static_cast<std::uint64_t>(seen_.n_blocks);
  }

  void place_offsets() {
    std::uint64_t at = stream_.offset();
    for (std::size_t i = 0; i < header_.parts.size(); ++i) {
      if (n_blocks_[i] > (file_.size() - at) / 8) {
        throw format_error(file_.path(), at_byte{at},
                           message("exr: ", n_blocks_[i], " blocks expected, ", file_.size() - at,
                                   " bytes left in the file"));
      }
      header_.parts[i].offsets_at = at;
      at += 8 * n_blocks_[i];
    }
  }

  [[noreturn]] void fail(std::string_view what) const { stream_.fail(what); }

  const input_file& file_;
  const limits& limits_;
  byte_stream stream_;
  exr_header header_;
  bool is_tiled_ = false;
  seen_attributes seen_;
  std::vector<std::uint64_t> n_blocks_;
};

}  // namespace detail

inline exr_header read_exr_header(const input_file& file, const limits& limits) {
  return detail::exr_header_parser(file, limits).parse();
}

}  // namespace aib::io
