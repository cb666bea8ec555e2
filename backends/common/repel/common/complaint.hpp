// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Exceptions as text, for threads beside the loop: their errors must not end it.
#pragma once

#include <exception>
#include <string>

namespace repel {

/// Runs `work`. Returns the text of the exception that it threw; empty when it threw none.
template <class Work>
[[nodiscard]] std::string complaint_of(const Work& work) noexcept {
  try {
    try {
      work();
      return {};
    } catch (const std::exception& error) {
      std::string what = error.what();
      return what.empty() ? "unknown" : what;
    }
  } catch (...) {
    return "unknown";  // short string optimization: needs no heap, which may be exhausted
  }
}

}  // namespace repel
