// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Whether reading the clock is a system call on this machine: then a tick that reads it makes
/// some.
#pragma once

#include <chrono>
#include <fstream>
#include <string>

#include <repel/runs/watch/system_call_guard.hpp>

namespace repel::test {

/// The clock source of this machine if reading the clock is a system call; empty otherwise, and if
/// this cannot be determined.
inline std::string clock_in_the_kernel() {
  using runs::SystemCallGuard;
  SystemCallGuard::arm(runs::Pauses::none);
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
