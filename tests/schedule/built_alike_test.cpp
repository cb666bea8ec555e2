// SPDX-License-Identifier: BSD-3-Clause
// package/check.sh tests that a program does not link with a library of a different memory layout.
#include <repel/schedule/built_alike.hpp>

#include <gtest/gtest.h>

TEST(BuiltAlike, LibraryIsBuiltForTheFlagsOfThisProgram) {
  EXPECT_EQ(repel::control::built_alike, &repel::control::is_built_for);
}
