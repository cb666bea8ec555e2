/// @file
/// What the machine does to a program that only reads the clock.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

namespace repel::host {

/// Gaps of more than 10 us between two readings of the clock.
struct Hiccups {
  using nanoseconds = std::chrono::nanoseconds;

  static constexpr nanoseconds threshold{10000};
  /// Lower edges of the bins [us]; the last bin is open.
  static constexpr std::array<int, 10> edges_us{10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000};

  void record(nanoseconds gap) noexcept;

  std::array<std::int64_t, edges_us.size()> bins{};
  std::int64_t count = 0;
  nanoseconds total{0};
  nanoseconds longest{0};
};

[[nodiscard]] nlohmann::ordered_json to_json(const Hiccups& hiccups);

/// A thread of ordinary priority that reads the clock in a loop, from construction on.
class HiccupWatch {
 public:
  using nanoseconds = std::chrono::nanoseconds;

  /// Returns once it reads.
  /// @param processors it may run on
  explicit HiccupWatch(const std::vector<int>& processors);

  /// Whether a hiccup fell, wholly or in part, between two times of the steady clock, the second of
  /// them now. Wait-free.
  [[nodiscard]] bool met(nanoseconds since, nanoseconds now) const noexcept;

  /// Ends the thread; what it saw.
  [[nodiscard]] const Hiccups& stop();

 private:
  void watch(const std::stop_token& stop) noexcept;

  Hiccups hiccups_;
  // Written at every reading: not to be shared with anything else.
  alignas(64) std::atomic<nanoseconds> last_reading_{nanoseconds{0}};
  std::atomic<nanoseconds> last_end_{nanoseconds{0}};
  alignas(64) std::jthread thread_;
};

}  // namespace repel::host
