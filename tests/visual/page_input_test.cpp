// SPDX-License-Identifier: BSD-3-Clause
#include "page_input.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace repel::visual {
namespace page_input_test {

using nlohmann::json;
using std::chrono::milliseconds;

/// Two fixtures, compliance, a scale and two hands.
ArmInfo arm_of_two_hands() {
  ArmInfo arm;
  arm.fixtures = {{.name = "seam"}, {.name = "way in"}};
  arm.relief = network::ReliefOptions{.frame = network::ReliefFrame::world};
  arm.has_scale = arm.has_handle = arm.has_second_handle = true;
  return arm;
}

json servo(double x, const char* hand) {
  return {{"type", "servo_cv"}, {"linear", {x, 0, 0}}, {"angular", {0, 0, 0}},
          {"frame", "world"},   {"clutch", true},      {"hand", hand}};
}

/// An input at a time of its own.
struct Bench {
  explicit Bench(const ArmInfo& arm = arm_of_two_hands()) : input(arm) {}

  std::string say(const json& message) { return input.take(message.at("type"), message, now); }

  PageInput input;
  PageInput::Time now{std::chrono::hours(1)};
};

TEST(PageInput, BothHandsMoveAtOnceAndEachStopsWhenNothingIsSaidOfIt) {
  Bench bench;
  EXPECT_EQ(bench.say(servo(0.1, "first")), "");
  bench.now += milliseconds(60);
  EXPECT_EQ(bench.say(servo(-0.2, "second")), "");
  EXPECT_EQ(bench.input.of(bench.now).rates.linear, Vec3(0.1, 0, 0));
  EXPECT_EQ(bench.input.of(bench.now).second.linear, Vec3(-0.2, 0, 0));
  bench.now += milliseconds(60);
  EXPECT_EQ(bench.say(servo(-0.2, "second")), "");
  EXPECT_TRUE(bench.input.of(bench.now).rates.linear.isZero(0.0));
  EXPECT_EQ(bench.input.of(bench.now).second.linear, Vec3(-0.2, 0, 0));
}

TEST(PageInput, WhoSwitchesOnlyDoesNotMoveOn) {
  Bench bench;
  EXPECT_EQ(bench.say(servo(0.1, "first")), "");
  EXPECT_EQ(bench.say({{"type", "servo_lever"}, {"direction", {0, 1, 0}}, {"rate", 0.5}}), "");
  bench.now += milliseconds(150);
  EXPECT_EQ(bench.say({{"type", "scale"}, {"factor", 2}}), "");
  EXPECT_EQ(bench.input.of(bench.now).lever_rate, 0.0);
  EXPECT_EQ(bench.input.of(bench.now).direction_W, Vec3(0, 1, 0)) << "its spring keeps its way";
  EXPECT_EQ(bench.input.of(bench.now).scale, 2.0);
}

TEST(PageInput, EachSwitchLeavesTheOthersAndOutlastsItsPage) {
  Bench bench;
  EXPECT_EQ(bench.input.of(bench.now).guides, network::as_before);
  EXPECT_EQ(bench.say({{"type", "guides"}, {"on", {"way in"}}, {"strength", 0.5}}), "");
  EXPECT_EQ(bench.say({{"type", "compliant"}, {"directions", {"z", "rx"}}}), "");
  EXPECT_EQ(bench.say({{"type", "guides"}, {"on", {"seam", "way in", "seam"}}}), "");
  EXPECT_NE(bench.say({{"type", "guides"}, {"on", {"seams"}}, {"strength", 1}}), "");
  bench.input.rest(Driver::nobody);
  const DriverInput input = bench.input.of(bench.now);
  EXPECT_EQ(input.guides, 3);
  EXPECT_EQ(input.guide_strength, 0.5);
  EXPECT_EQ(input.compliant, network::Relief::world_bit | 4 | 8) << "in the frame of the scene";
  EXPECT_EQ(input.scale, 0.0) << "as before";
  bench.input.forget();
  EXPECT_EQ(bench.input.of(bench.now).guides, network::as_before);
  EXPECT_EQ(bench.input.of(bench.now).compliant, network::as_before);
}

TEST(PageInput, WithoutTheModulesNothingCanBeSwitched) {
  Bench bench{ArmInfo{}};
  for (const json& message :
       {json{{"type", "scale"}, {"factor", 1}}, json{{"type", "guides"}, {"on", json::array()}},
        json{{"type", "compliant"}, {"directions", json::array()}}, servo(0.1, "second")}) {
    EXPECT_NE(bench.say(message), "") << message;
  }
  EXPECT_EQ(bench.say(servo(0.1, "first")), "");
}

}  // namespace page_input_test
}  // namespace repel::visual
