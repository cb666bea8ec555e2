// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include <repel/schedule/world_changes.hpp>

#include "visual/live_stage.hpp"

namespace repel::visual {
namespace live_view_test {

const Json take{{"type", "take"}};
const Json release{{"type", "release"}};

TEST(LivePages, WhoComesIsToldAll) {
  LiveStage stage;
  ++stage.pages.open;
  stage.show.opened(4, Role::drives, stage.pages);
  const std::vector<Json> heard = stage.pages.heard_by(4);
  ASSERT_GE(heard.size(), 3U);
  EXPECT_EQ(heard.front().at("type"), "scene");
  for (const char* type : {"scene", "operator", "timing"}) {
    EXPECT_NE(last_of(heard, type), nullptr) << type;
  }
  EXPECT_EQ(last_of(heard, "frame"), nullptr) << "no tick was made";
  EXPECT_EQ(last_of(heard, "operator")->at("by"), "script");
  EXPECT_EQ(last_of(heard, "operator")->at("pages"), 4);
}

TEST(LivePages, OnePageAtATimeHasTheControls) {
  LiveStage stage;
  EXPECT_EQ(stage.say(1, servo(0.1, 0, 0)), "take the controls first");
  EXPECT_EQ(stage.say(1, release), "take the controls first");
  EXPECT_FALSE(stage.posted());
  EXPECT_EQ(stage.say(1, take), "");
  ASSERT_TRUE(stage.posted());
  EXPECT_EQ(stage.input().driver, Driver::page);
  EXPECT_TRUE(stage.input().rates.linear.isZero(0.0));
  for (const Json& message :
       {take, release, servo(0, 0, 0.1), Json{{"type", "pause"}}, Json{{"type", "resume"}},
        Json{{"type", "restart"}}, Json{{"type", "step"}, {"ticks", 1}}}) {
    EXPECT_EQ(stage.say(2, message), "another page has the controls") << message;
  }
  EXPECT_FALSE(stage.posted());
  EXPECT_FALSE(stage.controls.paused);
  EXPECT_FALSE(stage.controls.restart);
  EXPECT_EQ(stage.controls.steps, 0);
  EXPECT_EQ(stage.say(1, servo(0.1, 0, 0)), "");
  ASSERT_TRUE(stage.posted());
  EXPECT_EQ(stage.input().rates.linear, Vec3(0.1, 0, 0));
  EXPECT_EQ(stage.say(1, release), "");
  ASSERT_TRUE(stage.posted());
  EXPECT_EQ(stage.input().driver, Driver::nobody);
  EXPECT_EQ(stage.say(2, take), "");
}

TEST(LivePages, EveryPageIsToldWhoDrives) {
  LiveStage stage;
  stage.show.heard(1, take.dump(), stage.pages);
  for (const int page : {1, 2, 3}) {
    const std::vector<Json> heard = stage.pages.heard_by(page);
    const Json* who = last_of(heard, "operator");
    ASSERT_NE(who, nullptr) << page;
    EXPECT_EQ(who->at("by"), "page");
    EXPECT_EQ(who->at("you"), page == 1);
    EXPECT_EQ(who->at("silent"), false);
  }
  stage.show.heard(1, release.dump(), stage.pages);
  const std::vector<Json> heard = stage.pages.heard_by(2);
  EXPECT_EQ(last_of(heard, "operator")->at("by"), "nobody");
}

TEST(LivePages, WithoutTheClutchTheHandRests) {
  LiveStage stage;
  (void)stage.say(1, take);
  Json message = servo(0.1, 0, 0);
  for (const Json& clutch : {Json(false), Json("true"), Json(1), Json(nullptr), Json::object()}) {
    message["clutch"] = clutch;
    EXPECT_EQ(stage.say(1, message), "");
    ASSERT_TRUE(stage.posted());
    EXPECT_TRUE(stage.input().rates.linear.isZero(0.0)) << clutch;
    EXPECT_EQ(stage.input().driver, Driver::page);
  }
  message.erase("clutch");
  EXPECT_EQ(stage.say(1, message), "");
  ASSERT_TRUE(stage.posted());
  EXPECT_TRUE(stage.input().rates.linear.isZero(0.0));
}

TEST(LivePages, FrameAndLeverArePassedOn) {
  LiveStage stage;
  (void)stage.say(1, take);
  Json message = servo(0.1, 0, 0);
  message["frame"] = "tool";
  EXPECT_EQ(stage.say(1, message), "");
  ASSERT_TRUE(stage.posted());
  EXPECT_TRUE(stage.input().in_tool);
  EXPECT_EQ(stage.say(1, Json{{"type", "servo_lever"}, {"direction", {0, 3, 4}}, {"rate", -0.5}}),
            "");
  ASSERT_TRUE(stage.posted());
  EXPECT_TRUE(stage.input().direction_W.isApprox(Vec3(0, 0.6, 0.8)));
  EXPECT_EQ(stage.input().lever_rate, -0.5);
}

TEST(LivePages, ClosingFreesTheControlsOnlyAfterASilence) {
  LiveStage stage;
  (void)stage.say(1, take);
  --stage.pages.open;
  stage.show.closed(1, stage.pages);
  EXPECT_EQ(stage.say(2, take), "another page has the controls");
  bool silent = false;
  EXPECT_TRUE(stage.until_told([&](const Json& who) {
    silent = silent || (who.at("by") == "page" && who.at("silent") == true);
    return who.at("by") == "nobody";
  }));
  EXPECT_TRUE(silent) << "before it is free, it is silent";
  stage.controls.input.take();
  EXPECT_EQ(stage.input().driver, Driver::nobody);
  EXPECT_EQ(stage.say(2, take), "");
}

TEST(LivePages, WhoSpeaksAgainIsNoLongerSilent) {
  LiveStage stage;
  (void)stage.say(1, take);
  EXPECT_TRUE(stage.until_told([](const Json& who) { return who.at("silent") == true; }));
  EXPECT_EQ(stage.say(1, servo(0, 0, 0)), "");
  EXPECT_TRUE(stage.until_told(
      [](const Json& who) { return who.at("by") == "page" && who.at("silent") == false; }));
}

TEST(LivePages, PauseStepAndResume) {
  LiveStage stage;
  EXPECT_EQ(stage.say(1, Json{{"type", "pause"}}), "");
  EXPECT_TRUE(stage.controls.paused);
  EXPECT_EQ(stage.say(1, Json{{"type", "step"}, {"ticks", 3}}), "");
  EXPECT_EQ(stage.say(2, Json{{"type", "step"}, {"ticks", 2}}), "");
  EXPECT_EQ(stage.controls.steps, 5);
  EXPECT_EQ(stage.say(1, Json{{"type", "resume"}}), "");
  EXPECT_FALSE(stage.controls.paused);
  EXPECT_EQ(stage.controls.steps, 0);
  EXPECT_EQ(stage.say(1, Json{{"type", "step"}, {"ticks", 1}}), "");
  EXPECT_TRUE(stage.controls.paused) << "a step is one of a run that pauses";
  for (const Json& ticks : {Json(0), Json(-1), Json(0.5), Json(1.5), Json(10001), Json(1e300),
                            Json("1"), Json(nullptr)}) {
    EXPECT_NE(stage.say(1, Json{{"type", "step"}, {"ticks", ticks}}), "") << ticks;
  }
  EXPECT_EQ(stage.controls.steps, 1);
}

TEST(LivePages, RestartGivesTheControlsBackToTheScript) {
  LiveStage stage;
  (void)stage.say(1, take);
  (void)stage.say(1, Json{{"type", "pause"}});
  EXPECT_EQ(stage.say(1, Json{{"type", "restart"}}), "");
  EXPECT_TRUE(stage.controls.restart);
  EXPECT_FALSE(stage.controls.paused);
  ASSERT_TRUE(stage.posted());
  EXPECT_EQ(stage.input().driver, Driver::script);
  EXPECT_EQ(stage.say(2, take), "");
}

/// The message to a newly opened page about the present operator.
Json operator_of(LiveStage& stage, Role role = Role::drives) {
  ++stage.pages.open;
  stage.show.opened(4, role, stage.pages);
  return *last_of(stage.pages.heard_by(4), "operator");
}

TEST(LivePages, ALogIsNotBegunTwice) {
  LiveStage stage;
  stage.controls.may_restart = false;
  EXPECT_NE(stage.say(1, Json{{"type", "restart"}}), "");
  EXPECT_FALSE(stage.controls.restart);
}

TEST(LivePages, ARobotElsewhereIsDrivenAndNothingElse) {
  LiveStage stage(false, "", true, {PartId{1}});
  stage.controls.no_conduct = "it is elsewhere";
  for (const Json& message :
       {Json{{"type", "pause"}}, Json{{"type", "resume"}}, Json{{"type", "restart"}},
        Json{{"type", "step"}, {"ticks", 1}}, Json{{"type", "remove_part"}, {"part", 1}}}) {
    EXPECT_EQ(stage.say(1, message), "it is elsewhere") << message;
  }
  EXPECT_FALSE(stage.controls.paused);
  EXPECT_FALSE(stage.controls.restart);
  EXPECT_EQ(stage.controls.steps, 0);
  EXPECT_EQ(stage.say(1, Json{{"type", "take"}}), "");
  EXPECT_EQ(operator_of(stage).at("no_conduct"), "it is elsewhere");
  EXPECT_EQ(stage.say(1, servo(0.1, 0.0, 0.0)), "");
  ASSERT_TRUE(stage.posted());
  EXPECT_EQ(stage.input().driver, Driver::page);
}

TEST(LivePages, AnOperatorElsewhereKeepsTheControls) {
  LiveStage stage;
  stage.controls.no_driving = "the operator is elsewhere";
  for (const Json& message :
       {Json{{"type", "take"}}, Json{{"type", "release"}}, servo(0.1, 0, 0)}) {
    EXPECT_EQ(stage.say(1, message), "the operator is elsewhere") << message;
  }
  EXPECT_FALSE(stage.posted());
  EXPECT_EQ(stage.say(1, Json{{"type", "pause"}}), "");
  EXPECT_TRUE(stage.controls.paused);
}

TEST(LivePages, OnlyARecordingCanBeWoundOn) {
  const Json seek{{"type", "seek"}, {"time_s", 3.2}};
  const Json speed{{"type", "speed"}, {"factor", 0.25}};
  LiveStage live;
  EXPECT_EQ(live.say(1, seek), "no such message for a live run");
  EXPECT_EQ(live.say(1, speed), "no such message for a live run");
  EXPECT_LT(live.controls.seek, 0.0);
  EXPECT_EQ(live.controls.speed, 1.0);
  LiveStage replay(true);
  EXPECT_EQ(replay.say(1, seek), "");
  EXPECT_EQ(replay.controls.seek, 3.2);
  EXPECT_EQ(replay.say(1, speed), "");
  EXPECT_EQ(replay.controls.speed, 0.25);
  for (const Json& bad : {Json(-1), Json(1e10), Json("3"), Json(nullptr), Json::array({1})}) {
    EXPECT_NE(replay.say(1, Json{{"type", "seek"}, {"time_s", bad}}), "") << bad;
    EXPECT_NE(replay.say(1, Json{{"type", "speed"}, {"factor", bad}}), "") << bad;
  }
  EXPECT_NE(replay.say(1, Json{{"type", "speed"}, {"factor", 0}}), "");
  EXPECT_EQ(replay.controls.seek, 3.2);
  EXPECT_EQ(replay.controls.speed, 0.25);
}

// A time beyond the end is clamped to the last tick.
TEST(LivePages, ARecordingIsNotWoundBeyondItsLastTick) {
  for (const double time : {9.9976, 9.999, 10.0, 1000.0}) {
    LiveStage replay(true);
    EXPECT_EQ(replay.say(1, Json{{"type", "seek"}, {"time_s", time}}), "");
    EXPECT_NEAR(replay.controls.seek, 10.0 - 1.0 / 400.0, 1e-12) << time;
  }
}

/// All requests of a page.
std::vector<Json> all_requests() {
  return {take,
          release,
          servo(0.1, 0, 0),
          {{"type", "servo_lever"}, {"direction", {1, 0, 0}}, {"rate", 0.5}},
          {{"type", "pause"}},
          {{"type", "resume"}},
          {{"type", "step"}, {"ticks", 1}},
          {{"type", "restart"}},
          {{"type", "seek"}, {"time_s", 1.0}},
          {{"type", "speed"}, {"factor", 2.0}}};
}

/// No request of page `number` has an effect.
void expect_onlooker(LiveStage& stage, int number, const std::string& why) {
  for (const Json& message : all_requests()) {
    EXPECT_EQ(stage.say(number, message), why) << message;
    EXPECT_FALSE(stage.posted()) << message;
  }
  EXPECT_FALSE(stage.controls.paused);
  EXPECT_FALSE(stage.controls.restart);
  EXPECT_EQ(stage.controls.steps, 0);
  EXPECT_LT(stage.controls.seek, 0.0);
  EXPECT_EQ(stage.controls.speed, 1.0);
}

TEST(LivePages, NobodyDrivesARecording) {
  LiveStage replay(true);
  for (const Json& message : {take, release, servo(0.1, 0, 0)}) {
    EXPECT_EQ(replay.say(1, message), "this is a recording");
  }
  EXPECT_FALSE(replay.posted());
  EXPECT_EQ(operator_of(replay).at("by"), "recording");
}

TEST(LivePages, WhileADeviceDrivesPagesLookOn) {
  LiveStage stage(false, "Spaceball on /run/spnav.sock");
  const std::string why = "Spaceball on /run/spnav.sock has the controls: pages look on only";
  expect_onlooker(stage, 1, why);
  const Json who = operator_of(stage);
  EXPECT_EQ(who.at("by"), "device");
  EXPECT_EQ(who.at("looks_on"), true);
  EXPECT_EQ(who.at("why_not"), why);
}

TEST(LivePages, APageMayTakeTheControlsFromADeviceWhereThatIsAllowedAndGivesThemBack) {
  LiveStage stage(false, "Spaceball", true);
  EXPECT_EQ(operator_of(stage).at("looks_on"), false);
  EXPECT_EQ(stage.say(1, servo(0.1, 0, 0)), "take the controls first");
  EXPECT_EQ(stage.say(1, take), "");
  ASSERT_TRUE(stage.posted());
  EXPECT_EQ(stage.input().driver, Driver::page);
  EXPECT_EQ(stage.say(1, release), "");
  ASSERT_TRUE(stage.posted());
  EXPECT_EQ(stage.input().driver, Driver::device);
  EXPECT_EQ(stage.say(1, take), "");
  EXPECT_TRUE(stage.until_told([](const Json& who) { return who.at("by") == "device"; }))
      << "one that falls silent gives them back too";
  EXPECT_EQ(stage.say(1, Json{{"type", "restart"}}), "");
  EXPECT_TRUE(stage.controls.restart);
}

TEST(LivePages, WherePagesLookOnNothingTheyAskForIsDone) {
  for (const bool replay : {false, true}) {
    LiveStage stage(replay, "", false);
    expect_onlooker(stage, 1, "pages look on only");
    EXPECT_EQ(operator_of(stage).at("looks_on"), true);
  }
}

TEST(LivePages, AProgramThatIsNoBrowserLooksOnAndThePagesGoOnDriving) {
  LiveStage stage;
  EXPECT_EQ(operator_of(stage, Role::looks_on).at("looks_on"), true);
  expect_onlooker(stage, 4, "a program without an Origin or a secret looks on only");
  EXPECT_EQ(stage.say(1, take), "");
}

// The page itself respects these limits; another client need not.
TEST(LivePages, NobodyIsFasterThanTheMasterOfTheScene) {
  LiveStage stage;
  (void)stage.say(1, take);
  Json fast = servo(3, 0, 4);
  fast["angular"] = {0, -50, 0};
  EXPECT_EQ(stage.say(1, fast), "");
  ASSERT_TRUE(stage.posted());
  const ArmInfo info;
  EXPECT_TRUE(stage.input().rates.linear.isApprox(info.max_speed * Vec3(0.6, 0, 0.8)));
  EXPECT_TRUE(stage.input().rates.angular.isApprox(info.max_turn * Vec3(0, -1, 0)));
  for (const double rate : {1.6, 5.0, -100.0}) {
    EXPECT_EQ(stage.say(1, Json{{"type", "servo_lever"}, {"direction", {1, 0, 0}}, {"rate", rate}}),
              "");
    ASSERT_TRUE(stage.posted());
    EXPECT_EQ(stage.input().lever_rate, std::copysign(info.max_lever_rate, rate));
  }
}

TEST(LivePages, APictureIsShownWhenThereIsOne) {
  LiveStage stage;
  Coprocessor coprocessor(stage.boxes.world, {});
  TickRecord record;
  const TickRecord* arms[] = {&record};
  stage.show.refresh(stage.pages);
  (void)stage.pages.heard_by(1);
  stage.show.refresh(stage.pages);
  EXPECT_EQ(last_of(stage.pages.heard_by(1), "frame"), nullptr);
  for (record.tick = 1; record.tick <= 3; ++record.tick) {
    (void)coprocessor.exchange();
    stage.tap.note(coprocessor, arms, {});
    stage.tap.show(coprocessor, arms, {});
  }
  stage.show.refresh(stage.pages);
  const std::vector<Json> heard = stage.pages.heard_by(1);
  ASSERT_NE(last_of(heard, "frame"), nullptr);
  EXPECT_EQ(last_of(heard, "frame")->at("tick"), 3);
  EXPECT_EQ(last_of(heard, "frame")->at("recent").at("tick"), (Json{1, 2, 3}));
}

Json box_at(double x, double size = 0.1) {
  return {{"type", "add_box"}, {"size", {size, size, size}}, {"position", {x, 0, 0}}};
}

TEST(LivePages, BoxesComeMoveAndGoInTheSpareParts) {
  World world;
  const PartId spare = world.reserve("spare", Shape::sphere(0.01), 0.2);
  WorldChanges changes(world);
  LiveStage stage(false, "", true, {spare});
  EXPECT_NE(stage.say(1, box_at(0.5)), "") << "no cell runs";
  stage.controls.changes.open(&changes);
  EXPECT_NE(stage.say(1, box_at(0.5, 1.0)), "") << "no room for it";
  EXPECT_NE(stage.say(1, box_at(0.5, -1.0)), "");
  EXPECT_NE(stage.say(1, box_at(1e9)), "");
  EXPECT_EQ(stage.say(2, box_at(0.5)), "");
  EXPECT_NE(stage.say(1, box_at(0.6)), "") << "the only one is used";
  const Json move{{"type", "move_part"}, {"part", spare.index}, {"position", {0.7, 0, 0}}};
  EXPECT_EQ(stage.say(1, move), "");
  for (const Json& part : {Json(99), Json("x"), Json(-1), Json(1e300)}) {
    EXPECT_EQ(stage.say(1, Json{{"type", "remove_part"}, {"part", part}}), "no such box");
  }
  Coprocessor coprocessor(world, {});
  changes.apply(world, coprocessor);
  EXPECT_EQ(changes.counts().applied, 2);
  EXPECT_TRUE(world.is_there(spare));
  // Who comes later is told of its shape.
  stage.show.opened(4, Role::drives, stage.pages);
  const std::vector<Json> heard = stage.pages.heard_by(4);
  ASSERT_NE(last_of(heard, "part"), nullptr);
  EXPECT_EQ(last_of(heard, "part")->at("part"), spare.index);
  EXPECT_EQ(stage.say(1, Json{{"type", "remove_part"}, {"part", spare.index}}), "");
  EXPECT_EQ(stage.say(1, move), "no such box");
  stage.controls.may_change = false;
  EXPECT_NE(stage.say(1, box_at(0.5)).find("recording"), std::string::npos);
  stage.controls.changes.open(nullptr);
}

}  // namespace live_view_test
}  // namespace repel::visual
