// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
#pragma once

#include <aib/core/error.hpp>
#include <aib/io/file.hpp>
#include <aib/io/limits.hpp>
#include <aib/raster/color.hpp>

#include <csetjmp>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <jpeglib.h>
#include <string>

namespace aib::io {

namespace detail {

/// libjpeg reports an error by a call that must not return: it jumps back into `run`.
class jpeg_decoder {
 public:
  explicit jpeg_decoder(const std::string& bytes) {
    info_.err = jpeg_std_error(&errors_.base);
    errors_.base.error_exit = [](j_common_ptr info) {
      info->err->format_message(info, errors_of(info).text);
      std::longjmp(errors_of(info).back, 1);
    };
    errors_.base.emit_message = [](j_common_ptr info, int level) {
      if (level < 0)
        info->err->error_exit(info);  // a warning: damage that libjpeg would paint over
    };
    jpeg_create_decompress(&info_);
    info_.progress = &monitor_;
    monitor_.progress_monitor = [](j_common_ptr info) {
      constexpr int most_scans = 100;  // of progressive pictures; a few bytes each make a bomb
      if (reinterpret_cast<j_decompress_ptr>(info)->input_scan_number <= most_scans) return;
      std::strcpy(errors_of(info).text, "more than 100 scans");
      std::longjmp(errors_of(info).back, 1);
    };
    bytes_ = reinterpret_cast<const unsigned char*>(bytes.data());
    n_bytes_ = bytes.size();
  }
  ~jpeg_decoder() { jpeg_destroy_decompress(&info_); }
  jpeg_decoder(const jpeg_decoder&) = delete;
  jpeg_decoder& operator=(const jpeg_decoder&) = delete;

  /// False where libjpeg gave up; `error` says why.
  bool read_header() {
    // Nothing with a destructor lives on this frame: longjmp would not run it.
    if (setjmp(errors_.back) != 0) return false;
    jpeg_mem_src(&info_, bytes_, n_bytes_);
    jpeg_read_header(&info_, TRUE);
    info_.out_color_space = JCS_RGB;
    return true;
  }

  bool read_pixels(unsigned char* to) {
    if (setjmp(errors_.back) != 0) return false;
    jpeg_start_decompress(&info_);
    while (info_.output_scanline < info_.output_height) {
      JSAMPROW row = to + std::size_t{3} * info_.output_width * info_.output_scanline;
      jpeg_read_scanlines(&info_, &row, 1);
    }
    jpeg_finish_decompress(&info_);
    return true;
  }

  [[nodiscard]] std::size_t width() const { return info_.image_width; }
  [[nodiscard]] std::size_t height() const { return info_.image_height; }
  [[nodiscard]] const char* error() const { return errors_.text; }

 private:
  struct error_manager {
    jpeg_error_mgr base;
    std::jmp_buf back;
    char text[JMSG_LENGTH_MAX] = {};
  };
  static error_manager& errors_of(j_common_ptr info) {
    return *reinterpret_cast<error_manager*>(info->err);
  }
  jpeg_decompress_struct info_ = {};
  error_manager errors_ = {};
  jpeg_progress_mgr monitor_ = {};
  const unsigned char* bytes_ = nullptr;
  std::size_t n_bytes_ = 0;
};

}  // namespace detail

/// Reads a JPEG as 8-bit red, green, blue. Needs libjpeg (libjpeg-turbo).
/// Throws format_error where the file is damaged or larger than the limits.
inline raster::color_image read_jpeg(const std::filesystem::path& path, const limits& limits = {}) {
  const std::string bytes = read_file(path);
  detail::jpeg_decoder decoder(bytes);
  if (!decoder.read_header()) throw format_error(path, message("jpeg: ", decoder.error()));
  demand_pixels(path, "jpeg", decoder.width(), decoder.height(), limits);
  // A block of 8 x 8 pixels takes a bit at least.
  if (decoder.width() * decoder.height() / 512 > bytes.size())
    throw format_error(path, message("jpeg: ", decoder.width(), "x", decoder.height(),
                                     " pixels in a file of ", bytes.size(), " bytes"));
  raster::color_image image(decoder.width(), decoder.height());
  if (!decoder.read_pixels(image.data()->data()))
    throw format_error(path, message("jpeg: ", decoder.error()));
  return image;
}

}  // namespace aib::io
