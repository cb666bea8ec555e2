// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/records/mcap_image.hpp>

#include <algorithm>
#include <string_view>
#include <vector>

#include <repel/runs/records/mcap_time.hpp>

namespace repel::runs::mcap {
namespace {

std::string base64_of(const std::vector<std::uint8_t>& bytes) {
  constexpr std::string_view digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8U | (k < count ? bytes[i + k] : 0U);
    for (std::size_t k = 0; k < 4; ++k) {
      text.push_back(k > count ? '=' : digits[group >> (18U - 6U * k) & 63U]);
    }
  }
  return text;
}

}  // namespace

nlohmann::json image_json(const DepthPicture& picture, const std::string& frame,
                          std::uint64_t taken_ns) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(2 * picture.depth.size());
  for (const std::uint16_t depth : picture.depth) {  // the low byte first
    bytes.push_back(static_cast<std::uint8_t>(depth & 255U));
    bytes.push_back(static_cast<std::uint8_t>(depth >> 8U));
  }
  return {{"timestamp", time_json(taken_ns)}, {"frame_id", frame},   {"width", picture.width},
          {"height", picture.height},         {"encoding", "16UC1"}, {"step", 2 * picture.width},
          {"data", base64_of(bytes)}};
}

}  // namespace repel::runs::mcap
