// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Times in messages that Foxglove knows by name.
#pragma once

#include <cstdint>

#include <nlohmann/json.hpp>

namespace repel::runs::mcap {

/// @param ns [ns] since the epoch, or of time from 0 on
[[nodiscard]] inline nlohmann::json time_json(std::uint64_t ns) {
  return {{"sec", ns / 1000000000U}, {"nsec", ns % 1000000000U}};
}

}  // namespace repel::runs::mcap
