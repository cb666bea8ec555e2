// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Waiting for what another thread does.
#pragma once

#include <chrono>
#include <thread>

namespace repel::test {

/// Asks again and again, for a minute at most. True as soon as `condition` is.
template <class Condition>
bool comes_true(Condition&& condition) {
  const auto until = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > until) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

}  // namespace repel::test
