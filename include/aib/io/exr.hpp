// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/depth/depth_map.hpp>
#include <aib/io/exr_channel.hpp>
#include <aib/io/exr_header.hpp>
#include <aib/io/exr_predictor.hpp>
#include <aib/io/file.hpp>
#include <aib/io/limits.hpp>
#include <aib/raster/downsample.hpp>
#include <aib/raster/image.hpp>
#include <aib/raster/view.hpp>

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace aib::io {

struct exr_options {
  std::string channel = {};  ///< name of the channel; empty: chosen, see read_exr
  double max_depth = 1e9;    ///< this and beyond is background
  /// Size of the result, by nearest neighbour; 0: that of the file. Only the lines that are needed
  /// are decoded.
  std::size_t width = 0, height = 0;
  raster::nearest_rule rule = raster::nearest_rule::centre;
  io::limits limits = {};
};

/// Reads a depth map from an OpenEXR file.
///
/// The channel: the one that is named; else `*.Depth.Z`, `Z`, `*.V` or `V`, `Y`; else R where R, G
/// and B are equal; else the only one. Channels of a part with a name may be named with it:
/// `part.channel`.
/// The data window is pasted into the display window; pixels outside of it are 0. Background
/// becomes 0: max_depth (Blender's 1e10) and beyond, infinity, and 65504 in half channels. Half
/// channels hold 11 bits, 1.6 cm at 20 m: the warnings say so.
///
/// Throws format_error where the file is damaged, has no such channel, or has what aib does not
/// read (see read_exr_header, read_exr_channel).
depth::depth_map read_exr(const std::filesystem::path& path, const exr_options& options = {});

/// Names of all channels, with the name of their part where it has one.
/// Throws format_error where the header is damaged.
std::vector<std::string> exr_channel_names(const std::filesystem::path& path);

struct exr_write_options {
  std::string channel = "Z";
  exr_compression compression = exr_compression::zip;  ///< none, zips or zip
};

/// Writes one float channel as scan lines. Throws argument_error for an empty image or another
/// compression, io_error where the file cannot be written.
void write_exr(const std::filesystem::path& path,
               raster::view<const float> depth,
               const exr_write_options& options = {});

namespace detail {

struct exr_choice {
  std::size_t part;
  std::size_t channel;
  bool is_gray = false;  ///< R, of which G and B must be copies
};

/// Finds the channel that holds depth.
class exr_chooser {
 public:
  exr_chooser(const exr_header& header, const std::filesystem::path& path) : path_(path) {
    for (std::size_t p = 0; p < header.parts.size(); ++p) {
      const exr_part& part = header.parts[p];
      for (std::size_t c = 0; c < part.channels.size(); ++c) {
        const std::string& plain = part.channels[c].name;
        candidates_.push_back({plain, part.name.empty() ? plain : part.name + "." + plain, {p, c}});
      }
    }
  }

  exr_choice choose(std::string_view wanted) const {
    if (!wanted.empty()) return named(wanted);
    const auto full = [](std::string_view end) {
      return [=](const candidate& c) { return has_last(c.full, end); };
    };
    const auto plain = [](std::string_view name) {
      return [=](const candidate& c) { return c.plain == name; };
    };
    if (const auto found = first(full("Depth.Z"))) return *found;
    if (const auto found = first(plain("Z"))) return *found;
    if (const auto found = first(full("V"))) return *found;
    if (const auto found = first(plain("Y"))) return *found;
    if (candidates_.size() == 1) return candidates_[0].place;
    const auto r = first(plain("R")), g = first(plain("G")), b = first(plain("B"));
    if (r && g && b && r->part == g->part && r->part == b->part) return {r->part, r->channel, true};
    throw format_error(path_, message("exr: no channel looks like depth; name one of ", names()));
  }

  std::string names() const {
    std::string list;
    for (std::size_t i = 0; i < candidates_.size() && i < 20; ++i)
      list += (i == 0 ? "" : ", ") + candidates_[i].full;
    return candidates_.size() > 20 ? list + ", ..." : list;
  }

 private:
  struct candidate {
    std::string plain;
    std::string full;  ///< with the name of its part
    exr_choice place;
  };

  /// Whether the name is `end` or its last layer is: "a.Depth.Z" has the last "Depth.Z".
  static bool has_last(std::string_view name, std::string_view end) {
    return name == end || (name.size() > end.size() && name.ends_with(end) &&
                           name[name.size() - end.size() - 1] == '.');
  }

  template <class Predicate>
  std::optional<exr_choice> first(Predicate predicate) const {
    const auto found = std::find_if(candidates_.begin(), candidates_.end(), predicate);
    return found == candidates_.end() ? std::nullopt : std::optional(found->place);
  }

  exr_choice named(std::string_view wanted) const {
    if (const auto found = first([&](const candidate& c) { return c.full == wanted; }))
      return *found;
    if (const auto found = first([&](const candidate& c) { return c.plain == wanted; }))
      return *found;
    throw format_error(path_, message("exr: no channel \"", wanted, "\"; there are ", names()));
  }

  const std::filesystem::path& path_;
  std::vector<candidate> candidates_;
};

/// Source line in the data window for each target line; lines outside of it have none.
struct exr_rows {
  std::vector<std::size_t> lines;   ///< wanted lines of the data window, ascending
  std::vector<std::size_t> target;  ///< the target line of each
};

inline exr_rows needed_rows(const exr_part& part, std::size_t height, raster::nearest_rule rule) {
  exr_rows rows;
  for (std::size_t y = 0; y < height; ++y) {
    const auto line =
        static_cast<std::int64_t>(raster::nearest_index(y, part.display.height(), height, rule)) +
        part.display.min_y - part.data.min_y;
    if (line < 0 || line >= static_cast<std::int64_t>(part.data.height())) continue;
    rows.lines.push_back(static_cast<std::size_t>(line));
    rows.target.push_back(y);
  }
  return rows;
}

/// A channel within its display window at the size that is asked for.
inline raster::image<float> read_exr_picture(const input_file& file,
                                             const exr_header& header,
                                             const exr_choice& choice,
                                             const exr_options& options) {
  const exr_part& part = header.parts[choice.part];
  const std::size_t full_width = part.display.width(), full_height = part.display.height();
  const std::size_t width = options.width ? options.width : full_width;
  const std::size_t height = options.height ? options.height : full_height;
  if (part.data == part.display && width == full_width && height == full_height)
    return read_exr_channel(file, header, choice.part, choice.channel);

  raster::image<float> result(width, height);
  const exr_rows rows = needed_rows(part, height, options.rule);
  if (rows.lines.empty()) return result;
  const auto source = read_exr_channel(file, header, choice.part, choice.channel, rows.lines);
  for (std::size_t x = 0; x < width; ++x) {
    const auto column =
        static_cast<std::int64_t>(raster::nearest_index(x, full_width, width, options.rule)) +
        part.display.min_x - part.data.min_x;
    if (column < 0 || column >= static_cast<std::int64_t>(source.width())) continue;
    for (std::size_t i = 0; i < rows.target.size(); ++i)
      result(x, rows.target[i]) = source(static_cast<std::size_t>(column), i);
  }
  return result;
}

/// Sets pixels of `from` and beyond to 0 and counts them.
inline std::size_t clear_background(raster::image<float>& image, float from) {
  std::size_t n = 0;
  for (float& depth : image) {
    const bool background = depth >= from;
    n += background ? 1u : 0u;
    depth = background ? 0.0f : depth;
  }
  return n;
}

}  // namespace detail

inline std::vector<std::string> exr_channel_names(const std::filesystem::path& path) {
  std::vector<std::string> names;
  for (const exr_part& part : read_exr_header(input_file(path)).parts) {
    for (const exr_channel_info& channel : part.channels)
      names.push_back(part.name.empty() ? channel.name : part.name + "." + channel.name);
  }
  return names;
}

inline depth::depth_map read_exr(const std::filesystem::path& path, const exr_options& options) {
  const input_file file(path);
  const exr_header header = read_exr_header(file, options.limits);
  const detail::exr_chooser chooser(header, path);
  const detail::exr_choice choice = chooser.choose(options.channel);
  const exr_part& part = header.parts[choice.part];
  const exr_channel_info& channel = part.channels[choice.channel];

  depth::depth_map result{detail::read_exr_picture(file, header, choice, options)};
  if (choice.is_gray) {
    for (const char* other : {"G", "B"}) {
      auto same = options;
      same.channel = other;
      if (detail::read_exr_picture(file, header, chooser.choose(other), same) != result.values)
        throw format_error(path, message("exr: R, G and B differ, this is no depth; name one of ",
                                         chooser.names()));
    }
  }
  const bool is_half = channel.type == exr_pixel::half;
  const double limit = is_half ? std::min(options.max_depth, 65504.0) : options.max_depth;
  const std::size_t n = detail::clear_background(result.values, static_cast<float>(limit));
  if (n > 0) {
    result.warnings.push_back(
        message(n, " of ", result.values.size(), " pixels are background (depth >= ", limit, ")"));
  }
  if (is_half) {
    result.warnings.push_back(
        message("channel ", channel.name, " is half: 11 bits, 1.6 cm at a depth of 20 m"));
  }
  if (part.data != part.display)
    result.warnings.push_back("the data window is not the display window; it was pasted");
  return result;
}

namespace detail {

/// Header and blocks of a file with one float channel.
class exr_writer {
 public:
  exr_writer(raster::view<const float> depth, const exr_write_options& options)
      : depth_(depth), options_(options) {}

  std::string bytes() {
    write_header();
    const std::size_t lines = block_lines(options_.compression);
    const std::size_t n_blocks = (depth_.height + lines - 1) / lines;
    const std::size_t table = out_.size();
    out_.resize(table + 8 * n_blocks);
    for (std::size_t i = 0; i < n_blocks; ++i) {
      std::string offset;
      store(offset, static_cast<std::uint64_t>(out_.size()));
      out_.replace(table + 8 * i, 8, offset);
      write_block(i * lines, std::min(lines, depth_.height - i * lines));
    }
    return std::move(out_);
  }

 private:
  void write_header() {
    const auto w = static_cast<std::int32_t>(depth_.width - 1);
    const auto h = static_cast<std::int32_t>(depth_.height - 1);
    store(out_, std::uint32_t{20000630});
    store(out_, std::uint32_t{2});
    attribute("channels", "chlist", channel_list());
    attribute("compression", "compression",
              std::string(1, static_cast<char>(options_.compression)));
    const std::string window = numbers<std::int32_t>({0, 0, w, h});
    attribute("dataWindow", "box2i", window);
    attribute("displayWindow", "box2i", window);
    attribute("lineOrder", "lineOrder", std::string(1, '\0'));
    attribute("pixelAspectRatio", "float", numbers({1.0f}));
    attribute("screenWindowCenter", "v2f", numbers({0.0f, 0.0f}));
    attribute("screenWindowWidth", "float", numbers({1.0f}));
    out_ += '\0';
  }

  std::string channel_list() const {
    std::string list = options_.channel + '\0';
    list += numbers<std::int32_t>({static_cast<std::int32_t>(exr_pixel::float32), 0, 1, 1});
    return list + '\0';
  }

  template <class T>
  static std::string numbers(std::initializer_list<T> values) {
    std::string bytes;
    for (const T v : values) store(bytes, v);
    return bytes;
  }

  void attribute(std::string_view name, std::string_view type, const std::string& value) {
    out_.append(name) += '\0';
    out_.append(type) += '\0';
    store(out_, static_cast<std::int32_t>(value.size()));
    out_ += value;
  }

  void write_block(std::size_t y, std::size_t n) {
    raw_.clear();
    for (std::size_t i = 0; i < n; ++i)
      for (const float depth : depth_.row(y + i)) store(raw_, depth);
    std::string_view block = raw_;
    if (options_.compression != exr_compression::none && compress_raw()) block = packed_;
    store(out_, static_cast<std::int32_t>(y));
    store(out_, static_cast<std::int32_t>(block.size()));
    out_ += block;
  }

  /// Whether the block became smaller.
  bool compress_raw() {
    std::vector<std::uint8_t> differences(raw_.size());
    take_differences(reinterpret_cast<const std::uint8_t*>(raw_.data()), differences.data(),
                     raw_.size());
    uLongf size = compressBound(static_cast<uLong>(raw_.size()));
    packed_.resize(size);
    const int code = compress2(reinterpret_cast<Bytef*>(packed_.data()), &size, differences.data(),
                               static_cast<uLong>(raw_.size()), 4);
    packed_.resize(code == Z_OK ? size : 0);
    return code == Z_OK && packed_.size() < raw_.size();
  }

  raster::view<const float> depth_;
  const exr_write_options& options_;
  std::string out_;
  std::string raw_;
  std::string packed_;
};

}  // namespace detail

inline void write_exr(const std::filesystem::path& path,
                      raster::view<const float> depth,
                      const exr_write_options& options) {
  if (depth.empty() || depth.size() > limits{}.max_pixels)
    throw argument_error(message("io::write_exr: an image of ", depth.width, "x", depth.height));
  if (options.compression != exr_compression::none &&
      options.compression != exr_compression::zips && options.compression != exr_compression::zip)
    throw argument_error("io::write_exr: compression none, zips or zip expected");
  if (options.channel.empty() || options.channel.size() > 31)
    throw argument_error("io::write_exr: a channel name of 1 to 31 characters expected");
  write_file(path, detail::exr_writer(depth, options).bytes());
}

}  // namespace aib::io
