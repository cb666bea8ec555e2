// SPDX-License-Identifier: BSD-3-Clause
// package/check.sh tests that a program does not link with a library of a different memory layout.
#include <gtest/gtest.h>

#include <type_traits>

#include <repel/base/layout.hpp>
#include <repel/base/types.hpp>

namespace repel {
namespace layout_test {

TEST(Layout, NamesTheAlignmentThatAPoseHas) {
  constexpr int pose = static_cast<int>(alignof(Pose));
  EXPECT_TRUE((std::is_same_v<EigenAlignmentHere, EigenAlignment<pose, EIGEN_MAX_ALIGN_BYTES>>));
}

TEST(Layout, NamesTheRegisterThatLanesFill) {
  constexpr int lanes = static_cast<int>(sizeof(detail::Lanes));
  EXPECT_TRUE((std::is_same_v<VectorRegisterHere, VectorRegister<lanes>>));
}

TEST(Layout, OfAVectorIsThatOfTheRegister) {
  const bool in_one_register = sizeof(Vec<double>) == 32;
  EXPECT_EQ(in_one_register, detail::lane_bytes >= 32);
}

}  // namespace layout_test
}  // namespace repel
