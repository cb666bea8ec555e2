/// @file
/// For threads beside the loop, whose troubles must not end it.
#pragma once

#include <exception>
#include <string>

namespace repel {

/// Does `work`. Returns what it threw, in words; empty when it threw nothing.
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
    return "unknown";  // short enough to take no memory, which may be what is lacking
  }
}

}  // namespace repel
