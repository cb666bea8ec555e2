// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/options.hpp>

#include <gtest/gtest.h>

#include <cmath>

#include <repel/base/setup_error.hpp>

namespace repel {
namespace options_test {

TEST(TeleoperatorOptions, TheDefaultsAreWithinTheirRanges) {
  EXPECT_EQ(checked(TeleoperatorOptions{}).tool_speed, 0.25);
}

TEST(TeleoperatorOptions, WhatIsOutOfItsRangeIsRefusedByName) {
  const auto refusal = [](const TeleoperatorOptions& options) -> std::string {
    try {
      (void)checked(options);
    } catch (const SetupError& error) {
      return error.what();
    }
    return {};
  };
  TeleoperatorOptions options;
  options.tool_speed = 0.0;
  EXPECT_NE(refusal(options).find("tool speed"), std::string::npos);
  options.tool_speed = std::nan("");
  EXPECT_NE(refusal(options).find("m/s"), std::string::npos);
  options = {};
  options.longest_gap = -1.0;
  EXPECT_NE(refusal(options).find("longest gap"), std::string::npos);
  options = {};
  options.exit_speed = 100.0;
  EXPECT_NE(refusal(options).find("exit speed"), std::string::npos);
}

}  // namespace options_test
}  // namespace repel
