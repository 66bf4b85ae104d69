// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/io/file_kind.hpp>
#include <aib/io/image.hpp>
#include <aib/raster/color.hpp>
#include <aib/survey/sensor_noise.hpp>

#include <array>
#include <cstdint>
#include <filesystem>

namespace aib::stream {

/// Adds the noise of a sensor to a picture and writes it as PNG. A PNG of 16 bits stays one; all
/// others have 8. Throws as io::read_image, io::write_image and survey::sensor_noise do.
inline void noisy_image(const std::filesystem::path& from,
                        const std::filesystem::path& to,
                        const survey::sensor_noise_options& options = {}) {
#if defined(AIB_WITH_PNG)
  if (io::kind_of(from) == io::file_kind::png && io::read_png_header(from).bits == 16) {
    using deep = std::array<std::uint16_t, 3>;
    const auto picture = io::read_png_color16(from);
    return io::write_image<deep>(to, survey::sensor_noise<deep>(picture.view(), options));
  }
#endif
  const raster::color_image picture = io::read_image(from);
  io::write_image<raster::rgb>(to, survey::sensor_noise<raster::rgb>(picture.view(), options));
}

}  // namespace aib::stream
