// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#include <aib/io/cloud.hpp>
#include <aib/io/cloud_stream.hpp>
#include <aib/io/depth.hpp>
#include <aib/io/frame_stack.hpp>
#include <aib/io/image.hpp>
#include <aib/io/limits.hpp>
#include <aib/io/mesh.hpp>
#include <aib/math/camera.hpp>
#include <aib/raster/color.hpp>
#include <aib/stats/quantiles.hpp>

#include "cloud.hpp"
#include "depth_reading.hpp"
#include "kit.hpp"
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace aib::bind {

namespace {

using std::filesystem::path;

io::up_axis up_option(options& o) {
  return o.choice("up", io::up_axis::z, {{"z", io::up_axis::z}, {"y", io::up_axis::y}});
}

/// How much a packed array, or a mesh that is repeated, may come to.
void packed_limits(options& o, io::limits& l) {
  l.max_ratio = o.number("max_ratio", l.max_ratio);
  l.max_bytes = o.count("max_bytes", l.max_bytes);
}

io::cloud_options cloud_options(options& o) {
  using enum io::splat_rule;
  io::cloud_options c;
  c.up = up_option(o);
  c.key = o.text("key", c.key);
  c.splats = o.choice("splats", c.splats, {{"refuse", refuse}, {"centres", centres}});
  c.limits.max_points = o.count("max_points", c.limits.max_points);
  packed_limits(o, c.limits);
  return c;
}

io::depth_options depth_options(options& o) {
  io::depth_options d = depth_values(o);
  if (const auto index = o.get<std::size_t>("index")) {
    if (*index == 0) o.reject("index", "frames count from 1");
    d.index = *index - 1;
  }
  d.width = o.count("width", d.width);
  d.height = o.count("height", d.height);
  d.rule = rule_option(o);
  d.raw_width = o.count("raw_width", d.raw_width);
  d.raw_height = o.count("raw_height", d.raw_height);
  if (const auto* camera = o.object<math::camera>("range_camera")) d.range_camera = *camera;
  d.limits.max_pixels = o.count("max_pixels", d.limits.max_pixels);
  packed_limits(o, d.limits);
  return d;
}

/// Columns that a script gives for a PLY file: `{ error = distances or list of numbers }`.
class scalar_columns {
 public:
  scalar_columns(options& o, const char* name) {
    const auto table = o.get<sol::table>(name);
    if (!table) return;
    for (const auto& [key, value] : *table) {
      const auto column = read_if<std::string>(key);
      auto numbers = values_in(value);
      if (!column || !numbers)
        o.reject(name, "a table from names to distances, offsets or lists of numbers expected");
      columns_.emplace(*column, std::move(*numbers));
    }
  }

  std::vector<io::ply_scalar> views() const {
    std::vector<io::ply_scalar> views;
    for (const auto& [name, values] : columns_) views.push_back({name, values});
    return views;
  }

 private:
  std::map<std::string, std::vector<float>> columns_;  ///< sorted, so that files are the same
};

std::vector<cloud::color> colors_option(options& o, const char* name) {
  std::vector<cloud::color> colors;
  const auto rows = o.get<std::vector<std::vector<std::uint8_t>>>(name);
  if (!rows) return colors;
  for (const auto& row : *rows) {
    if (row.size() != 3) o.reject(name, "a list of {red, green, blue}, each 0..255, expected");
    colors.push_back({row[0], row[1], row[2]});
  }
  return colors;
}

std::vector<std::string> comments_option(options& o) {
  return o.get<std::vector<std::string>>("comments").value_or(std::vector<std::string>());
}

template <class T>
sol::object as_object(lua_State* state, T value) {
  push(state, std::move(value));
  return sol::stack::pop<sol::object>(state);
}

/// Labels where the file holds one number a pixel, or where they are asked for; else colours.
sol::object read_picture(lua_State* state, const path& file, options& o) {
  enum class kind { automatic, labels, color };
  const auto as =
      o.choice("as", kind::automatic, {{"labels", kind::labels}, {"color", kind::color}});
  io::limits limits;
  limits.max_pixels = o.count("max_pixels", limits.max_pixels);
  o.done();
  const bool labels =
      as == kind::labels || (as == kind::automatic && io::is_label_image(file, limits));
  return labels ? as_object(state, io::read_labels(file, limits))
                : as_object(state, io::read_image(file, limits));
}

void write_picture(const path& file, const sol::object& image) {
  if (const auto* color = get_if<raster::color_image>(image))
    return io::write_image<raster::rgb>(file, *color);
  if (const auto* labels = get_if<raster::label_image>(image))
    return io::write_image<std::uint16_t>(file, *labels);
  throw argument_error("aib.io.write_image: argument 2 (image): image or label_image expected");
}

void bind_images(module& m) {
  m.function("read_image", {"path", "options"}, [](lua_State* state, const path& file, options& o) {
    return read_picture(state, file, o);
  });
  m.function("write_image", {"path", "image"},
             [](const path& file, const sol::object& image) { write_picture(file, image); });
}

void bind_readers(module& m) {
  m.function("read_cloud", {"path", "options"}, [](const path& file, options& o) {
    const auto read = cloud_options(o);
    o.done();
    return io::read_cloud(file, read);
  });
  m.function("read_mesh", {"path", "options"}, [](const path& file, options& o) {
    io::mesh_options read{.up = up_option(o)};
    read.limits.max_points = o.count("max_points", read.limits.max_points);
    packed_limits(o, read.limits);
    o.done();
    return io::read_mesh(file, read);
  });
  m.function("read_depth", {"path", "options"}, [](const path& file, options& o) {
    const auto read = depth_options(o);
    o.done();
    return io::read_depth(file, read);
  });
  m.function("read_stack", {"path", "options"}, [](const path& file, options& o) {
    const auto read = depth_options(o);
    o.done();
    return io::read_depth_stack(file, read);
  });
#if defined(AIB_WITH_EXR)
  m.function("exr_channels", {"path"},
             [](const path& file) { return io::exr_channel_names(file); });
#endif
}

std::string print_stack(const io::frame_stack& s) {
  return message("frame_stack(", s.size(), " frames of ", s.width(), "x", s.height(),
                 s.is_point_map() ? " points)" : ")");
}

/// A quantile of all finite numbers of all frames.
double quantile_of(io::frame_stack& stack, double q) {
  std::vector<float> values;
  for (std::size_t i = 0; i < stack.size(); ++i) {
    for (const float v : stack.frame(i)) {
      if (std::isfinite(v)) values.push_back(v);
    }
  }
  return stats::quantile_in_place<float>(values, q);
}

void bind_stacks(lua_State* state, module& m) {
  type<io::frame_stack>(state, "frame_stack", print_stack)
      .length([](const io::frame_stack& s) { return s.size(); })
      .element([](io::frame_stack& s, std::size_t i) { return depth::depth_map{s.frame(i)}; })
      .field("width", [](const io::frame_stack& s) { return s.width(); })
      .field("height", [](const io::frame_stack& s) { return s.height(); })
      .method("array", {"index"},
              [](io::frame_stack& s, std::size_t index) {
                if (index == 0) throw argument_error("frame_stack:array: frames count from 1");
                return s.at(index - 1);
              })
      .method("quantile", {"q"}, [](io::frame_stack& s, double q) { return quantile_of(s, q); });
  m.function("open_stack", {"path", "options"}, [](const path& file, options& o) {
    const std::string key = o.text("key", "");
    o.done();
    return io::frame_stack(file, key);
  });
}

struct cloud_writer {
  std::unique_ptr<io::cloud_stream> stream;
};

std::string print_cloud_writer(const cloud_writer& w) {
  return message("cloud_writer(", w.stream->size(), " points)");
}

void bind_cloud_writer(lua_State* state, module& m) {
  type<cloud_writer>(state, "cloud_writer", print_cloud_writer)
      .length([](const cloud_writer& w) { return static_cast<std::size_t>(w.stream->size()); })
      .method("add", {"cloud"},
              [](cloud_writer& w, const cloud::cloud& piece) {
                w.stream->add(piece);
                return self{};
              })
      .method("commit", {}, [](cloud_writer& w) { w.stream->commit(); });
  m.function("cloud_writer", {"path"}, [](const path& file) {
    return cloud_writer{std::make_unique<io::cloud_stream>(file)};
  });
}

void bind_writers(module& m) {
  m.function("write_cloud", {"path", "cloud", "options"},
             [](const path& file, const cloud::cloud& cloud, options& o) {
               const scalar_columns scalars(o, "scalars");
               const auto colors = colors_option(o, "colors");
               const auto comments = comments_option(o);
               o.done();
               io::write_cloud(
                   file, cloud,
                   {.scalars = scalars.views(), .colors = colors, .comments = comments});
             });
  m.function("write_mesh", {"path", "mesh", "options"},
             [](const path& file, const mesh::mesh& mesh, options& o) {
               const scalar_columns scalars(o, "face_scalars");
               const auto vertex_colors = colors_option(o, "vertex_colors");
               const auto face_colors = colors_option(o, "face_colors");
               const auto comments = comments_option(o);
               o.done();
               io::write_mesh(file, mesh,
                              {.vertex_colors = vertex_colors,
                               .face_colors = face_colors,
                               .face_scalars = scalars.views(),
                               .comments = comments});
             });
  m.function("write_depth", {"path", "depth", "options"},
             [](const path& file, const depth::depth_map& depth, options& o) {
               const io::depth_write_options write{.scale = o.number("scale", 1000)};
               o.done();
               io::write_depth(file, depth.values, write);
             });
}

}  // namespace

void bind_io_data(lua_State* state) {
  module m(state, "io");
  bind_readers(m);
  bind_stacks(state, m);
  bind_cloud_writer(state, m);
  bind_images(m);
  bind_writers(m);
}

}  // namespace aib::bind
