// SPDX-License-Identifier: BSD-3-Clause
// A joint that stands still and one whose encoder is frozen report the same.
#include <repel/loop/watch/still_joint.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace repel {
namespace still_joint_test {

constexpr double T = 0.0025;

/// A joint with true friction `dry` [N m], of which the model says 20, pushed by `net` [N m].
struct Pushed {
  explicit Pushed(double dry) : friction(dry) {}

  [[nodiscard]] double rounded() const {
    return step_of == 0.0 ? q : step_of * std::round(q / step_of);
  }

  /// One period; the torque is raised where the watch asks for it.
  bool step(double net) {
    load.surely = net;
    const double probe = still.probe(load, {});
    if (probe > 0.0) load.surely = std::max(net, probe);
    if (probe < 0.0) load.surely = std::min(net, probe);
    probes += load.surely != net ? 1 : 0;
    load.at_most = std::abs(load.surely);
    load.dry = 20.0;
    load.effort = 100.0;
    load.inertia = load.free_inertia = 4.0;
    load.elapsed = T;
    const double driven = v + T * load.surely / load.inertia;
    const double lost = T * friction / load.inertia;
    v = std::copysign(std::max(0.0, std::abs(driven) - lost), driven);
    q += T * v;
    const double now = is_frozen ? read_q : rounded();
    const double rate = is_frozen ? 0.0 : v;
    const bool found = still.step(now, rate, read_q, read_v, load, {});
    read_q = now;
    read_v = rate;
    return found;
  }

  StillJoint still;
  JointLoad load;
  double friction;
  double q = 0.0, v = 0.0, read_q = 0.0, read_v = 0.0;
  double step_of = 0.0;  // [rad] of the encoder; the options say 1e-5
  bool is_frozen = false;
  int probes = 0;
};

TEST(StillJoint, AJointThatSticksIsAskedOnceAndThenTrusted) {
  for (const double friction : {15.0, 20.0, 28.0}) {
    Pushed joint(friction);
    for (int tick = 0; tick < 4000; ++tick) {
      ASSERT_FALSE(joint.step(0.95 * friction)) << friction << " N m, tick " << tick;
    }
    EXPECT_LT(std::abs(joint.q), 1e-2) << "in ten seconds";
    EXPECT_LT(joint.probes, 160) << friction << ": of 4000";
    EXPECT_GT(joint.probes, 0) << friction;
  }
}

// It went 96 mm into a soft wall in 3 s: the push stayed below what friction may hold.
TEST(StillJoint, AFrozenEncoderIsFoundBeforeTheJointHasGoneFar) {
  for (const double friction : {12.0, 15.0, 20.0}) {
    for (const double excess : {0.1, 2.0, 8.0}) {
      Pushed joint(friction);
      joint.is_frozen = true;
      bool found = false;
      for (int tick = 0; tick < 400 && !found; ++tick) {
        found = joint.step(std::max(14.0, friction) + excess);
      }
      EXPECT_TRUE(found) << friction << ", " << excess;
      EXPECT_LT(joint.q, 3e-3) << friction << ", " << excess;
    }
  }
}

// At 100 Hz the wrist of a light arm was called frozen: friction stops it at once where the joints
// in line with it give way.
TEST(StillJoint, AJointThatFrictionStopsAtOnceIsNotFrozen) {
  const auto is_frozen = [](double free_inertia) {
    StillJoint still;
    JointLoad load{.surely = 0.4,
                   .at_most = 0.4,
                   .dry = 1.0,
                   .effort = 50.0,
                   .inertia = 0.43,
                   .free_inertia = free_inertia,
                   .elapsed = 0.005};
    (void)still.step(0.0, 0.055, -1e-6, 0.055, load, {});
    (void)still.step(0.0, 0.0, 0.0, 0.055, load, {});
    return still.step(0.0, 0.0, 0.0, 0.0, load, {});
  };
  EXPECT_FALSE(is_frozen(0.02));
  EXPECT_TRUE(is_frozen(0.43)) << "this one would have gone on";
}

// It was called frozen whenever it crept: its steps were coarser than was told.
TEST(StillJoint, TheStepsOfACoarseEncoderAreLearned) {
  Pushed joint(10.0);
  joint.step_of = 1e-4;
  for (int tick = 0; tick < 4000; ++tick) {
    const double goal = 0.3 * std::sin(0.5 * tick * T);
    const double net = 4000.0 * (goal - joint.q) - 200.0 * joint.v;
    ASSERT_FALSE(joint.step(std::clamp(net, -60.0, 60.0))) << "tick " << tick;
  }
  joint.is_frozen = true;
  bool found = false;
  for (int tick = 0; tick < 400 && !found; ++tick) found = joint.step(40.0);
  EXPECT_TRUE(found) << "it still finds a frozen one";
}

TEST(StillJoint, WithoutFrictionTheLeastPushTells) {
  Pushed joint(0.0);
  joint.is_frozen = true;
  joint.load.dry = 0.0;
  int ticks = 0;
  while (!joint.step(21.0)) ASSERT_LT(++ticks, 100);
  EXPECT_LT(joint.q, 1e-2);
}

TEST(StillJoint, ABrakeHoldsItWhateverIsSent) {
  StillJoint still;
  JointLoad load{.surely = 50.0, .at_most = 50.0, .effort = 100.0, .elapsed = T, .is_held = true};
  for (int tick = 0; tick < 400; ++tick) ASSERT_FALSE(still.step(0.1, 0.0, 0.1, 0.0, load, {}));
  EXPECT_EQ(still.probe(load, {}), 0.0);
}

TEST(StillJoint, AnArmThatMayTouchThingsIsNotAsked) {
  StillJoint still;
  const JointWatchOptions options{.touches = true};
  JointLoad load{.surely = 50.0, .at_most = 50.0, .effort = 100.0, .elapsed = T};
  for (int tick = 0; tick < 400; ++tick) {
    ASSERT_FALSE(still.step(0.1, 0.0, 0.1, 0.0, load, options));
    ASSERT_EQ(still.probe(load, options), 0.0);
  }
}

}  // namespace still_joint_test
}  // namespace repel
