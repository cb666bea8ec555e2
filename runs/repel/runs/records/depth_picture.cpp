// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/records/depth_picture.hpp>

#include <algorithm>
#include <cmath>

namespace repel::runs {
namespace {

std::uint16_t millimetres(float depth) {
  if (!std::isfinite(depth) || depth <= 0.0F) return 0;
  return static_cast<std::uint16_t>(std::min(65535.0F, std::round(1e3F * depth)));
}

}  // namespace

DepthPicture depth_picture(std::size_t camera, double time, int width, int height,
                           std::span<const float> depth) {
  int step = 1;
  const auto kept = [&step](int count) { return (count + step - 1) / step; };
  while (kept(width) * kept(height) > most_picture_pixels) ++step;
  DepthPicture picture{camera, time, kept(width), kept(height), {}};
  const auto row_length = static_cast<std::size_t>(width);
  for (int row = 0; row < height; row += step) {
    const auto pixels = depth.subspan(static_cast<std::size_t>(row) * row_length, row_length);
    for (int column = 0; column < width; column += step) {
      picture.depth.push_back(millimetres(pixels[static_cast<std::size_t>(column)]));
    }
  }
  return picture;
}

}  // namespace repel::runs
