// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/active_contacts.hpp>

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace repel {
namespace active_contacts_test {

Pose at(double x, double y, double z) {
  Pose X = Pose::Identity();
  X.translation() = Vec3(x, y, z);
  return X;
}

/// A ball of 50 mm, 10 mm above a floor and 10 mm in front of a wall, both felt from 20 mm on.
struct Corner {
  Corner() {
    tool = world.add_body("tool");
    const PartId ball = world.add_part(tool, "ball", Shape::sphere(0.05));
    const ForceLaw law{.range = 0.02, .surface_force = 100.0, .damping = 60.0};
    for (const Pose& X : {at(0.0, 0.0, -0.16), at(0.16, 0.0, 0.0)}) {
      world.add_pair(ball, world.add_part(World::fixed, "wall", Shape::box({0.1, 0.1, 0.1}), X),
                     law);
    }
  }
  World world;
  BodyId tool;
};

TEST(ActiveContacts, HaveDirectionLeverAndDampingOfThePairsThatPush) {
  Corner corner;
  Coprocessor coprocessor(corner.world, {});
  (void)coprocessor.exchange();
  ActiveContacts contacts(corner.world, 16, std::array{corner.tool});
  contacts.collect(coprocessor);
  ASSERT_EQ(contacts.all().size(), 2U);
  Vec3 sum{0, 0, 0};
  for (const ActiveContact& contact : contacts.all()) {
    EXPECT_EQ(contact.a, corner.tool);
    EXPECT_NEAR(contact.damping, 30.0, 1e-6);  // half of it, 10 mm from the surface
    EXPECT_NEAR(contact.on_a.force.norm(), 1.0, 1e-9);
    EXPECT_NEAR(contact.on_a.torque.norm(), 0.0, 1e-6);  // through the centre of the ball
    EXPECT_NEAR((contact.on_a.force + contact.on_b.force).norm(), 0.0, 1e-12);
    sum += contact.on_a.force;
  }
  EXPECT_NEAR((sum - Vec3(-1, 0, 1)).norm(), 0.0, 1e-6);
}

TEST(ActiveContacts, ThoseBeyondTheCapacityAndOfBodiesThatNoArmMovesAreLeftOut) {
  Corner corner;
  Coprocessor coprocessor(corner.world, {});
  (void)coprocessor.exchange();
  ActiveContacts one(corner.world, 1, std::array{corner.tool});
  one.collect(coprocessor);
  EXPECT_EQ(one.all().size(), 1U);
  ActiveContacts none(corner.world, 16, {});
  none.collect(coprocessor);
  EXPECT_TRUE(none.all().empty());
}

TEST(ActiveContacts, BecomeAMatrixOfTheJoints) {
  Corner corner;
  Coprocessor coprocessor(corner.world, {});
  (void)coprocessor.exchange();
  ActiveContacts contacts(corner.world, 16, std::array{corner.tool});
  contacts.collect(coprocessor);
  Jacobian rails = Jacobian::Zero(6, 3);
  rails.topRows<3>().setIdentity();
  network::Mat<network::any_size> damping;
  gather_damping(contacts.all(), corner.tool, rails, ArmBodies({}, 3), damping);
  ASSERT_EQ(damping.rows(), 3);
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(damping(i, k), i == k && i != 1 ? 30.0 : 0.0, 1e-5) << i << ' ' << k;
    }
  }
}

}  // namespace active_contacts_test
}  // namespace repel
