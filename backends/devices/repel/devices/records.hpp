/// @file
/// Records of one size out of a stream that is read in pieces.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <span>

namespace repel::devices::detail {

/// Keeps the part of a record that has come until the rest is there. Memory: one record.
template <std::size_t size>
class Records {
 public:
  /// Hands every record that is now whole to `use`, which returns false to stop.
  /// @return false when it did; what came after is lost
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

  /// Bytes of a record that is not whole yet.
  [[nodiscard]] std::size_t held() const noexcept { return held_; }
  void clear() noexcept { held_ = 0; }

 private:
  std::array<std::byte, size> record_{};
  std::size_t held_ = 0;
};

}  // namespace repel::devices::detail
