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

/// Buffers an incomplete event until the rest arrives. Memory: one event. An impossible event
/// invalidates the stream until `reset`.
template <std::size_t size>
class Records {
 public:
  static constexpr std::size_t event_size = size;  ///< [bytes] of one event

  /// The stream is invalid, until `reset`.
  [[nodiscard]] bool broken() const noexcept { return broken_; }
  /// Bytes received of an incomplete event.
  [[nodiscard]] std::size_t held() const noexcept { return held_; }
  /// For a new stream.
  void reset() noexcept {
    held_ = 0;
    broken_ = false;
  }

 protected:
  using Record = std::array<std::byte, size>;  ///< the bytes of one event

  /// Passes every complete record to `use`. It returns whether the record is valid.
  /// @return false if the stream is invalid; the remaining bytes are lost
  template <class Use>
  bool split(std::span<const std::byte> bytes, Use&& use) noexcept {
    while (!broken_ && !bytes.empty()) {
      const std::size_t count = std::min(size - held_, bytes.size());
      std::memcpy(record_.data() + held_, bytes.data(), count);
      bytes = bytes.subspan(count);
      held_ += count;
      if (held_ < size) return true;
      held_ = 0;
      broken_ = !use(record_);
    }
    return !broken_;
  }

 private:
  Record record_{};
  std::size_t held_ = 0;
  bool broken_ = false;
};

}  // namespace repel::devices::detail
