/// @file
/// Whether asking the time takes the kernel: then a tick that asks it makes system calls.
#pragma once

#include <chrono>
#include <fstream>
#include <string>

#include "system_call_guard.hpp"

namespace repel::test {

/// The clock source of this machine where reading the clock is a system call; else, and where that
/// cannot be told, nothing.
inline std::string clock_in_the_kernel() {
  using teleop::SystemCallGuard;
  SystemCallGuard::arm(teleop::Pauses::none);
  const std::int64_t before = SystemCallGuard::calls();
  {
    const SystemCallGuard guard;
    (void)std::chrono::steady_clock::now();
  }
  if (SystemCallGuard::calls() == before) return {};
  std::string source = "unknown";
  std::ifstream("/sys/devices/system/clocksource/clocksource0/current_clocksource") >> source;
  return source;
}

}  // namespace repel::test
