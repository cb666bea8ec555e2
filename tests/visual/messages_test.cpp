// SPDX-License-Identifier: BSD-3-Clause
#include <repel/visual/messages.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <string>
#include <vector>

#include <repel/base/setup_error.hpp>

namespace repel::visual {
namespace messages_test {

using Json = nlohmann::json;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();

/// A tool of two parts, a link, two obstacles, one of them passable; one arm.
struct Stage {
  explicit Stage(const std::string& name = "stage") {
    tool = world.add_body("tool");
    link = world.add_body("link");
    Pose X = Pose::Identity();
    X.translation() = Vec3(0.1, -0.2, 0.3);
    const PartId palm = world.add_part(tool, name + " palm", Shape::box({0.1, 0.1, 0.1}), X);
    const PartId ball = world.add_part(link, "ball", Shape::sphere(0.1));
    const PartId wall = world.add_part(World::fixed, "wall", Shape::box({1, 1, 0.1}));
    const PartId gate = world.add_part(World::fixed, "gate", Shape::cylinder(0.3, 0.1));
    world.add_pair(palm, wall, {.range = 0.02});
    world.add_pair(palm, gate, {.range = 0.01, .ceiling = 10.0, .passable = true});
    world.add_pair(ball, wall, {.range = 0.03});
    info.scene = name;
    ArmInfo& arm = info.arms.emplace_back();
    arm.tool = tool;
    arm.links = {link};
    arm.joints = {"revolute", "prismatic"};
    arm.modules = {"spaceball", "kbb2"};
    arm.phases = {"down", name};
    shot.arms.resize(1);
    shot.X_WB = {Pose::Identity(), X, Pose::Identity()};
    shot.pairs.resize(4);
  }

  World world;
  BodyId tool;
  BodyId link;
  SceneInfo info;
  Snapshot shot;
};

std::set<std::string> keys_of(const Json& object) {
  std::set<std::string> keys;
  for (const auto& [key, value] : object.items()) keys.insert(key);
  return keys;
}

TEST(Messages, TheSceneIsOfTheDocumentedForm) {
  const Stage stage;
  const Json scene = Json::parse(scene_message(stage.info, stage.world));
  EXPECT_EQ(keys_of(scene), (std::set<std::string>{"type", "version", "name", "rate_hz",
                                                   "period_us", "mode", "duration_s", "bodies",
                                                   "parts", "pairs", "laws", "arms", "scripted"}));
  EXPECT_EQ(scene.at("scripted"), true);
  EXPECT_EQ(scene.at("type"), "scene");
  EXPECT_EQ(scene.at("mode"), "live");
  EXPECT_EQ(scene.at("period_us"), 2500.0);
  EXPECT_EQ(scene.at("bodies"), (Json{"world", "tool", "link"}));
  EXPECT_EQ(scene.at("pairs"), (Json{{0, 2, 0.02, 0}, {0, 3, 0.01, 1}, {1, 2, 0.03, 2}}));
  const Json& parts = scene.at("parts");
  ASSERT_EQ(parts.size(), 4U);
  const char* groups[] = {"tool", "link", "obstacle", "obstacle"};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Json& part = parts[i];
    EXPECT_EQ(keys_of(part), (std::set<std::string>{"name", "body", "group", "arm", "pose",
                                                    "passable", "range_m", "levels"}));
    EXPECT_EQ(part.at("group"), groups[i]);
    EXPECT_EQ(part.at("passable"), i == 3);
    EXPECT_EQ(part.at("pose").size(), 7U);
    ASSERT_EQ(part.at("levels").size(),
              static_cast<std::size_t>(stage.world.parts()[i].shape.levels()));
    EXPECT_EQ(part.at("levels")[0].at("depth_m"), 0.0);
    for (const Json& level : part.at("levels")) {
      EXPECT_EQ(keys_of(level), (std::set<std::string>{"depth_m", "vertices", "triangles"}));
      EXPECT_EQ(level.at("vertices").size() % 3, 0U);
      EXPECT_EQ(level.at("triangles").size() % 3, 0U);
      for (const Json& vertex : level.at("triangles")) {
        EXPECT_LT(vertex.get<std::size_t>(), level.at("vertices").size() / 3);
      }
    }
  }
  EXPECT_EQ(parts[2].at("range_m"), 0.03);
  EXPECT_EQ(parts[0].at("pose"), (Json{0.1, -0.2, 0.3, 0.0, 0.0, 0.0, 1.0}));
  EXPECT_EQ(keys_of(scene.at("arms")[0]),
            (std::set<std::string>{"name", "joints", "modules", "tool_body", "max_speed_m_s",
                                   "max_turn_rad_s", "max_lever_rad_s", "signals"}));
}

TEST(Messages, EachLawIsToldOnceAndEachPairSaysItsOwn) {
  Stage stage;
  const PartId finger = stage.world.add_part(stage.tool, "finger", Shape::sphere(0.01));
  stage.world.add_pair(finger, PartId{2}, {.range = 0.02});
  stage.world.add_pair(finger, PartId{3}, {.range = 0.02, .hold = HoldKind::hard});
  const Json scene = Json::parse(scene_message(stage.info, stage.world));
  const Json& laws = scene.at("laws");
  ASSERT_EQ(laws.size(), 4U);
  EXPECT_EQ(laws[0], (Json{{"range_m", 0.02},
                           {"surface_force_n", 100.0},
                           {"damping_ns_m", 50.0},
                           {"passable", false},
                           {"hard", false}}));
  EXPECT_EQ(laws[1].at("ceiling_n"), 10.0);
  EXPECT_EQ(laws[1].at("passable"), true);
  EXPECT_EQ(laws[3].at("hard"), true);
  EXPECT_EQ(scene.at("pairs")[3][3], 0) << "as the first";
  EXPECT_EQ(scene.at("pairs")[4][3], 3);
}

// The page draws any of them by these names, so each name has a value and no other.
TEST(Messages, AnArmHasTheSignalsOfItsLogAndTheLimitsOfItsJoints) {
  Stage stage;
  ArmLink hinge{.name = "upper", .joint_name = "shoulder", .lower = -1.0, .upper = 2.0};
  hinge.effort_limit = 97.6;
  ArmLink wheel{.joint_name = "wheel", .lower = -infinite, .upper = infinite};
  stage.info.arms.front().links_of_model = {hinge, wheel};
  const Json arm = Json::parse(scene_message(stage.info, stage.world)).at("arms")[0];
  EXPECT_EQ(arm.at("limits")[0], (Json{{"name", "shoulder"},
                                       {"lower", -1.0},
                                       {"upper", 2.0},
                                       {"rate", nullptr},
                                       {"effort", 97.6}}));
  EXPECT_TRUE(arm.at("limits")[1].at("upper").is_null());

  TickRecord& record = stage.shot.arms.front();
  record.p_WT = Vec3(0.1, 0.2, 0.3);
  record.q = {0.5, -0.25};
  record.torques = {7.0, 8.0};
  record.energy = {0.0F, 0.25F};
  record.gain = 0.75;
  const Json now = Json::parse(frame_message(stage.info, stage.world, stage.shot, {}, true));
  const Json& values = now.at("arms")[0].at("signals");
  const Json& names = arm.at("signals");
  ASSERT_EQ(values.size(), names.size());
  const auto value_of = [&](const char* name) {
    const auto found = std::find(names.begin(), names.end(), name);
    return found == names.end() ? Json("none")
                                : values.at(static_cast<std::size_t>(found - names.begin()));
  };
  EXPECT_EQ(value_of("z_m"), 0.3);
  EXPECT_EQ(value_of("q1_rad"), 0.5);
  EXPECT_EQ(value_of("q2_m"), -0.25);
  EXPECT_EQ(value_of("tau2_n"), 8.0);
  EXPECT_EQ(value_of("energy_kbb2_j"), 0.25);
  EXPECT_EQ(value_of("gain"), 0.75);
  EXPECT_TRUE(value_of("hold_margin_m").is_null()) << "no hard wall is near";
}

TEST(Messages, AFrameSaysWhatHardWallsHold) {
  Stage stage;
  const auto hold_of = [&stage] {
    const Json frame = Json::parse(frame_message(stage.info, stage.world, stage.shot, {}, true));
    return frame.at("arms")[0].value("hold", Json());
  };
  EXPECT_TRUE(hold_of().is_null());
  TickRecord& record = stage.shot.arms.front();
  record.hold.margin = 0.004;
  record.hold.pair = PairId{1};
  record.held_force = 12.0;
  EXPECT_EQ(hold_of(), (Json{{"pair", 1}, {"margin_m", 0.004}, {"force_n", 12.0}}));
}

TEST(Messages, AnImageOfACameraIsToldInMillimetres) {
  const Json told = Json::parse(depth_message("left \"eye\"", {2, 1, {412, 0}}));
  EXPECT_EQ(told, (Json{{"type", "depth"},
                        {"camera", "left \"eye\""},
                        {"width", 2},
                        {"height", 1},
                        {"mm", {412, 0}}}));
}

// A bit of one tick would be missed in pictures alone.
TEST(Messages, EveryChangeOfTheStatusHasItsTick) {
  const Stage stage;
  TickSample samples[4];
  for (std::size_t i = 0; i < 4; ++i) samples[i].tick = static_cast<std::int64_t>(100 + i);
  samples[1].status = samples[2].status = status::saturated;
  const Json frame = Json::parse(frame_message(stage.info, stage.world, stage.shot, samples, true));
  EXPECT_EQ(frame.at("recent").at("status"),
            Json::parse(R"([[100, []], [101, ["saturated"]], [103, []]])"));
}

TEST(Messages, APartHasWhatIsNotCoveredOfItsMesh) {
  Stage stage;
  stage.info.gaps = {{PartId{1}, 7, {{{0.1, 0, -0.2}, 0.004}, {{0, 0, 1}, 0.001}}}};
  const Json parts = Json::parse(scene_message(stage.info, stage.world)).at("parts");
  EXPECT_EQ(parts[1].at("gap_count"), 7);
  EXPECT_EQ(parts[1].at("gaps"), (Json{{0.1, 0.0, -0.2, 0.004}, {0.0, 0.0, 1.0, 0.001}}));
  for (const std::size_t other : {0U, 2U, 3U}) EXPECT_FALSE(parts[other].contains("gaps"));
}

TEST(Messages, APartHasTheNameOfWhatItIsOneOfSeveralPartsOf) {
  Stage stage;
  stage.info.looks = {{.part = PartId{1}, .of = "bin"}};
  const Json parts = Json::parse(scene_message(stage.info, stage.world)).at("parts");
  EXPECT_EQ(parts[1].at("of"), "bin");
  for (const std::size_t other : {0U, 2U, 3U}) EXPECT_FALSE(parts[other].contains("of"));
}

TEST(Messages, APartHasAColourAndAnOpacityWhereTheyAreGiven) {
  Stage stage;
  stage.info.looks = {{.part = PartId{1}, .color = {{0.2, 0.4, 1.0}}},
                      {.part = PartId{2}, .opacity = 0.25}};
  const Json parts = Json::parse(scene_message(stage.info, stage.world)).at("parts");
  EXPECT_EQ(parts[1].at("color"), (Json{0.2, 0.4, 1.0}));
  EXPECT_FALSE(parts[1].contains("opacity"));
  EXPECT_EQ(parts[2].at("opacity"), 0.25);
  for (const std::size_t other : {0U, 2U, 3U}) EXPECT_FALSE(parts[other].contains("color"));
}

TEST(Messages, AnArmHasWhatAHandCanSwitchAndHowItIs) {
  Stage stage;
  ArmInfo& arm = stage.info.arms.front();
  network::FixtureOptions cone;
  cone.name = "\"way\" in";
  cone.kind = network::FixtureKind::cone;
  cone.X_WF.translation() = Vec3(1, 2, 3);
  cone.is_on = false;
  network::FixtureOptions seam;
  seam.name = "seam";
  seam.kind = network::FixtureKind::path;
  seam.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
  arm.fixtures = {cone, seam};
  arm.relief = network::ReliefOptions{.compliant = {true}, .stiffness = 100.0};
  arm.has_scale = arm.has_handle = true;
  const Json told = Json::parse(scene_message(stage.info, stage.world)).at("arms")[0];
  EXPECT_EQ(told.at("fixtures")[0].at("name"), "\"way\" in");
  EXPECT_EQ(told.at("fixtures")[0].at("shape"), "cone");
  EXPECT_EQ(told.at("fixtures")[0].at("half_angle_rad"), 0.5);
  EXPECT_EQ(told.at("fixtures")[0].at("pose"), (Json{1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0}));
  const Json& course = told.at("fixtures")[1].at("course");
  EXPECT_GT(course.size(), 10U) << "a spline";
  EXPECT_EQ(course.front(), (Json{0.0, 0.0, 0.0}));
  EXPECT_EQ(course.back(), (Json{1.0, 1.0, 0.0}));
  EXPECT_EQ(told.at("compliant").size(), 6U);
  EXPECT_EQ(told.at("scale"), (Json{1e-3, 1e3}));
  EXPECT_FALSE(told.contains("hands"));

  TickRecord& record = stage.shot.arms.front();
  record.grip = {Vec3(1, 2, 3), Vec3(0.1, 0.2, 0.3)};
  const auto now = [&] {
    return Json::parse(frame_message(stage.info, stage.world, stage.shot, {}, true)).at("arms")[0];
  };
  Json as_set_up = now();
  EXPECT_EQ(as_set_up.at("guides"), Json{"seam"});
  EXPECT_EQ(as_set_up.at("compliant"), Json{"x"});
  EXPECT_EQ(as_set_up.at("compliant_frame"), "tool");
  EXPECT_EQ(as_set_up.at("grip_n"), (Json{1.0, 2.0, 3.0}));
  EXPECT_EQ(as_set_up.at("grip_nm"), (Json{0.1, 0.2, 0.3}));
  EXPECT_FALSE(as_set_up.contains("second_grip_n"));
  record.command.hand.guides = 1;
  record.command.hand.scale = 0.5;
  record.command.hand.compliant = network::Relief::world_bit | 0b100100;
  Json switched = now();
  EXPECT_EQ(switched.at("guides"), Json{"\"way\" in"});
  EXPECT_EQ(switched.at("scale"), 0.5);
  EXPECT_EQ(switched.at("compliant"), (Json{"z", "rz"}));
  EXPECT_EQ(switched.at("compliant_frame"), "world");
}

// The order of the pairs does not matter, nor what else the parts that meet it are in a pair with.
TEST(Messages, APartIsPassableIfAllThatMeetItMayEnter) {
  const ForceLaw wall{.range = 0.02};
  const ForceLaw membrane{.range = 0.01, .ceiling = 10.0, .passable = true};
  struct Case {
    std::vector<ForceLaw> laws;  ///< of the pairs with the part, in their order
    bool passable;
  };
  for (const Case& each :
       {Case{{membrane}, true}, Case{{membrane, membrane}, true}, Case{{wall, membrane}, false},
        Case{{membrane, wall}, false}, Case{{wall, wall}, false}, Case{{}, false}}) {
    World world;
    const BodyId tool = world.add_body("tool");
    const PartId part = world.add_part(World::fixed, "part", Shape::box({1, 1, 0.1}));
    const PartId other = world.add_part(World::fixed, "other", Shape::box({1, 1, 0.1}));
    double range = 0.0;
    for (const ForceLaw& law : each.laws) {
      const PartId finger = world.add_part(tool, "finger", Shape::sphere(0.01));
      world.add_pair(finger, part, law);
      world.add_pair(finger, other, law.passable ? wall : membrane);
      range = std::max(range, law.range);
    }
    SceneInfo info;
    info.arms.emplace_back().tool = tool;
    const Json parts = Json::parse(scene_message(info, world)).at("parts");
    EXPECT_EQ(parts[0].at("name"), "part");
    EXPECT_EQ(parts[0].at("passable"), each.passable);
    EXPECT_EQ(parts[0].at("range_m"), range);
  }
}

TEST(Messages, AFrameIsOfTheDocumentedForm) {
  Stage stage;
  TickRecord& record = stage.shot.arms.front();
  record.tick = 1234;
  record.time = 3.085;
  record.phase = 1;
  record.status = status::saturated | status::joint_limit;
  record.virtual_force.force = Vec3(1, 2, 3);
  record.q = {0.5, -0.25};
  stage.shot.pair_count = 1;
  stage.shot.pairs[0].pair = {2};
  stage.shot.pairs[0].force = 12.5;
  const TickSample samples[] = {{1233, 0.01, 2.0, {}, 0}, {1234, infinite, 0.0, {}, 0}};
  const Json frame =
      Json::parse(frame_message(stage.info, stage.world, stage.shot, samples, false));
  EXPECT_EQ(keys_of(frame), (std::set<std::string>{"type", "tick", "time_s", "running", "phase",
                                                   "status", "bodies", "pairs", "pairs_omitted",
                                                   "near", "evaluated", "of", "arms", "recent"}));
  EXPECT_EQ(frame.at("tick"), 1234);
  EXPECT_EQ(frame.at("running"), false);
  EXPECT_EQ(frame.at("phase"), "stage");
  EXPECT_EQ(frame.at("status"), (Json{"saturated", "joint_limit"}));
  EXPECT_EQ(frame.at("bodies").size(), 3U);
  EXPECT_EQ(frame.at("of"), 3);
  ASSERT_EQ(frame.at("pairs").size(), 1U);
  EXPECT_EQ(keys_of(frame.at("pairs")[0]),
            (std::set<std::string>{"i", "d", "lower", "upper", "a", "b", "n", "level", "f", "stale",
                                   "age"}));
  EXPECT_EQ(frame.at("pairs")[0].at("i"), 2);
  EXPECT_EQ(frame.at("pairs")[0].at("f"), 12.5);
  ASSERT_EQ(frame.at("arms").size(), 1U);
  const Json& arm = frame.at("arms")[0];
  EXPECT_EQ(keys_of(arm), (std::set<std::string>{"force", "torque", "coupling", "lever_nm", "gain",
                                                 "v", "q", "energy_j", "signals"}));
  EXPECT_EQ(arm.at("force"), (Json{1.0, 2.0, 3.0}));
  EXPECT_EQ(arm.at("q"), (Json{0.5, -0.25}));
  EXPECT_EQ(arm.at("energy_j").size(), 2U);
  EXPECT_EQ(frame.at("recent").at("tick"), (Json{1233, 1234}));
  EXPECT_EQ(frame.at("recent").at("nearest_m"), (Json{0.01, nullptr}));
  EXPECT_EQ(
      keys_of(frame.at("recent")),
      (std::set<std::string>{"tick", "nearest_m", "force_n", "compute_us", "late_us", "status"}));
}

/// Turns about z by its first joint, then slides along its own x.
struct Crane final : ArmKinematics {
  void update(std::span<const double> q) noexcept override {
    ASSERT_EQ(q.size(), 2U);
    turned = Pose(Eigen::AngleAxisd(q[0], Vec3::UnitZ()));
    reach = q[1];
  }
  [[nodiscard]] Pose X_WL(int link) const noexcept override {
    return link == 0 ? turned : turned * Pose(Eigen::Translation3d(reach, 0.0, 0.0));
  }
  [[nodiscard]] Pose X_WT() const noexcept override { return X_WL(1); }
  void tool_jacobian(JacobianRef J) const noexcept override { J.setZero(); }
  void gravity_torques(std::span<double> out) noexcept override { out[0] = out[1] = 0.0; }
  Pose turned = Pose::Identity();
  double reach = 0.0;
};

/// What a link of an arm looks like.
VisualInfo looks(int arm, int link) {
  return {.name = "cover",
          .arm = arm,
          .mesh = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}},
          .link = link};
}

/// A second arm, of which both links have looks and no body, the outer one twice.
void add_crane(Stage& stage) {
  ArmInfo& crane = stage.info.arms.emplace_back(stage.info.arms.front());
  crane.kinematics = std::make_shared<Crane>();
  stage.shot.arms.resize(2);
  stage.info.visuals = {looks(1, 1), looks(1, 0), looks(1, 1)};
}

TEST(Messages, LooksOfALinkWithoutABodyMoveWithThatLink) {
  Stage stage;
  add_crane(stage);
  stage.info.visuals.push_back({.name = "foot", .body = World::fixed, .arm = 1});
  const Json scene = Json::parse(scene_message(stage.info, stage.world));
  EXPECT_FALSE(scene.at("arms")[0].contains("links"));
  EXPECT_EQ(scene.at("arms")[1].at("links"), (Json{0, 1}));
  EXPECT_EQ(scene.at("visuals")[0].at("link"), 1);
  EXPECT_EQ(scene.at("visuals")[0].at("arm"), 1);
  EXPECT_FALSE(scene.at("visuals")[0].contains("body"));
  EXPECT_EQ(scene.at("visuals")[3].at("body"), 0);
  EXPECT_FALSE(scene.at("visuals")[3].contains("link"));
  const std::array<double, 2> q{0.7, -1.3};
  std::copy(q.begin(), q.end(), stage.shot.arms[1].q.begin());
  const Json arms =
      Json::parse(frame_message(stage.info, stage.world, stage.shot, {}, true)).at("arms");
  EXPECT_FALSE(arms[0].contains("links"));
  ASSERT_EQ(arms[1].at("links").size(), 2U);
  Crane crane;
  crane.update(q);
  for (int link = 0; link < 2; ++link) {
    const Pose X = crane.X_WL(link);
    const Eigen::Quaterniond turn(X.linear());
    const double is[] = {X.translation().x(),
                         X.translation().y(),
                         X.translation().z(),
                         turn.x(),
                         turn.y(),
                         turn.z(),
                         turn.w()};
    const Json& told = arms[1].at("links")[static_cast<std::size_t>(link)];
    ASSERT_EQ(told.size(), std::size(is));
    for (std::size_t i = 0; i < std::size(is); ++i) {
      EXPECT_NEAR(told[i].get<double>(), is[i], 1e-6) << link << ' ' << i;
    }
  }
  stage.shot.arms[1].q.fill(nan);
  const Json lost = Json::parse(frame_message(stage.info, stage.world, stage.shot, {}, true));
  EXPECT_TRUE(lost.at("arms")[1].at("links")[1][0].is_null());
}

TEST(Messages, LooksThatNobodyCanPlaceAreRefused) {
  const VisualInfo wrong[] = {looks(1, 2), looks(0, 0), looks(2, 0), looks(-1, 0)};
  for (const VisualInfo& each : wrong) {
    Stage stage;
    add_crane(stage);
    EXPECT_NO_THROW((void)scene_message(stage.info, stage.world));
    stage.info.visuals.push_back(each);
    try {
      (void)scene_message(stage.info, stage.world);
      ADD_FAILURE() << "link " << each.link << " of arm " << each.arm;
    } catch (const SetupError& error) {
      EXPECT_NE(std::string(error.what()).find("'cover'"), std::string::npos) << error.what();
    }
  }
}

// A page that cannot parse a message would fail when it is needed most.
TEST(Messages, AFrameNamesTheBodiesThatAreNotThere) {
  Stage stage;
  const auto frame = [&] {
    return Json::parse(frame_message(stage.info, stage.world, stage.shot, {}, true));
  };
  stage.shot.is_there = {1, 1, 1};
  EXPECT_FALSE(frame().contains("absent"));
  stage.shot.is_there = {1, 0, 0};
  EXPECT_EQ(frame().at("absent"), (Json{1, 2}));
}

TEST(Messages, WhatIsNoNumberIsNull) {
  Stage stage;
  TickRecord& record = stage.shot.arms.front();
  for (const double bad : {nan, infinite, -infinite}) {
    const Vec3 all = Vec3::Constant(bad);
    record.time = record.lever_torque = record.gain = bad;
    record.virtual_force = record.coupling = {all, all};
    record.v_WT = all;
    record.q.fill(bad);
    record.energy.fill(static_cast<float>(bad));
    stage.shot.X_WB[1].matrix().fill(bad);
    stage.shot.pair_count = 1;
    NearPair& near = stage.shot.pairs[0];
    near.pair = {0};
    near.force = bad;
    Separation& s = near.separation;
    s.distance = s.lower = s.upper = bad;
    s.p_WA = s.p_WB = s.extraction_W = all;
    const TickSample sample{7, bad, bad, {}, 0};
    const Json frame =
        Json::parse(frame_message(stage.info, stage.world, stage.shot, {&sample, 1}, true));
    EXPECT_TRUE(frame.at("time_s").is_null());
    EXPECT_TRUE(frame.at("bodies")[1][0].is_null());
    for (const char* key : {"d", "lower", "upper", "f"}) {
      EXPECT_TRUE(frame.at("pairs")[0].at(key).is_null()) << key;
    }
    for (const char* key : {"force", "torque", "coupling", "v", "q", "energy_j"}) {
      EXPECT_TRUE(frame.at("arms")[0].at(key)[0].is_null()) << key;
    }
    EXPECT_TRUE(frame.at("recent").at("nearest_m")[0].is_null());
    EXPECT_TRUE(frame.at("recent").at("force_n")[0].is_null());
  }
}

TEST(Messages, AnyNameGivesTextThatCanBeRead) {
  const struct {
    std::string name;
    bool is_text;
  } names[] = {{"\"quoted\"", true},
               {"a\nb\r\t\\", true},
               {"</script><script>alert(1)</script>", true},
               {"\xf0\x9f\xa6\xbe", true},
               {std::string("a\0b", 3), true},
               {"", true},
               {"\xff\xfe", false},
               {"\xc3", false},
               {"\xed\xa0\x80", false}};
  for (const auto& [name, is_text] : names) {
    const Stage stage(name);
    const Json scene = Json::parse(scene_message(stage.info, stage.world));
    EXPECT_TRUE(scene.at("name").is_string());
    Stage shown(name);
    shown.shot.arms.front().phase = 1;
    const Json frame = Json::parse(frame_message(shown.info, shown.world, shown.shot, {}, true));
    EXPECT_TRUE(frame.at("phase").is_string());
    if (!is_text) continue;
    EXPECT_EQ(scene.at("name"), name);
    EXPECT_EQ(scene.at("parts")[0].at("name"), name + " palm");
    EXPECT_EQ(frame.at("phase"), name);
  }
}

TEST(Messages, APhaseBeyondTheScriptHasNoName) {
  Stage stage;
  for (const std::int32_t phase : {-1, 2, std::numeric_limits<std::int32_t>::max()}) {
    stage.shot.arms.front().phase = phase;
    const Json frame = Json::parse(frame_message(stage.info, stage.world, stage.shot, {}, true));
    EXPECT_EQ(frame.at("phase"), "");
  }
}

TEST(Messages, AScriptIsOverWhenThatOfEachArmHasEnded) {
  Stage stage;
  stage.info.arms.emplace_back(stage.info.arms.front()).phases = {"up", "", ""};
  stage.shot.arms.resize(2);
  const auto is_over = [&](std::int32_t first, std::int32_t second) {
    stage.shot.arms[0].phase = first;
    stage.shot.arms[1].phase = second;
    const Json frame = Json::parse(frame_message(stage.info, stage.world, stage.shot, {}, true));
    return frame.contains("script_over") && frame.at("script_over") == true;
  };
  EXPECT_FALSE(is_over(0, 0));
  EXPECT_FALSE(is_over(2, 2)) << "a phase without a name";
  EXPECT_FALSE(is_over(1, 3));
  EXPECT_TRUE(is_over(2, 3));
  EXPECT_FALSE(is_over(0, 3)) << "again";
  stage.info.arms[0].phases.clear();
  EXPECT_FALSE(is_over(0, 2)) << "the other arm has a script";
  EXPECT_TRUE(is_over(0, 3));
  stage.info.arms[1].phases.clear();
  EXPECT_FALSE(is_over(0, 0)) << "there is none";
  EXPECT_FALSE(Json::parse(scene_message(stage.info, stage.world)).contains("scripted"));
}

TEST(Messages, TimingCountsEveryTickInOneBin) {
  using namespace std::chrono_literals;
  Timing timing;
  const std::chrono::nanoseconds times[] = {-5us, 0ns, 50ns, 100ns, 1us, 99us, 1ms, 100ms, 24h};
  for (const auto late : times) {
    for (const auto compute : times) timing.add({late, compute}, 2500us);
  }
  const Json message = Json::parse(timing_message(timing));
  EXPECT_EQ(message.at("edges_us").size(), message.at("compute").size() + 1);
  EXPECT_EQ(message.at("edges_us").size(), message.at("late").size() + 1);
  for (const char* what : {"compute", "late"}) {
    std::int64_t sum = 0;
    for (const Json& count : message.at(what)) sum += count.get<std::int64_t>();
    EXPECT_EQ(sum, 81) << what;
  }
  EXPECT_EQ(message.at("ticks"), 81);
  // Those with 100 ms or a day as either time; 7 of the 9 values are shorter.
  EXPECT_EQ(message.at("misses"), 81 - 49);
  for (const char* key : {"p50", "p99", "max"}) {
    EXPECT_TRUE(message.at("compute_us").at(key).is_number());
    EXPECT_TRUE(message.at("late_us").at(key).is_number());
  }
}

TEST(Messages, TimingOfNothingCanBeRead) {
  const Json message = Json::parse(timing_message(Timing()));
  EXPECT_EQ(message.at("ticks"), 0);
}

}  // namespace messages_test
}  // namespace repel::visual
