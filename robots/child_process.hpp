/// @file
/// Work on files of strangers by libraries that may crash on them or never end.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace repel::detail {

/// What a child may use.
struct ChildLimits {
  int seconds = 1;                              ///< [s] of processor time
  std::size_t memory = std::size_t{256} << 20;  ///< [byte] beside what this process has
};

/// What `work` returns, done in a copy of this process that ends with it, so that neither a crash
/// nor a loop of it does harm. Set-up only: it forks.
/// @throws SetupError with the words of the one that `work` throws, or saying how it ended
[[nodiscard]] std::string result_of_child(const std::function<std::string()>& work,
                                          const ChildLimits& limits);

}  // namespace repel::detail
