// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What begins and ends in a run as messages foxglove.Log.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <repel/loop/tap.hpp>
#include <repel/runs/records/heading.hpp>

namespace repel::runs::mcap {

/// Of foxglove.Log.
enum class Level : std::uint8_t { info = 2, warning = 3, error = 4 };

/// @param name of the arm, or of the program
[[nodiscard]] nlohmann::json log_json(std::uint64_t now_ns, Level level, const std::string& name,
                                      const std::string& message);

/// What a bit of the status means to who reads it; empty: there is no such bit.
[[nodiscard]] std::string words_of(Status bit);

/// Phases of scripts, bits of the status and what is done about faults, each where it changes.
class Events {
 public:
  explicit Events(const Heading& heading);

  /// To be called at every tick. A bit that was off for less than 0.1 s has not ended.
  [[nodiscard]] std::vector<nlohmann::json> follow(const Snapshot& tick, std::uint64_t now_ns);

 private:
  struct Bit {
    bool is_on = false;
    double since = 0.0;  ///< [s]
    double last = 0.0;   ///< [s] when it was set
  };
  struct Arm {
    std::string name;
    std::vector<std::string> phases;
    std::int32_t phase = -1;  ///< none yet
    Stop stop = Stop::running;
    std::array<Bit, 32> bits{};
  };

  std::vector<Arm> arms_;
};

}  // namespace repel::runs::mcap
