// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Runs work on untrusted files in a child process, since libraries may crash on them or never end.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace repel::detail {

/// Resource limits of the child.
struct ChildLimits {
  int seconds = 1;                              ///< [s] of processor time
  std::size_t memory = std::size_t{256} << 20;  ///< [byte] in addition to that of this process
};

/// Runs `work` in a forked copy of this process and returns its result, so that a crash or an
/// endless loop does no harm. Set-up only: it forks.
/// @throws SetupError with the message of the exception that `work` throws, or saying how the child
///   ended
[[nodiscard]] std::string result_of_child(const std::function<std::string()>& work,
                                          const ChildLimits& limits);

}  // namespace repel::detail
