// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/io/file.hpp>
#include <aib/io/npy.hpp>
#include <aib/raster/image.hpp>

#include "support/shared.hpp"

#ifdef AIB_WITH_NPZ
#include <aib/io/npz.hpp>
#endif

#ifdef AIB_WITH_PNG
#include <aib/io/png.hpp>
#endif

#include <aib/io/depth.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <optional>
#include <string>

/// Depth cases of the shared folder: pairs of maps with the numbers that NumPy and other projects
/// give for them.
namespace aib::golden {

inline raster::image<double> image_of(const io::array& a) {
  const auto values = a.values<double>();
  raster::image<double> image(a.shape.at(1), a.shape.at(0));
  std::copy(values.begin(), values.end(), image.begin());
  return image;
}

/// The map of a file, in double; nothing where its format is not built in.
inline std::optional<raster::image<double>> read_map(const std::string& name) {
  const auto path = support::shared() / "golden" / name;
  if (path.extension() == ".npy") return image_of(io::read_npy(path));
#ifdef AIB_WITH_NPZ
  if (path.extension() == ".npz") {
    const io::npz_file file(path);
    return image_of(file.read(file.names().front()));
  }
#endif
#ifdef AIB_WITH_PNG
  if (path.extension() == ".png") {  // millimetres; divided in double, as NumPy does
    const auto stored = io::read_png_gray(path);
    raster::image<double> image(stored.width(), stored.height());
    std::transform(stored.begin(), stored.end(), image.begin(),
                   [](auto mm) { return mm / 1000.0; });
    return image;
  }
#endif
#ifdef AIB_WITH_EXR
  if (path.extension() == ".exr" || path.extension() == ".pfm") {
    const auto map = io::read_depth(path).values;
    raster::image<double> image(map.width(), map.height());
    std::copy(map.begin(), map.end(), image.begin());
    return image;
  }
#endif
  return std::nullopt;
}

inline nlohmann::json read_case(const std::string& name) {
  return nlohmann::json::parse(
      io::read_file(support::shared() / "golden" / "depth" / ("expected_" + name + ".json")));
}

}  // namespace aib::golden
