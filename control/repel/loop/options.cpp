// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/options.hpp>

#include <repel/base/setup_error.hpp>

namespace repel {

const TeleoperatorOptions& checked(const TeleoperatorOptions& options) {
  checked("tool speed", options.tool_speed, 1e-3, 10.0, "m/s");
  checked("longest gap", options.longest_gap, 0.0, 1e6, "s");
  checked("drive delay", options.drive_delay, 0.0, 100.0, "ticks");
  checked("exit speed", options.exit_speed, 0.0, 10.0, "m/s");
  return options;
}

}  // namespace repel
