// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The options of the coprocessor.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include <repel/pairs/budget.hpp>

namespace repel {

/// What the threads of a coprocessor do while the caller is in its tick.
enum class CoprocessorMode : std::uint8_t {
  together,  ///< they and the caller share the pairs of the present motion
  beside,    ///< they evaluate the newest motion while the caller uses their last whole answer
};

/// The names of the modes, by value.
inline constexpr std::array<std::string_view, 2> coprocessor_mode_names{"together", "beside"};

/// Its name, as scene files and options spell it.
[[nodiscard]] constexpr std::string_view to_text(CoprocessorMode mode) noexcept {
  return coprocessor_mode_names[static_cast<std::size_t>(mode)];
}

/// The mode of that name; nullopt if there is none.
[[nodiscard]] constexpr std::optional<CoprocessorMode> coprocessor_mode_named(
    std::string_view name) noexcept {
  for (std::size_t i = 0; i < coprocessor_mode_names.size(); ++i) {
    if (coprocessor_mode_names[i] == name) return static_cast<CoprocessorMode>(i);
  }
  return std::nullopt;
}

/// How a coprocessor works.
struct CoprocessorOptions {
  int threads = 0;  ///< besides the caller; 0: it evaluates all pairs itself, in either mode
  CoprocessorMode mode = CoprocessorMode::together;  ///< of the threads, if there are any
  Budget budget;                                     ///< per tick
  std::chrono::nanoseconds period{2500000};   ///< between ticks, so that idle threads can sleep
  std::chrono::nanoseconds patience{500000};  ///< how long the caller waits for a thread that has
                                              ///< begun some work; this and the period are clamped
                                              ///< to 0 to 1 s
  int processors = 0;  ///< that the caller and the threads share; 0: what the machine has. Threads
                       ///< for which there is none are not started, except one that works beside
  void (*on_thread_start)(int index) noexcept = nullptr;  ///< called in each thread: priority etc.
  bool every_pair = false;  ///< no broad phase: evaluate all pairs, as a reference for comparison
  bool lock_step = false;   ///< start every thread, wait for every answer, however long it takes,
                            ///< and never sleep: for replays. Nothing depends on a clock then, and
                            ///< Budget::wall does not count. A thread that dies is waited for for
                            ///< ever. Beside, the answer is one tick old
};

}  // namespace repel
