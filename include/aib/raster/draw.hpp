// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/raster/color.hpp>
#include <aib/raster/downsample.hpp>
#include <aib/raster/view.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace aib::raster {

/// Copies an image into another at (x, y); what lies outside is cut off.
inline void paste(color_image& onto, view<const rgb> image, std::size_t x, std::size_t y) {
  if (x >= onto.width()) return;
  const std::size_t width = std::min(image.width, onto.width() - x);
  for (std::size_t row = 0; row < image.height && y + row < onto.height(); ++row)
    std::copy_n(image.row(row).begin(), width, &onto(x, y + row));
}

/// Size of a character of draw_number with the gap behind it, at scale 1.
inline constexpr std::size_t character_width = 4;
inline constexpr std::size_t character_height = 5;

/// Writes a number into an image at (x, y), `scale` pixels a dot. Knows the characters
/// "0123456789.-+%"; others are blank. What lies outside is cut off.
void draw_number(color_image& onto,
                 std::string_view text,
                 std::size_t x,
                 std::size_t y,
                 const rgb& color,
                 std::size_t scale = 2);

/// Pictures in rows of `columns`, each shrunk (nearest neighbour) to `width` pixels in the shape of
/// the first, on white. No picture gives an empty image.
color_image contact_sheet(std::span<const color_image> pictures,
                          std::size_t columns,
                          std::size_t width);

namespace detail {

/// Rows of three dots, the highest row in the highest bits.
inline std::uint16_t dots_of(char c) {
  constexpr std::string_view known = "0123456789.-+%";
  constexpr std::array<std::uint16_t, 14> dots = {
      0b111'101'101'101'111, 0b010'110'010'010'111, 0b111'001'111'100'111, 0b111'001'111'001'111,
      0b101'101'111'001'001, 0b111'100'111'001'111, 0b111'100'111'101'111, 0b111'001'001'010'010,
      0b111'101'111'101'111, 0b111'101'111'001'111, 0b000'000'000'000'010, 0b000'000'111'000'000,
      0b000'010'111'010'000, 0b101'001'010'100'101};
  const std::size_t at = known.find(c);
  return at == std::string_view::npos ? std::uint16_t{0} : dots[at];
}

}  // namespace detail

inline void draw_number(color_image& onto,
                        std::string_view text,
                        std::size_t x,
                        std::size_t y,
                        const rgb& color,
                        std::size_t scale) {
  for (const char c : text) {
    const unsigned dots = detail::dots_of(c);
    for (std::size_t py = 0; py < 5 * scale; ++py) {
      for (std::size_t px = 0; px < 3 * scale; ++px) {
        const std::size_t bit = 14 - (3 * (py / scale) + px / scale);
        if ((dots >> bit & 1u) && x + px < onto.width() && y + py < onto.height())
          onto(x + px, y + py) = color;
      }
    }
    x += character_width * scale;
  }
}

inline color_image contact_sheet(std::span<const color_image> pictures,
                                 std::size_t columns,
                                 std::size_t width) {
  if (pictures.empty() || columns == 0 || width == 0) return {};
  constexpr std::size_t gap = 6;
  const color_image& first = pictures.front();
  const std::size_t height = std::max<std::size_t>(1, width * first.height() / first.width());
  columns = std::min(columns, pictures.size());
  const std::size_t rows = (pictures.size() + columns - 1) / columns;
  color_image sheet(columns * (width + gap) + gap, rows * (height + gap) + gap, {255, 255, 255});
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const color_image small = resample_nearest(pictures[i].view(), width, height);
    paste(sheet, small.view(), gap + i % columns * (width + gap),
          gap + i / columns * (height + gap));
  }
  return sheet;
}

}  // namespace aib::raster
