// SPDX-License-Identifier: BSD-3-Clause
// Faults between a simulated arm and its cell before a hard wall with next to no springs, at 400
// Hz. The program `faults` (bench/faults) runs them at other rates and before soft walls as well.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <span>
#include <string>
#include <string_view>

#include "faults/trial.hpp"
#include "support/draws.hpp"

namespace repel::faults {
namespace {

/// What is known to fall short, for an arm. A fault that holds by now is to be taken off.
struct Known {
  Arm arm;
  std::string_view name;
};

constexpr Known known[] = {
    {Arm::rails, "slipped away by 2 mrad, shoulder"},
    {Arm::rails, "way and rate turned round from here on"},
    {Arm::rails, "drift of 20 mrad/s, shoulder"},
    {Arm::rails, "drift of 0.1 rad/s, shoulder"},
    {Arm::puma, "slipped away by 2 mrad, shoulder"},
    {Arm::puma, "way and rate turned round from here on"},
    {Arm::puma, "drift of 20 mrad/s, shoulder"},
    {Arm::puma, "drift of 0.1 rad/s, shoulder"},
    {Arm::puma, "readings late by 5 ticks"},
    {Arm::puma, "brake does not release, shoulder"},
};

bool is_known(Arm arm, std::string_view name) {
  return std::any_of(std::begin(known), std::end(known),
                     [&](const Known& k) { return k.arm == arm && k.name == name; });
}

void expect(bool is_short, Arm arm, const char* name) {
  if (!is_short && is_known(arm, name)) std::printf("  holds by now: %s, %s\n", to_text(arm), name);
  if (!is_known(arm, name)) {
    EXPECT_FALSE(is_short);
  }
}

/// Runs the faults of this kind, on the way to the wall and pressing against it. The PUMA takes
/// longer: it meets each in one of both, by turns.
void expect_to_hold(Arm arm, Kind kind) {
  const std::span<const Fault> all = all_faults();
  // Under a sanitizer, which makes each ten times slower, one of five.
  const std::size_t step = families::draws(20) > 1 ? 1 : 5;
  for (std::size_t i = 0; i < all.size(); i += step) {
    if (all[i].kind != kind) continue;
    bool is_short = false;
    std::string story = std::string(all[i].name) + ", " + to_text(arm);
    for (const Situation situation : {Situation::on_the_way, Situation::pressing}) {
      const bool is_turn = (i % 2 == 0) == (situation == Situation::pressing);
      if (arm == Arm::puma && !is_turn) continue;
      const Setting setting{.arm = arm, .situation = situation};
      const Outcome out = run(setting, &all[i]);
      is_short = is_short || judge(all[i], setting, out, {}) == Verdict::falls_short;
      story += std::string("; ") + to_text(situation) + ": " + std::to_string(1e3 * out.deepest) +
               " mm deep, " + repel::to_text(out.seen) + (out.unsound ? ", torque unsound" : "");
    }
    SCOPED_TRACE(story);
    expect(is_short, arm, all[i].name);
  }
}

class Faults : public testing::TestWithParam<Arm> {};

TEST_P(Faults, OfReadingsDoNotBringAnArmIntoAHardWall) {
  expect_to_hold(GetParam(), Kind::readings);
}
TEST_P(Faults, OfKinematicsDoNotBringAnArmIntoAHardWall) {
  expect_to_hold(GetParam(), Kind::kinematics);
}
TEST_P(Faults, OfTheClockDoNotBringAnArmIntoAHardWall) {
  expect_to_hold(GetParam(), Kind::clock);
}
TEST_P(Faults, OfTheDriveDoNotBringAnArmIntoAHardWall) {
  expect_to_hold(GetParam(), Kind::drive);
}
TEST_P(Faults, OfTheOperatorDoNotBringAnArmIntoAHardWall) {
  expect_to_hold(GetParam(), Kind::operators);
}

// The judge itself: without a hard wall the hand would go in, and the fault it injects is felt.
TEST_P(Faults, AreJudgedByAWallThatIsReached) {
  Setting setting{.arm = GetParam(), .situation = Situation::pressing};
  const Outcome hard = run(setting, nullptr);
  EXPECT_GE(hard.begun, 0) << "it came to the wall";
  EXPECT_LT(hard.deepest, 1e-4);
  EXPECT_EQ(hard.told, 0U) << repel::to_text(hard.told);
  setting.hold = HoldKind::soft;
  const Outcome soft = run(setting, nullptr);
  EXPECT_GE(soft.begun, 0);
  const auto all = all_faults();
  const auto nan = std::find_if(all.begin(), all.end(), [](const Fault& fault) {
    return std::string_view(fault.name) == "all positions NaN";
  });
  EXPECT_EQ(run(setting, &*nan).told, status::bad_joints);
  EXPECT_EQ(run(setting, &*nan).told_after, 0);
}

TEST_P(Faults, AreNotSeenInASoundArm) {
  for (const Sound& sound : all_sound()) {
    const Calm calm = run({.arm = GetParam()}, sound);
    SCOPED_TRACE(std::string(sound.name) + ", " + to_text(GetParam()) + ": " +
                 std::to_string(calm.blind) + " ticks not believed, " +
                 std::to_string(calm.stopped) + " without the operator, " +
                 repel::to_text(calm.seen));
    expect(judge(calm) == Verdict::falls_short, GetParam(), sound.name);
  }
}

INSTANTIATE_TEST_SUITE_P(On, Faults, testing::Values(Arm::rails, Arm::puma),
                         [](const auto& arm) { return std::string(to_text(arm.param)); });

}  // namespace
}  // namespace repel::faults
