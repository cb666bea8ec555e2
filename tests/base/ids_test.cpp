// SPDX-License-Identifier: BSD-3-Clause
#include <repel/base/ids.hpp>

#include <gtest/gtest.h>

#include <concepts>
#include <type_traits>

namespace repel {
namespace ids_test {

TEST(Ids, ANewIdIsNotValid) {
  EXPECT_FALSE(BodyId{}.valid());
  EXPECT_TRUE(BodyId{0}.valid());
  EXPECT_FALSE(BodyId{-1}.valid());
}

TEST(Ids, AreEqualWhenTheirIndicesAre) {
  EXPECT_EQ(PairId{3}, PairId{3});
  EXPECT_NE(PairId{3}, PairId{4});
}

TEST(Ids, OfDifferentThingsCannotBeMixedUp) {
  static_assert(!std::is_convertible_v<BodyId, PartId>);
  static_assert(!std::is_convertible_v<PartId, PairId>);
  static_assert(!std::is_convertible_v<BodyId, int>);
  static_assert(!std::is_convertible_v<int, BodyId>);
  static_assert(!std::equality_comparable_with<BodyId, PartId>);
}

}  // namespace ids_test
}  // namespace repel
