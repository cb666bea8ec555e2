#include <repel/schedule/pair_forces.hpp>

#include <gtest/gtest.h>

namespace repel {
namespace pair_forces_test {

TEST(PairTotals, SumKeepsTheNearestAndTheExtremes) {
  PairTotals a{3, 2, 1, 5, 10, 0.2, {4}, 7.0, 1};
  const PairTotals b{1, 1, 0, 9, 3, 0.1, {8}, 6.0, 2};
  a.add(b);
  EXPECT_EQ(a.near, 4);
  EXPECT_EQ(a.evaluated, 3);
  EXPECT_EQ(a.stale, 1);
  EXPECT_EQ(a.oldest_age, 9);
  EXPECT_EQ(a.iterations, 13);
  EXPECT_EQ(a.nearest, 0.1);
  EXPECT_EQ(a.nearest_pair, PairId{8});
  EXPECT_EQ(a.peak_force, 7.0);
  EXPECT_EQ(a.crowded, 3);
}

TEST(PairForces, ClearLeavesNoForceAndNoCount) {
  PairForces forces;
  forces.on_body.resize(2);
  forces.on_body[1].force.x() = 3.0;
  forces.totals.near = 4;
  forces.totals.nearest = 0.1;
  forces.clear();
  EXPECT_EQ(forces.on_body[1].force, Vec3::Zero());
  EXPECT_EQ(forces.totals.near, 0);
  EXPECT_EQ(forces.totals.nearest, PairTotals{}.nearest);
}

}  // namespace pair_forces_test
}  // namespace repel
