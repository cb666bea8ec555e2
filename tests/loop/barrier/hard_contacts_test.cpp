// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/barrier/hard_contacts.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>

#include <repel/reduction/separation.hpp>

namespace repel {
namespace hard_contacts_test {

const ForceLaw hard{.range = 0.02, .surface_force = 100.0, .hold = HoldKind::hard, .watched = 0.1};

Pose moved_to(double x, double y, double z) {
  Pose X = Pose::Identity();
  X.translation() = Vec3(x, y, z);
  return X;
}

/// A box that moves above another one.
struct Plates {
  Plates(const Vec3& upper, const Pose& X_WA, const Twist& V_WA, const Vec3& lower,
         const ForceLaw& law = hard)
      : body(world.add_body("plate", X_WA)) {
    part = world.add_part(body, "plate", Shape::box(upper));
    table = world.add_part(World::fixed, "table", Shape::box(lower));
    (void)world.add_pair(part, table, law);
    EXPECT_TRUE(world.place(body, X_WA, V_WA));
    coprocessor.emplace(world, CoprocessorOptions{});
    (void)coprocessor->exchange();
  }
  std::vector<HardContact> contacts(double soon = 0.1) {
    HardContacts all(world, std::array{body});
    all.collect(*coprocessor, soon);
    EXPECT_EQ(all.left_out(), 0);
    return {all.all().begin(), all.all().end()};
  }
  World world;
  BodyId body;
  PartId part, table;
  std::optional<Coprocessor> coprocessor;
};

TEST(HardContacts, AreThePointsOfHardPairsAlone) {
  const Twist down{{0, 0, -0.2}, {0, 0, 0}};
  Plates plates({0.1, 0.05, 0.01}, moved_to(0, 0, 0.035), down, {1, 1, 0.01});
  const auto contacts = plates.contacts();
  ASSERT_GE(contacts.size(), 5U) << "the corners of the plate";
  for (const HardContact& contact : contacts) {
    EXPECT_EQ(contact.a, plates.body);
    EXPECT_NEAR(contact.gap, 0.015, 1e-9);
    EXPECT_NEAR(contact.rate, -0.2, 1e-9);
    EXPECT_NEAR(contact.on_a.force.z(), 1.0, 1e-9);
    EXPECT_FALSE(contact.is_between_arms);
  }
  ForceLaw soft = hard;
  soft.hold = HoldKind::soft;
  Plates none({0.1, 0.05, 0.01}, moved_to(0, 0, 0.035), down, {1, 1, 0.01}, soft);
  EXPECT_TRUE(none.contacts().empty());
  EXPECT_FALSE(has_hard(none.world));
  EXPECT_TRUE(has_hard(plates.world));
}

// The farthest point of a pane along its normal is any of its corners. Half-way to that was taken
// for a point of the contact, beyond the joint of a link that lay flat at the pane. What opened the
// gap there closed it at the link: a hand pushed the link 13 mm into hard glass.
TEST(HardContacts, LieWhereThePartsMeet) {
  const Twist down{{0, 0, -0.2}, {0, 0, 0}};
  for (const bool is_above : {true, false}) {
    const Pose X = moved_to(0.3, -0.2, is_above ? 0.035 : -0.035);
    Plates plates({0.1, 0.05, 0.01}, X, down, {1, 1, 0.01});
    const auto contacts = plates.contacts();
    ASSERT_FALSE(contacts.empty());
    for (const HardContact& contact : contacts) {
      EXPECT_LE(std::abs(contact.on_a.torque.x()), 0.05 + 1e-9);
      EXPECT_LE(std::abs(contact.on_a.torque.y()), 0.1 + 1e-9);
    }
  }
}

TEST(HardContacts, AreNoneOfWhatCannotMeetSoon) {
  const Twist up{{0, 0, 0.001}, {0, 0, 0}};
  Plates plates({0.1, 0.05, 0.01}, moved_to(0, 0, 0.09), up, {1, 1, 0.01});
  EXPECT_TRUE(plates.contacts().empty());
}

// Where faces are nearly parallel, the nearest point says nothing of how the distance will change:
// a plate that turned about its nearest corner put the other one into the table.
TEST(HardContacts, BoundHowFarTheDistanceCanShrink) {
  constexpr unsigned seed = 5;
  std::mt19937 random(seed);
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::uniform_real_distribution<double> draw(-1.0, 1.0);
  constexpr double dt = 2e-3;  // [s]
  int told_by_the_nearest = 0;
  int tried = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vec3 upper(0.05 + 0.04 * draw(random), 0.05 + 0.04 * draw(random), 0.02);
    const Vec3 lower(0.06 + 0.04 * draw(random), 0.06 + 0.04 * draw(random), 0.02);
    const double lean = i % 3 == 0 ? 0.0 : i % 3 == 1 ? 1e-3 : 0.3;
    Pose X = moved_to(0.05 * draw(random), 0.05 * draw(random), 0.045 + 0.002 * draw(random));
    X.linear() = (Eigen::AngleAxisd(lean * draw(random), Vec3::UnitX()) *
                  Eigen::AngleAxisd(lean * draw(random), Vec3::UnitY()) *
                  Eigen::AngleAxisd(draw(random), Vec3::UnitZ()))
                     .toRotationMatrix();
    Twist V;
    V.linear = 0.3 * Vec3(draw(random), draw(random), draw(random));
    V.angular = 2.0 * Vec3(draw(random), draw(random), draw(random));
    Plates plates(upper, X, V, lower);
    const auto contacts = plates.contacts();
    if (contacts.empty() || contacts[0].gap < 0.0) continue;
    ++tried;
    double least = 1.0;
    for (const HardContact& contact : contacts) {
      least = std::min(least, contact.gap + dt * contact.rate);
    }
    const double angle = dt * V.angular.norm();
    Pose next = X;
    next.linear() =
        Eigen::AngleAxisd(angle, V.angular.normalized()).toRotationMatrix() * X.linear();
    next.translation() += dt * V.linear;
    WarmStart warm;
    const Separation after =
        separation(plates.world.part(plates.part).shape, next,
                   plates.world.part(plates.table).shape, Pose::Identity(), {}, warm);
    EXPECT_GT(after.distance, least - 4e-5) << "pair " << i;
    told_by_the_nearest += after.distance > contacts[0].gap + dt * contacts[0].rate - 4e-5 ? 1 : 0;
  }
  EXPECT_GT(tried, 1500);
  EXPECT_LT(told_by_the_nearest, tried * 9 / 10) << "the nearest point alone must not do";
}

// A plate that slid over an edge of a hull and tipped went into it: its rows knew the rate of the
// gap, and not that the rate was changing.
TEST(HardContacts, KnowHowTheRateOfAGapChangesAsBodiesTurn) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> draw(-1.0, 1.0);
  double largest = 0.0;
  for (int i = 0; i < 200; ++i) {
    SCOPED_TRACE("seed 6, case " + std::to_string(i));
    const Twist V{{0.5 * draw(random), 0.5 * draw(random), 0.1 * draw(random)},
                  {draw(random), draw(random), draw(random)}};
    const Pose X = moved_to(0, 0, 0.035);
    // The plate is over the whole block, so the block's corners meet the plate's face.
    Plates plates({0.2, 0.2, 0.01}, X, V, {0.05, 0.05, 0.01});
    const double h = 1e-4;  // [s]
    const auto gap_after = [&](double time) {
      const Vec3 turn = time * V.angular;
      Pose moved = X;
      moved.translation() += time * V.linear;
      if (turn.norm() > 0.0) {
        moved.linear() = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
      }
      const Vec3 n = moved.linear().col(2);
      double least = 1.0;  // of the corners of the block to the lower face of the plate
      for (const double x : {-0.05, 0.05}) {
        for (const double y : {-0.05, 0.05}) {
          least = std::min(least, n.dot(moved.translation() - Vec3(x, y, 0.01)) - 0.01);
        }
      }
      return least;
    };
    const double now = gap_after(0.0);
    const double later = gap_after(h);
    double least = 1.0;
    for (const HardContact& contact : plates.contacts(0.3)) {
      least = std::min(least, contact.gap + h * contact.rate + 0.5 * h * h * contact.bending);
      largest = std::max(largest, std::abs(contact.bending));
    }
    EXPECT_LT(least, later + 1e-12);
    EXPECT_NEAR(least, now, 2e-4);
  }
  EXPECT_GT(largest, 0.3);
}

TEST(HardContacts, TakeTheDirectionOfAnOldAnswerAndThePresentPoses) {
  Plates plates({0.1, 0.05, 0.01}, moved_to(0, 0, 0.035), {}, {1, 1, 0.01});
  ASSERT_TRUE(plates.world.place(plates.body, moved_to(0, 0, 0.03), {}));
  const auto contacts = plates.contacts();
  ASSERT_FALSE(contacts.empty());
  EXPECT_NEAR(contacts[0].gap, 0.01, 1e-9);
}

}  // namespace hard_contacts_test
}  // namespace repel
