// SPDX-License-Identifier: BSD-3-Clause
// The adapter to an update loop, with a stand-in for controller manager and hardware.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <gantry.hpp>

#include "examples/heap.hpp"
#include "update_loop/gantry_controller.hpp"

namespace repel::test {
namespace update_loop_test {

/// A gantry whose tool is led towards a wall by 0.1 m/s; its face is at x = 0.25 m, the radius of
/// the ball 0.05 m.
class UpdateLoop : public testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(gantry.configure()); }

  void cycle(int late = 0) {
    network::HandInput hand;
    hand.ball.linear = {0.1, 0.0, 0.0};
    controller.lead(hand);
    const HeapScope counted;
    gantry.cycle(late);
    least_gap = std::min(least_gap, gap());
    fastest = std::max(fastest, std::abs(gantry.v[0]));
  }
  void cycles(int number) {
    for (int i = 0; i < number; ++i) cycle();
  }
  double gap() const { return 0.25 - 0.05 - gantry.q[0]; }
  const TickRecord& tick() const { return *controller.record(); }

  adapters::GantryController controller;
  stand_in::Gantry gantry{controller};
  double least_gap = 1.0;  // [m]
  double fastest = 0.0;    // [m/s]
};

TEST_F(UpdateLoop, ToolPressesOnTheWallAndStaysOutOfIt) {
  ASSERT_TRUE(gantry.activate());
  const std::int64_t before = heap_calls();
  cycles(4000);
  EXPECT_EQ(heap_calls(), before);
  EXPECT_GT(least_gap, 1e-3);
  EXPECT_LT(gap(), 6e-3);
  EXPECT_NEAR(tick().virtual_force.force.norm(), 72.0, 5.0);
  EXPECT_NEAR(gantry.q[2], 0.0, 1e-3);  // the weight is held
}

TEST_F(UpdateLoop, LateUpdatesAreNoFault) {
  ASSERT_TRUE(gantry.activate());
  Status found = 0;
  for (int k = 0; k < 4000; ++k) {
    cycle(k % 50 == 49 ? 1 + k / 50 % 9 : 0);
    found |= tick().status;
    if (k % 50 == 49) {
      EXPECT_EQ(tick().elapsed, 2 + k / 50 % 9);
    }
  }
  EXPECT_EQ(found & status::failsafe, 0U) << to_text(found);
  EXPECT_GT(least_gap, 1e-3);
  EXPECT_LT(gap(), 6e-3);
}

TEST_F(UpdateLoop, GoesOnWhereverItIsActivatedAgain) {
  ASSERT_TRUE(gantry.activate());
  cycles(4000);
  gantry.deactivate();
  EXPECT_EQ(gantry.effort, (std::array<double, 3>{}));
  cycles(500);
  gantry.q = {-0.1, 0.2, 0.1};  // another controller moved the arm
  ASSERT_TRUE(gantry.activate());
  fastest = 0.0;
  cycle();
  EXPECT_NE(tick().status & status::clock_gap, 0U);
  EXPECT_EQ(tick().stop, Stop::holding);
  int held = 1;
  while (tick().stop != Stop::running && held < 20000) cycle(), ++held;
  EXPECT_LT(held, 1500);
  cycles(5000);
  EXPECT_LT(fastest, 0.12);
  EXPECT_GT(least_gap, 1e-3);
  EXPECT_LT(gap(), 6e-3);
}

TEST_F(UpdateLoop, ShortPauseIsNoFault) {
  ASSERT_TRUE(gantry.activate());
  cycles(1000);
  gantry.deactivate();
  gantry.cycles(50);
  ASSERT_TRUE(gantry.activate());
  for (int k = 0; k < 4000; ++k) {
    cycle();
    ASSERT_EQ(tick().status & status::failsafe, 0U) << k << ": " << to_text(tick().status);
  }
  EXPECT_GT(least_gap, 1e-3);
  EXPECT_LT(gap(), 6e-3);
}

TEST_F(UpdateLoop, LostReadingsDeactivateItAndAskForANewCell) {
  ASSERT_TRUE(gantry.activate());
  cycles(1500);
  const double before = gap();
  gantry.report({std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0});
  int needed = 0;
  while (gantry.is_active() && needed < 100) cycle(), ++needed;
  EXPECT_LE(needed, 22);  // 20 ms of braking by prediction
  gantry.cycle();
  EXPECT_EQ(gantry.v, (std::array<double, 3>{}));
  EXPECT_LT(before - gap(), 3e-3);
  gantry.report_truth();
  EXPECT_FALSE(gantry.activate());
  ASSERT_TRUE(gantry.cleanup() && gantry.configure() && gantry.activate());
  cycles(4000);
  EXPECT_GT(least_gap, 1e-3);
  EXPECT_LT(gap(), 6e-3);
}

TEST_F(UpdateLoop, OneLockedInterfaceIsNoFaultAndForeverIsOne) {
  ASSERT_TRUE(gantry.activate());
  for (int k = 0; k < 1000; ++k) {
    gantry.is_locked = k % 10 == 9;
    cycle();
    ASSERT_EQ(tick().status & status::failsafe, 0U) << to_text(tick().status);
  }
  gantry.is_locked = true;
  cycles(30);
  EXPECT_FALSE(gantry.is_active());
}

TEST_F(UpdateLoop, NothingReadAtFirstIsNoPosition) {
  gantry.q = {0.1, 0.1, 0.1};
  gantry.is_locked = true;
  ASSERT_TRUE(gantry.activate());
  cycle();
  EXPECT_NE(tick().status & status::bad_joints, 0U);
}

TEST_F(UpdateLoop, ReleaseOfTheOperatorWithoutMaster) {
  ASSERT_TRUE(gantry.activate());
  gantry.cycles(500);
  EXPECT_NE(tick().status & status::silent_device, 0U);
  EXPECT_NEAR(gantry.q[0], 0.0, 1e-3);
}

/// Its wall is where the tool starts.
class Stuck final : public adapters::GantryController {
  CellDescription describe() const override {
    CellDescription cell = GantryController::describe();
    cell.obstacles[0].X_WP = Pose::Identity();
    return cell;
  }
};

TEST(RepelController, DescriptionThatIsRefusedIsAFailureOfConfigure) {
  Stuck controller;
  stand_in::Gantry gantry(controller);
  EXPECT_FALSE(gantry.configure());
}

TEST(RepelController, ReadsInterfacesOfOlderAndNewerReleases) {
  struct Older {
    double get_value() const { return 3.0; }
  };
  EXPECT_EQ(adapters::value_of(Older{}, 1.0), 3.0);
  double value = 2.0;
  bool is_locked = false;
  const hardware_interface::LoanedStateInterface newer({"x/position", &value, &is_locked});
  EXPECT_EQ(adapters::value_of(newer, 1.0), 2.0);
  is_locked = true;
  EXPECT_EQ(adapters::value_of(newer, 1.0), 1.0);
}

}  // namespace update_loop_test
}  // namespace repel::test
