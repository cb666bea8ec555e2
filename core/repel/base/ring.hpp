// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A wait-free single-producer, single-consumer ring buffer: delivers every value in order and
/// counts those dropped for lack of space.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <repel/base/setup_error.hpp>

namespace repel {

/// Slots are filled in place, so a value owning memory is never copied whole. The writer never
/// waits: when all `capacity` slots are unread, the value is dropped and counted. Memory:
/// `capacity` + 1 copies of a prototype, allocated at construction.
template <class T>
class Ring {
 public:
  /// @param capacity 1 to 2^30 values. @throws SetupError outside this range
  Ring(std::size_t capacity, const T& prototype)
      : slots_(static_cast<std::size_t>(
                   checked("ring capacity", static_cast<double>(capacity), 1.0, 0x1p30, "")) +
                   1,
               prototype) {}

  /// Writer: the slot to fill in. It holds the content of some earlier post.
  [[nodiscard]] T& draft() noexcept { return slots_[writing_]; }
  /// Writer: publishes the draft; false, with `dropped` increased by one, when the ring is full.
  bool post() noexcept {
    const std::size_t next = after(writing_);
    if (next == tail_.load(std::memory_order_acquire)) {
      dropped_.fetch_add(1, std::memory_order_relaxed);
      return false;
    }
    writing_ = next;
    head_.store(next, std::memory_order_release);
    return true;
  }

  /// Writer: a post would fail now.
  [[nodiscard]] bool full() const noexcept {
    return after(writing_) == tail_.load(std::memory_order_acquire);
  }

  /// Reader: the oldest unread value; null when there is none. The writer gets its content back in
  /// a later draft, and with it memory to be freed there.
  [[nodiscard]] T* front() noexcept {
    return const_cast<T*>(std::as_const(*this).front());  // NOLINT(*-const-cast): it is ours
  }
  /// The oldest unread value, for the consumer; null: none.
  [[nodiscard]] const T* front() const noexcept {
    if (reading_ == head_.load(std::memory_order_acquire)) return nullptr;
    return &slots_[reading_];
  }
  /// Reader: releases the slot of `front`, which must not be null.
  void pop() noexcept {
    reading_ = after(reading_);
    tail_.store(reading_, std::memory_order_release);
  }

  /// Any thread: number of values dropped.
  [[nodiscard]] std::int64_t dropped() const noexcept {
    return dropped_.load(std::memory_order_relaxed);
  }

 private:
  [[nodiscard]] std::size_t after(std::size_t slot) const noexcept {
    return slot + 1 < slots_.size() ? slot + 1 : 0;
  }

  // One slot is always unused for values: it is the draft of the writer.
  std::vector<T> slots_;
  alignas(64) std::atomic<std::size_t> head_{0};  ///< next slot to be posted
  alignas(64) std::atomic<std::size_t> tail_{0};  ///< next slot to be popped
  alignas(64) std::size_t writing_ = 0;
  std::atomic<std::int64_t> dropped_{0};
  alignas(64) std::size_t reading_ = 0;
};

}  // namespace repel
