// SPDX-License-Identifier: BSD-3-Clause
#include <repel/pairs/forces_and_totals.hpp>

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "support/families.hpp"

namespace repel {
namespace forces_and_totals_test {

constexpr unsigned seed = 611;

TEST(PairTotals, SumKeepsTheNearestAndTheExtremes) {
  PairTotals a{3, 2, 1, 5, 10, 0.2, {4}, 0.01, 7.0, {5}, 1};
  const PairTotals b{1, 1, 0, 9, 3, 0.1, {8}, 0.02, 6.0, {9}, 2};
  a.add(b);
  EXPECT_EQ(a.near, 4);
  EXPECT_EQ(a.evaluated, 3);
  EXPECT_EQ(a.stale, 1);
  EXPECT_EQ(a.oldest_age, 9);
  EXPECT_EQ(a.iterations, 13);
  EXPECT_EQ(a.nearest, 0.1);
  EXPECT_EQ(a.nearest_pair, PairId{8});
  EXPECT_EQ(a.deepest, 0.02);
  EXPECT_EQ(a.peak_force, 7.0);
  EXPECT_EQ(a.hardest_pair, PairId{5});
  EXPECT_EQ(a.crowded, 3);
}

// A box of 10 N on a belt at 2 m/s: the belt delivers 20 W; the box, which is at rest, delivers
// nothing.
TEST(PairForces, CarriedIsThePowerThatComesFromTheMotionOfTheOther) {
  Motion motion;
  motion.bodies.resize(3);
  motion.bodies[2].V_WB = {Vec3(2.0, 0.0, 0.0), Vec3::Zero()};
  PairForces forces(3);
  forces.push({1}, {2}, {Vec3(10.0, 0.0, 0.0), Vec3::Zero()}, {Vec3(-10.0, 0.0, 0.0), Vec3::Zero()},
              motion);
  EXPECT_EQ(forces.carried[1], 20.0);
  EXPECT_EQ(forces.carried[2], 0.0);
  PairForces sum(3);
  sum.add(forces);
  sum.add(forces);
  EXPECT_EQ(sum.carried[1], 40.0);
  EXPECT_EQ(sum.on_body[2].force.x(), -20.0);
}

TEST(PairForces, PushesOfBodiesInMotionCarryWhatTheyDoNotSpend) {
  families::Rng rng(seed);
  for (int sample = 0; sample < 100; ++sample) {
    Motion motion;
    motion.bodies.resize(3);
    for (BodyState& body : motion.bodies) {
      body.V_WB = {families::direction(rng), families::direction(rng)};
    }
    PairForces forces(3);
    for (const auto& [a, b] : {std::pair{1, 2}, {0, 1}}) {
      const Wrench on_a{families::direction(rng), families::direction(rng)};
      forces.push({a}, {b}, on_a, {-on_a.force, families::direction(rng)}, motion);
    }
    double spent = 0.0;
    double carried = 0.0;
    for (std::size_t body = 0; body < 3; ++body) {
      spent += power(forces.on_body[body], motion.bodies[body].V_WB);
      carried += forces.carried[body];
    }
    ASSERT_NEAR(spent, -carried, 1e-12) << "seed " << seed;
  }
}

// Regression: the forearm that moved towards the upper arm counted as an obstacle that supplies the
// arm, so that the pair spent the energy of each motion twice.
TEST(PairForces, BodiesOfOneArmSupplyEachOtherNothing) {
  Motion motion;
  motion.bodies.resize(5);
  for (const int body : {1, 2}) motion.bodies[static_cast<std::size_t>(body)].arm = {1};
  for (const int body : {3, 4}) motion.bodies[static_cast<std::size_t>(body)].arm = {3};
  for (BodyState& body : motion.bodies) body.V_WB.linear = Vec3(2.0, 0.0, 0.0);
  const Wrench to_right{Vec3(10.0, 0.0, 0.0), Vec3::Zero()};
  const Wrench to_left{Vec3(-10.0, 0.0, 0.0), Vec3::Zero()};
  PairForces own(5);
  own.push({1}, {2}, to_right, to_left, motion);
  EXPECT_EQ(own.carried, std::vector<double>(5, 0.0));
  EXPECT_EQ(own.on_body[1].force, Vec3::Zero());
  EXPECT_EQ(own.from_own[1].force, to_right.force);
  EXPECT_EQ(own.from_own[2].force, to_left.force);

  PairForces others(5);
  others.push({1}, {3}, to_right, to_left, motion);  // a link of another arm is an obstacle
  others.push({0}, {4}, to_right, to_left, motion);  // two bodies of no arm are not one arm
  EXPECT_FALSE(others.has_own);
  EXPECT_EQ(others.carried[1], 20.0);
  EXPECT_EQ(others.on_body[4].force, to_left.force);

  others.add(own);
  EXPECT_TRUE(others.has_own);
  EXPECT_EQ(others.from_own[1].force, to_right.force);
  EXPECT_EQ(others.on_body[1].force, to_right.force);
  others.clear();
  EXPECT_FALSE(others.has_own);
  EXPECT_EQ(others.from_own[1].force, Vec3::Zero());
}

TEST(PairForces, ClearLeavesNoForceAndNoCount) {
  PairForces forces(2);
  forces.on_body[1].force.x() = 3.0;
  forces.carried[1] = 2.0;
  forces.totals.near = 4;
  forces.totals.nearest = 0.1;
  forces.clear();
  EXPECT_EQ(forces.on_body[1].force, Vec3::Zero());
  EXPECT_EQ(forces.carried[1], 0.0);
  EXPECT_EQ(forces.totals.near, 0);
  EXPECT_EQ(forces.totals.nearest, PairTotals{}.nearest);
}

}  // namespace forces_and_totals_test
}  // namespace repel
