// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Writes depth images as others do.
#pragma once

#include <cstdint>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

#include <png.h>

namespace repel::percepts::test {

/// Writes one channel of 16 or 8 bits. @param pixels row by row
inline void write_png(const std::string& path, int width, int height,
                      const std::vector<std::uint16_t>& pixels, int bits = 16) {
  std::FILE* const file = std::fopen(path.c_str(), "wb");
  if (file == nullptr) throw std::runtime_error("cannot write " + path);
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_init_io(png, file);
  png_set_compression_level(png, 1);
  png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), bits,
               PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  for (int v = 0; v < height; ++v) {
    std::vector<png_byte> row;
    for (int u = 0; u < width; ++u) {
      const unsigned pixel = pixels[static_cast<std::size_t>(v * width + u)];
      if (bits == 16) row.push_back(static_cast<png_byte>(pixel >> 8U));
      row.push_back(static_cast<png_byte>(pixel & 0xFFU));
    }
    png_write_row(png, row.data());
  }
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  (void)std::fclose(file);
}

}  // namespace repel::percepts::test
