// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/barrier/active_contacts.hpp>

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

/// The contacts of a tool, collected once.
struct Seen {
  Seen(World& world, BodyId tool, std::size_t capacity = 16)
      : coprocessor(world, {}), contacts(world, capacity, std::array{tool}) {
    (void)coprocessor.exchange();
    contacts.collect(coprocessor);
  }
  Coprocessor coprocessor;
  ActiveContacts contacts;
};

TEST(ActiveContacts, HaveDirectionLeverAndDampingOfThePairsThatPush) {
  Corner corner;
  const Seen seen(corner.world, corner.tool);
  const ActiveContacts& contacts = seen.contacts;
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
  const Seen one(corner.world, corner.tool, 1);
  EXPECT_EQ(one.contacts.all().size(), 1U);
  ActiveContacts none(corner.world, 16, {});
  none.collect(one.coprocessor);
  EXPECT_TRUE(none.all().empty());
}

TEST(ActiveContacts, BecomeAMatrixOfTheJoints) {
  Corner corner;
  const Seen seen(corner.world, corner.tool);
  const ActiveContacts& contacts = seen.contacts;
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

/// A square plate of 100 mm on a floor, pressed flat with 100 N.
struct Plate {
  Plate() {
    tool = world.add_body("tool");
    const PartId plate = world.add_part(tool, "plate", Shape::box({0.05, 0.05, 0.005}));
    const PartId floor =
        world.add_part(World::fixed, "floor", Shape::box({1.0, 1.0, 0.1}), at(0, 0, -0.115));
    world.add_pair(plate, floor, {.range = 0.02, .surface_force = 200.0, .damping = 100.0});
    Pose X = Pose::Identity();
    X.rotate(Eigen::AngleAxisd(1e-3, Vec3::UnitX()));  // not quite flat
    EXPECT_TRUE(world.place(tool, X, {}));
  }
  World world;
  BodyId tool;
};

TEST(ActiveContacts, OnAPatchALightToolIsDampedAgainstTurningAcrossItAlone) {
  Plate plate;
  const Seen seen(plate.world, plate.tool);
  const ActiveContacts& contacts = seen.contacts;
  ASSERT_EQ(contacts.all().size(), 1U);
  EXPECT_GT(contacts.all()[0].turning, 100.0);
  Jacobian ball = Jacobian::Zero(6, 3);  // a wrist of three joints
  ball.bottomRows<3>().setIdentity();
  const Vec3 w(0.3, -0.2, 0.5);
  for (const double inertia : {1.0, 2e-5}) {
    ArmInertia::Matrix M = inertia * ArmInertia::Matrix::Identity(3, 3);
    network::Mat<network::any_size> damping = network::Mat<network::any_size>::Zero(3, 3);
    const Wrench F = damp_turning(contacts.all(), plate.tool, ball, w, {M, 1.0 / 400.0}, damping);
    EXPECT_EQ(F.force.norm(), 0.0);
    if (inertia == 1.0) {
      EXPECT_EQ(F.torque.norm(), 0.0) << "what is heavy does not ring";
      EXPECT_EQ(damping.norm(), 0.0);
      continue;
    }
    const double c = 0.5 / 400.0 * contacts.all()[0].turning;
    EXPECT_NEAR((F.torque + c * Vec3(w.x(), w.y(), 0.0)).norm(), 0.0, 1e-3 * c);
    EXPECT_NEAR((F.torque + Vec3(damping * w)).norm(), 0.0, 1e-12 * c)
        << "the network knows all of it";
  }
}

}  // namespace active_contacts_test
}  // namespace repel
