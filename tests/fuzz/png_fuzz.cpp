// SPDX-License-Identifier: BSD-3-Clause
// Arbitrary bytes as a depth image, and its chunks with the checksums that they should have: an
// image of the camera, or a SetupError that names the file. What the head refuses is not read.
#include <repel/percepts/depth_image_file.hpp>

#include <cmath>
#include <string>
#include <vector>

#include <crc32.hpp>
#include <end_to_end/folder.hpp>
#include <fuzz/bytes.hpp>
#include <repel/base/setup_error.hpp>

namespace repel::percepts {
namespace {

using fuzz::require;

constexpr DepthCamera camera{.width = 33, .height = 17, .cx = 16.0, .cy = 8.0};

template <class Read>
bool accepts(const std::string& path, const Read& read) {
  try {
    read();
  } catch (const SetupError& error) {
    require(std::string(error.what()).find(path) != std::string::npos, "an error names the file");
    return false;
  }
  return true;
}

void check_file(const std::string& bytes) {
  static const test::Folder folder;
  const std::string path = folder.with("1.5.png", bytes);
  std::vector<float> depth(camera.pixels(), -1.0F);
  const bool has_head = accepts(path, [&] { check_depth_image(path, camera); });
  const bool is_read = accepts(path, [&] { read_depth_image(path, camera, 1e-3, depth); });
  require(has_head || !is_read, "an image that is read has a head");
  for (const float z : depth) {
    require(is_read ? z >= 0.0F && z <= 65.535F : z == -1.0F, "depths are those of the file");
  }
}

std::uint32_t number_at(const std::string& bytes, std::size_t at) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    number = number << 8U | static_cast<std::uint8_t>(bytes[at + i]);
  }
  return number;
}

/// With the checksum of each chunk put right, so that what is in them is looked at.
std::string with_checksums(std::string bytes) {
  for (std::size_t at = 8; at + 12 <= bytes.size();) {
    const std::size_t length = number_at(bytes, at);
    if (length > bytes.size() - at - 12) break;
    const std::size_t end = at + 8 + length;
    const std::uint32_t crc =
        record::detail::crc32(std::string_view(bytes).substr(at + 4, length + 4));
    for (std::size_t i = 0; i < 4; ++i) {
      bytes[end + i] = static_cast<char>(crc >> (24U - 8U * static_cast<unsigned>(i)));
    }
    at = end + 4;
  }
  return bytes;
}

}  // namespace
}  // namespace repel::percepts

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(data, data + size);
  repel::percepts::check_file(bytes);
  repel::percepts::check_file(repel::percepts::with_checksums(bytes));
  return 0;
}
