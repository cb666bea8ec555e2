// SPDX-License-Identifier: BSD-3-Clause
#include "metered_stream.hpp"

#include <algorithm>

namespace repel::visual {
namespace {

constexpr std::uint64_t beyond = std::uint64_t{1} << 62U;  // never reached

}  // namespace

int FrameCounter::count(std::string_view bytes) noexcept {
  int frames = 0;
  while (!bytes.empty()) {
    if (skip_ > 0) {
      const std::uint64_t some = std::min<std::uint64_t>(skip_, bytes.size());
      skip_ -= some;
      bytes.remove_prefix(some);
      continue;
    }
    if (known_ == 0) ++frames;
    header_[known_++] = static_cast<unsigned char>(bytes.front());
    bytes.remove_prefix(1);
    if (known_ < header_size()) continue;
    const std::uint64_t mask = (header_[1] & 128U) != 0U ? 4 : 0;
    skip_ = std::min(payload_size(), beyond) + mask;
    known_ = 0;
  }
  return frames;
}

std::size_t FrameCounter::header_size() const noexcept {
  if (known_ < 2) return 2;
  const unsigned size = header_[1] & 127U;
  return size < 126 ? 2 : size == 126 ? 4 : 10;
}

std::uint64_t FrameCounter::payload_size() const noexcept {
  const std::size_t end = header_size();
  if (end == 2) return header_[1] & 127U;
  std::uint64_t size = 0;
  for (std::size_t i = 2; i < end; ++i) size = size << 8U | header_[i];
  return size;
}

}  // namespace repel::visual
