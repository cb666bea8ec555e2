// SPDX-License-Identifier: BSD-3-Clause
// What a page can switch while it drives: fixtures, compliant directions, the scale, the hand.
#include <algorithm>

#include "end_to_end/live.hpp"

namespace repel::test {
namespace live_inputs_test {

const Vec3 rest(0, 0, 0);

/// Two hands hold a tool at 0.60 -0.15 0.43 m, 20 mm above a shelf that attracts it once it is on.
std::string scene_text() {
  return "name: shelf\nrobot:\n  urdf: " REPEL_SOURCE
         "/robots/puma560.urdf\n  start: 0 45 -180 0 -45 0 deg\n"
         "  tool_frame: {position: 0 0 150 mm}\n"
         "tool:\n  - {name: ball, shape: sphere, radius: 10 mm}\nobstacles: []\n"
         "network:\n"
         "  - {module: six_axes, name: left, to: tool}\n"
         "  - {module: six_axes, name: right, hand: second, motion_scale: 2, to: tool}\n"
         "  - {module: junction, name: tool}\n"
         "  - {module: relief, angular_stiffness: 0 N m/rad, angular_damping: 0 N m s/rad}\n"
         "  - {module: kbb2}\n"
         "  - {module: obstacle}\n"
         "  - module: guide\n"
         "    fixtures:\n"
         "      - {name: shelf, shape: plane, position: 0.6 -0.15 0.41 m, range: 0.1 m, on: no}\n"
         "      - {name: far away, shape: tube, radius: 5 mm, range: 0.1 m,\n"
         "         points: [2 2 2 m, 2 2 3 m]}\n"
         "  - {module: puma_kin}\n  - {module: limits}\n  - {module: puma_joints}\n"
         "script:\n  - {name: wait, device: six_axes, duration: 60 s}\n";
}

Json guides(const std::vector<std::string>& on) {
  return {{"type", "guides"}, {"on", on}};
}

const Json& arm_of(const Json& frame) {
  return frame.at("arms")[0];
}

/// [m] of the tool.
double height_of(const Json& frame) {
  return frame.at("bodies")[1][2];
}

/// Led by a hand until such a frame arrives.
Json lead(LivePage& page, const char* hand, const Vec3& velocity, const LivePage::Such& such) {
  const Json servo{{"type", "servo_cv"},
                   {"hand", hand},
                   {"linear", {velocity.x(), velocity.y(), velocity.z()}},
                   {"angular", {0, 0, 0}},
                   {"frame", "world"},
                   {"clutch", true}};
  return page.await("frame", such, [&] { page.say(servo); });
}

TEST(LiveInputs, APageIsToldWhatThereIsToSwitchAndHowItIs) {
  const Folder folder;
  LiveTeleop program({folder.with("shelf.yaml", scene_text())});
  LivePage page(program);
  const Json scene = page.await("scene");
  ASSERT_FALSE(scene.is_null());
  const Json& arm = arm_of(scene);
  ASSERT_EQ(arm.at("fixtures").size(), 2U);
  const Json& shelf = arm.at("fixtures")[0];
  EXPECT_EQ(shelf.at("name"), "shelf");
  EXPECT_EQ(shelf.at("shape"), "plane");
  EXPECT_EQ(shelf.at("pose"), (Json{0.6, -0.15, 0.41, 0.0, 0.0, 0.0, 1.0}));
  EXPECT_FALSE(shelf.contains("course"));
  const Json& tube = arm.at("fixtures")[1];
  EXPECT_EQ(tube.at("shape"), "tube");
  EXPECT_EQ(tube.at("radius_m"), 0.005);
  EXPECT_EQ(tube.at("course").front(), (Json{2.0, 2.0, 2.0}));
  EXPECT_EQ(tube.at("course").back(), (Json{2.0, 2.0, 3.0}));
  EXPECT_EQ(arm.at("compliant"), (Json{"x", "y", "z"})) << "about the axes nothing holds it";
  EXPECT_EQ(arm.at("scale"), (Json{1e-3, 1e3}));
  EXPECT_EQ(arm.at("hands"), 2);
  const Json frame = page.await("frame");
  ASSERT_FALSE(frame.is_null());
  EXPECT_EQ(arm_of(frame).at("guides"), Json{"far away"});
  EXPECT_EQ(arm_of(frame).at("guide_strength"), 1.0);
  EXPECT_EQ(arm_of(frame).at("compliant"), Json::array());
  EXPECT_EQ(arm_of(frame).at("compliant_frame"), "tool");
  EXPECT_EQ(arm_of(frame).at("scale"), 1.0);
  for (const char* key : {"grip_n", "grip_nm", "second_grip_n", "second_grip_nm"}) {
    EXPECT_EQ(arm_of(frame).at(key).size(), 3U) << key;
  }
}

TEST(LiveInputs, WhereThereIsNothingToSwitchNothingIsSaidOfIt) {
  LiveTeleop program({"plates"});
  LivePage page(program);
  const Json scene = page.await("scene");
  const Json frame = page.await("frame");
  ASSERT_FALSE(scene.is_null() || frame.is_null());
  for (const char* key : {"fixtures", "hands"}) EXPECT_FALSE(arm_of(scene).contains(key)) << key;
  for (const char* key : {"guides", "guide_strength", "grip_n", "second_grip_n"}) {
    EXPECT_FALSE(arm_of(frame).contains(key)) << key;
  }
}

TEST(LiveInputs, WhatTheScriptSwitchesIsSeen) {
  LiveTeleop program({"follow_a_seam"});
  LivePage page(program);
  const auto held_by = [](const char* name) {
    return [name](const Json& f) { return arm_of(f).at("guides") == Json{name}; };
  };
  const Json in = page.await("frame", held_by("way in"));
  ASSERT_FALSE(in.is_null());
  EXPECT_EQ(in.at("phase"), "down the cone");
  const Json along = page.await("frame", held_by("seam"));
  ASSERT_FALSE(along.is_null());
  EXPECT_EQ(along.at("phase"), "along the seam");
}

TEST(LiveInputs, AFixtureThatIsSwitchedOnDrawsTheToolAndLetsItGoAgain) {
  const Folder folder;
  LiveTeleop program({folder.with("shelf.yaml", scene_text())});
  LivePage page(program);
  ASSERT_FALSE(page.take().is_null());
  const Json before = page.drive(rest, [](const Json& f) { return f.at("tick") > 100; });
  ASSERT_FALSE(before.is_null());
  const double height = height_of(before);
  page.say(guides({"shelf"}));
  const Json held = page.drive(rest, [&](const Json& f) { return height_of(f) < height - 5e-3; });
  ASSERT_FALSE(held.is_null());
  EXPECT_EQ(arm_of(held).at("guides"), Json{"shelf"});
  EXPECT_GT(arm_of(held).at("grip_n")[2].get<double>() * -1.0, 0.3) << "the hand is drawn along";
  page.say(guides({}));
  double lowest = height;
  const Json free = page.drive(rest, [&](const Json& f) {
    lowest = std::min(lowest, height_of(f));
    return height_of(f) > lowest + 2e-3;
  });
  ASSERT_FALSE(free.is_null()) << "the hand draws it back";
  EXPECT_EQ(arm_of(free).at("guides"), Json::array());
  // With a tenth of its strength.
  Json weak = guides({"shelf"});
  weak["strength"] = 0.1;
  page.say(weak);
  EXPECT_FALSE(page.drive(rest, [](const Json& f) { return arm_of(f).at("guide_strength") == 0.1; })
                   .is_null());
}

TEST(LiveInputs, ScaleComplianceAndTheOtherHandAreObeyed) {
  const Folder folder;
  LiveTeleop program({folder.with("shelf.yaml", scene_text())});
  LivePage page(program);
  ASSERT_FALSE(page.take().is_null());
  page.say({{"type", "scale"}, {"factor", 0.5}});
  page.say({{"type", "compliant"}, {"directions", {"z", "x"}}, {"frame", "world"}});
  const Json frame = page.drive(rest, [](const Json& f) {
    return arm_of(f).at("scale") == 0.5 && arm_of(f).at("compliant") == Json{"x", "z"};
  });
  ASSERT_FALSE(frame.is_null());
  EXPECT_EQ(arm_of(frame).at("compliant_frame"), "world");
  const double height = height_of(frame);
  const Json lower = lead(page, "second", Vec3(0, 0, -0.05),
                          [&](const Json& f) { return height_of(f) < height - 0.01; });
  ASSERT_FALSE(lower.is_null());
  EXPECT_GT(arm_of(lower).at("grip_n")[2].get<double>() * -1.0, 0.1)
      << "the first hand feels the second, which draws it along";
  EXPECT_EQ(arm_of(lower).at("scale"), 0.5) << "it stays";
  // Another page finds it as it is.
  page.say({{"type", "release"}});
  ASSERT_FALSE(
      page.await("operator", [](const Json& o) { return o.at("by") == "nobody"; }).is_null());
  LivePage next(program);
  ASSERT_FALSE(next.take().is_null());
  const Json later = next.drive(rest, [](const Json&) { return true; });
  ASSERT_FALSE(later.is_null());
  EXPECT_EQ(arm_of(later).at("scale"), 0.5);
}

TEST(LiveInputs, WhatIsWrongIsRefusedWithAReason) {
  const Folder folder;
  LiveTeleop program({folder.with("shelf.yaml", scene_text())});
  LivePage page(program);
  EXPECT_EQ(page.refusal_of(guides({"shelf"})), "take the controls first");
  ASSERT_FALSE(page.take().is_null());
  const Json still{0, 0, 0};
  const struct {
    Json message;
    const char* why;
  } cases[] = {
      {guides({"shelf", "shelves"}), "there is no such fixture; there are: shelf, far away"},
      {{{"type", "guides"}}, "'on' is no list of names"},
      {{{"type", "guides"}, {"on", "shelf"}}, "'on' is no list of names"},
      {{{"type", "guides"}, {"on", {1}}}, "'on' is no list of names"},
      {{{"type", "guides"}, {"on", {"shelf"}}, {"strength", 1.1}}, "out of range"},
      {{{"type", "guides"}, {"on", {"shelf"}}, {"strength", -0.1}}, "out of range"},
      {{{"type", "scale"}}, "out of range"},
      {{{"type", "scale"}, {"factor", 0.0}}, "out of range"},
      {{{"type", "scale"}, {"factor", -1.0}}, "out of range"},
      {{{"type", "scale"}, {"factor", 1e4}}, "out of range"},
      {{{"type", "scale"}, {"factor", "1"}}, "out of range"},
      {{{"type", "compliant"}}, "no list"},
      {{{"type", "compliant"}, {"directions", {"up"}}}, "a direction is x, y, z, rx, ry or rz"},
      {{{"type", "compliant"}, {"directions", {"rx"}}}, "neither stiffness nor damping"},
      {{{"type", "compliant"}, {"directions", {"x"}}, {"frame", "hand"}}, "world or tool"},
      {{{"type", "servo_cv"},
        {"hand", "third"},
        {"linear", still},
        {"angular", still},
        {"frame", "world"}},
       "a hand is first or second"},
      {{{"type", "servo_lever"}, {"hand", "second"}, {"direction", {1, 0, 0}}, {"rate", 0}},
       "the lever of the first hand only"},
  };
  for (const auto& [message, why] : cases) {
    EXPECT_NE(page.refusal_of(message).find(why), std::string::npos) << message;
  }
  const Json frame = page.drive(rest, [](const Json&) { return true; });
  ASSERT_FALSE(frame.is_null());
  EXPECT_EQ(arm_of(frame).at("guides"), Json{"far away"}) << "nothing of that was done";
  EXPECT_EQ(arm_of(frame).at("scale"), 1.0);
  EXPECT_EQ(arm_of(frame).at("compliant"), Json::array());
}

TEST(LiveInputs, WhereANetworkHasNoSuchModuleItIsSaid) {
  LiveTeleop program({"anderson_4x8"});
  LivePage page(program);
  ASSERT_FALSE(page.take().is_null());
  EXPECT_EQ(page.refusal_of(guides({})), "the network has no fixtures");
  EXPECT_EQ(page.refusal_of({{"type", "servo_cv"},
                             {"hand", "second"},
                             {"linear", {0, 0, 0}},
                             {"angular", {0, 0, 0}},
                             {"frame", "world"}}),
            "the network has no master in a second hand");
}

TEST(LiveInputs, ARunInWhichAPageSwitchedIsGoneThroughAgainBitForBit) {
  const Folder folder;
  const std::string scene = folder.with("shelf.yaml", scene_text());
  {
    LiveTeleop program({scene, "--log", folder / "run.mcap"});
    LivePage page(program);
    ASSERT_FALSE(page.take().is_null());
    const Json before = page.drive(rest, [](const Json& f) { return f.at("tick") > 50; });
    ASSERT_FALSE(before.is_null());
    Json on = guides({"shelf", "far away"});
    on["strength"] = 0.75;
    page.say(on);
    page.say({{"type", "compliant"}, {"directions", {"z"}}});
    page.say({{"type", "scale"}, {"factor", 1.5}});
    const double height = height_of(before);
    ASSERT_FALSE(lead(page, "second", Vec3(0.01, 0, -0.03), [&](const Json& f) {
                   return height_of(f) < height - 8e-3;
                 }).is_null());
    page.say(guides({}));
    page.say({{"type", "compliant"}, {"directions", Json::array()}});
    ASSERT_FALSE(
        page.drive(Vec3(0, 0, 0.05), [&](const Json& f) { return height_of(f) > height - 2e-3; })
            .is_null());
    const Ending ending = program.interrupt();
    ASSERT_EQ(ending.status, 0) << ending;
  }
  const Ending again = teleop("replay " + quoted(folder / "run.mcap") + " --report " +
                              quoted(folder / "report.json"));
  EXPECT_EQ(again.status, 0) << again;
  const Json replay = report_of(folder / "report.json").at("replay");
  EXPECT_GT(replay.at("ticks"), 100);
  EXPECT_EQ(replay.at("same"), replay.at("ticks"));
  EXPECT_EQ(replay.at("force_difference_n"), 0.0);
}

}  // namespace live_inputs_test
}  // namespace repel::test
