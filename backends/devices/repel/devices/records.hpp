// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Splits a stream that is read in pieces into records of fixed size.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <span>

namespace repel::devices::detail {

/// Buffers an incomplete record until the rest arrives. Memory: one record.
template <std::size_t size>
class Records {
 public:
  /// Passes every complete record to `use`, which returns false to stop.
  /// @return false if it did; the remaining bytes are lost
  template <class Use>
  bool feed(std::span<const std::byte> bytes, Use&& use) noexcept {
    while (!bytes.empty()) {
      const std::size_t count = std::min(size - held_, bytes.size());
      std::memcpy(record_.data() + held_, bytes.data(), count);
      bytes = bytes.subspan(count);
      held_ += count;
      if (held_ < size) return true;
      held_ = 0;
      if (!use(record_)) return false;
    }
    return true;
  }

  /// Bytes received of an incomplete record.
  [[nodiscard]] std::size_t held() const noexcept { return held_; }
  void clear() noexcept { held_ = 0; }

 private:
  std::array<std::byte, size> record_{};
  std::size_t held_ = 0;
};

}  // namespace repel::devices::detail
