// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A wait-free mailbox (triple buffer) that passes the newest value from one writer thread to one
/// reader thread.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace repel {

/// Three slots: one being written, one being read, and one in between that either side exchanges
/// for its own. Neither side ever waits, and no value is read partly written. Values not taken are
/// overwritten: the reader gets the newest. Memory: three T, sized once from a prototype.
template <class T>
class Mailbox {
 public:
  /// Three copies of `prototype`, the memory of all values to come. Allocates if its copy does.
  explicit Mailbox(const T& prototype)
      : slots_{Slot{prototype}, Slot{prototype}, Slot{prototype}} {}

  /// Writer: the slot to fill in. It holds the content of some earlier post.
  [[nodiscard]] T& draft() noexcept { return slots_[writing_].value; }
  /// Writer: publishes the draft as the newest value.
  void post() noexcept {
    writing_ = between_.exchange(writing_ | fresh, std::memory_order_acq_rel) & index_mask;
  }

  /// Reader: switches to the newest value; false when there is none since the last call.
  bool take() noexcept {
    if ((between_.load(std::memory_order_relaxed) & fresh) == 0U) return false;
    reading_ = between_.exchange(reading_, std::memory_order_acq_rel) & index_mask;
    return true;
  }
  /// Reader: the value last taken; the prototype before the first.
  [[nodiscard]] const T& newest() const noexcept { return slots_[reading_].value; }

 private:
  static constexpr std::uint32_t fresh = 4;
  static constexpr std::uint32_t index_mask = 3;
  // Avoids false sharing between writer and reader.
  struct alignas(64) Slot {
    T value;
  };

  std::array<Slot, 3> slots_;
  alignas(64) std::atomic<std::uint32_t> between_{1};
  alignas(64) std::uint32_t writing_ = 0;
  alignas(64) std::uint32_t reading_ = 2;
};

}  // namespace repel
