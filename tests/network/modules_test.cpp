// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/modules.hpp>

#include <gtest/gtest.h>

#include <repel/network/plan.hpp>

namespace repel::network {
namespace modules_test {

// One header is enough to build a network: every module in scenes/README.md can be built.
TEST(Modules, BuildANetworkOfAllKindsWithThisHeaderAndAPlan) {
  const Mat<any_size> one = Mat<any_size>::Identity(1, 1);
  const Network network = Plan()
                              .add("torque_arm", TorqueArm(), "hand")
                              .add("spring", Spring<any_size>(one), "hand")
                              .add("mass", Mass<any_size>(one), "hand")
                              .add("damper", Damper<any_size>(one), "hand")
                              .add("push", EffortSource<any_size>(Vec<any_size>::Zero(1)), "hand")
                              .add("hand", Junction(), "multiplex")
                              .add("multiplex", Multiplex())
                              .add("spaceball", Spaceball())
                              .add("relief", Relief())
                              .add("line", Line())
                              .add("kbb2", Kbb2(), "tool")
                              .add("ground", Ground(), "weld")
                              .add("weld", Kbb2(), "tool")
                              .add("tool", Junction(), "obstacle")
                              .add("obstacle", Obstacle())
                              .add("puma_kin", PumaKin())
                              .add("arm_obstacle", ArmObstacle())
                              .add("limits", Limits({}, {{-1.0, 1.0}, {-1.0, 1.0}}))
                              .add("posture", Posture())
                              .add("visual", Visual())
                              .add("puma_joints", PumaJoints(2))
                              .build(0.001);
  EXPECT_EQ(network.nodes().size(), 21U);
}

}  // namespace modules_test
}  // namespace repel::network
