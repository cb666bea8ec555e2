// SPDX-License-Identifier: BSD-3-Clause
// package/check.sh tests that a program does not link with a library of a different memory layout.
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <type_traits>

#include <repel/base/lanes.hpp>
#include <repel/base/layout.hpp>
#include <repel/base/types.hpp>
#include <repel/base/vec.hpp>

namespace repel {
namespace layout_test {

TEST(Layout, NamesTheAlignmentThatAPoseHas) {
  constexpr int pose = static_cast<int>(alignof(Pose));
  EXPECT_TRUE((std::is_same_v<EigenAlignmentHere, EigenAlignment<pose, EIGEN_MAX_ALIGN_BYTES>>));
}

TEST(Layout, NamesTheRegisterThatHoldsLanes) {
  constexpr int bytes = static_cast<int>(sizeof(detail::DoubleRegister));
  EXPECT_TRUE((std::is_same_v<VectorRegisterHere, VectorRegister<bytes>>));
}

// Code for other registers reads what this code has laid out.
TEST(Layout, OfVectorsAndLanesIsThatOfFourNumbers) {
  EXPECT_EQ(sizeof(Vec<double>), 4 * sizeof(double));
  EXPECT_EQ(alignof(Vec<double>), 4 * sizeof(double));
  EXPECT_EQ(sizeof(detail::Lanes), 4 * sizeof(double));
  EXPECT_EQ(alignof(detail::Lanes), 4 * sizeof(double));
  const Vec<double> v(1.0, 2.0, 3.0);
  std::array<double, 4> numbers;
  std::memcpy(numbers.data(), &v, sizeof numbers);
  EXPECT_EQ(numbers, (std::array<double, 4>{1.0, 2.0, 3.0, 0.0}));
}

}  // namespace layout_test
}  // namespace repel
