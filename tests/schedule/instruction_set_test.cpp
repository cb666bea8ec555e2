// SPDX-License-Identifier: BSD-3-Clause
// REPEL_ISA as a user sets it: tests/end_to_end/programs/instruction_sets.sh.
#include <repel/schedule/instruction_set.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace repel {
namespace instruction_set_test {

TEST(InstructionSet, OneThatTheProcessorHasIsInUse) {
  const auto names = instruction_sets();
  ASSERT_FALSE(names.empty());
  EXPECT_NE(std::find(names.begin(), names.end(), instruction_set()), names.end());
  std::printf("in use: %s\n", std::string(instruction_set()).c_str());
}

}  // namespace instruction_set_test
}  // namespace repel
