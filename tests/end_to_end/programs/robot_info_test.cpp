// SPDX-License-Identifier: BSD-3-Clause
// The program that prints the contents of a robot description, as run by a user.
#include "end_to_end/hook.hpp"
#include "end_to_end/program.hpp"

namespace repel::test {
namespace robot_info_test {

using nlohmann::json;

Ending robot_info(const std::string& arguments) {
  return run_program(REPEL_ROBOT_INFO, arguments);
}

TEST(RobotInfo, OfThePumaSaysWhatTheFileHolds) {
  const Folder folder;
  const Ending ending =
      robot_info(quoted(REPEL_SOURCE "/robots/puma560.urdf") + " --json " + quoted(folder / "i"));
  ASSERT_EQ(ending.status, 0) << ending;
  EXPECT_TRUE(ending.says("6 degrees of freedom")) << ending;
  const json info = json::parse(text_of(folder / "i"));
  EXPECT_EQ(info.at("dof"), 6);
  ASSERT_EQ(info.at("joints").size(), 6U);
  EXPECT_EQ(info.at("joints")[0].at("type"), "revolute");
  EXPECT_NEAR(info.at("joints")[0].at("lower"), -160.0 * 3.14159265358979 / 180.0, 1e-9);
  const std::string file = text_of(REPEL_SOURCE "/robots/puma560.urdf");
  std::size_t in_file = 0;
  for (auto at = file.find("<collision"); at != std::string::npos;
       at = file.find("<collision", at + 1)) {
    ++in_file;
  }
  std::size_t parts = 0;
  for (const json& link : info.at("links")) parts += link.at("parts").size();
  EXPECT_GT(parts, 5U);
  EXPECT_EQ(parts, in_file);
  // Standard Denavit-Hartenberg at zero: a2 + a3 outward, d3 sideways, base and d4 + d6 upward.
  ASSERT_EQ(info.at("tips").size(), 1U);
  const json& tip = info.at("tips")[0];
  EXPECT_NEAR(tip.at("position")[0], 0.4318 + 0.0203, 1e-9) << tip;
  EXPECT_NEAR(tip.at("position")[1], -0.15005, 1e-9) << tip;
  EXPECT_EQ(tip.at("rotation").size(), 9U);
}

TEST(RobotInfo, OfAnMjcfFileSaysWhereItsFingersAreHeld) {
  const Folder folder;
  const std::string hand = folder.with("hand.xml", R"(<mujoco model="hand"><worldbody>
    <body name="arm"><joint name="turn"/><geom size="0.1"/><body name="wrist"><joint name="bend"/>
    <geom size="0.1"/><body name="a"><joint name="open" type="slide"/><geom size="0.1"/></body>
    <body name="b"><joint name="follow" type="slide"/><geom size="0.1"/></body></body></body>
    </worldbody><equality><joint joint1="open" joint2="follow"/></equality></mujoco>)");
  const Ending ending = robot_info("--mjcf " + quoted(hand) + " --hold open=20mm");
  if (ending.says("built without MuJoCo")) GTEST_SKIP() << "built without MuJoCo";
  ASSERT_EQ(ending.status, 0) << ending;
  EXPECT_TRUE(ending.says("hand: 2 degrees of freedom, 5 links, 4 collision parts")) << ending;
  EXPECT_TRUE(ending.says("20 mm   as chosen")) << ending;
  EXPECT_TRUE(ending.says("tool wrist")) << ending;
}

TEST(RobotInfo, AFileThatCannotBeTakenWholeEndsWithOneAndTheReason) {
  const Folder folder;
  const std::string urdf = folder.with(
      "r.urdf",
      "<robot name='r'><link name='base'/>\n<link name='arm'><collision><geometry><cone "
      "radius='1'/></geometry></collision></link>\n<joint name='j' type='continuous'>"
      "<parent link='base'/><child link='arm'/></joint></robot>");
  const Ending ending = robot_info(quoted(urdf) + " --json " + quoted(folder / "i"));
  EXPECT_EQ(ending.status, 1);
  EXPECT_TRUE(ending.says("r.urdf:2: link 'arm'")) << ending;
  EXPECT_TRUE(ending.says("<cone>")) << ending;
}

/// An arm with one joint and a hand with two fingers, the second of which mimics the first.
std::string arm_with_hand() {
  const auto slide = [](const std::string& name, const std::string& child,
                        const std::string& mimic) {
    return "<link name='" + child + "'/><joint name='" + name +
           "' type='prismatic'><parent link='hand'/><child link='" + child +
           "'/><axis xyz='1 0 0'/><limit lower='0.01' upper='0.04' velocity='1' effort='1'/>" +
           mimic + "</joint>";
  };
  return "<robot><link name='base'/><link name='arm'/><link name='hand'/>"
         "<joint name='shoulder' type='continuous'><parent link='base'/><child link='arm'/></joint>"
         "<joint name='flange' type='fixed'><parent link='arm'/><child link='hand'/></joint>" +
         slide("finger_1", "left", "") + slide("finger_2", "right", "<mimic joint='finger_1'/>") +
         "</robot>";
}

TEST(RobotInfo, SaysWhatIsHeldWhereAndWhy) {
  const Folder folder;
  const std::string file = quoted(folder.with("pincher.urdf", arm_with_hand()));
  const Ending ending = robot_info(file + " --json " + quoted(folder / "i"));
  ASSERT_EQ(ending.status, 0) << ending;
  EXPECT_TRUE(ending.says("pincher: 1 degrees of freedom")) << ending;
  EXPECT_TRUE(ending.says("mimics finger_1")) << ending;
  EXPECT_TRUE(ending.says("chain to arm: the longest chain")) << ending;
  EXPECT_TRUE(ending.says("tool hand: ")) << ending;
  const json info = json::parse(text_of(folder / "i"));
  EXPECT_EQ(info.at("chain").at("end"), "arm");
  EXPECT_EQ(info.at("tool").at("link"), "hand");
  ASSERT_EQ(info.at("held_joints").size(), 2U);
  EXPECT_EQ(info.at("held_joints")[0].at("name"), "finger_1");
  EXPECT_EQ(info.at("held_joints")[0].at("position"), 0.01) << "its limit nearest to zero";
  EXPECT_EQ(info.at("held_joints")[1].at("unit"), "m");
}

TEST(RobotInfo, HoldsJointsWhereItIsTold) {
  const Folder folder;
  const std::string file = quoted(folder.with("r.urdf", arm_with_hand()));
  for (const char* value : {"finger_1=20mm", "'finger_1=20 mm,finger_2'", "finger_1=0.02"}) {
    const Ending ending = robot_info(file + " --hold " + value + " --json " + quoted(folder / "i"));
    ASSERT_EQ(ending.status, 0) << ending;
    for (const json& joint : json::parse(text_of(folder / "i")).at("held_joints")) {
      EXPECT_EQ(joint.at("position"), 0.02) << value << joint;
    }
  }
  const Ending turned = robot_info(file + " --hold finger_1=1deg");
  EXPECT_EQ(turned.status, 1);
  EXPECT_TRUE(turned.says("a length, since it slides")) << turned;
  EXPECT_EQ(robot_info(file + " --hold finger_1=0.05").status, 1);
  EXPECT_EQ(robot_info(file + " --hold finger_1=2kg").status, 2);
  EXPECT_EQ(robot_info(file + " --hold finger_1=").status, 2);
}

#ifdef REPEL_ROBOT_INFO_COVERS
TEST(RobotInfo, CountsThePartsOfACover) {
  const Folder folder;
  (void)folder.with("hook.stl.parts.yaml", hook_list());
  const Ending ending = robot_info(quoted(with_hook(folder)) + " --json " + quoted(folder / "i"));
  ASSERT_EQ(ending.status, 0) << ending;
  EXPECT_TRUE(ending.says("2 hulls of covers (16)")) << ending;
  EXPECT_TRUE(ending.says("convex parts from " + folder / "hook.stl.parts.yaml")) << ending;
  for (const json& link : json::parse(text_of(folder / "i")).at("links")) {
    if (link.at("name") != "link_6") continue;
    EXPECT_EQ(link.at("parts")[0].at("name"), "hook/1");
    EXPECT_EQ(link.at("parts")[1].at("of_cover"), true);
    EXPECT_EQ(link.at("parts")[2].at("of_cover"), false);
  }
}
#endif

TEST(RobotInfo, UsageErrorsEndWithTwo) {
  EXPECT_EQ(robot_info("").status, 2);
  EXPECT_EQ(robot_info("a.urdf --frobnicate").status, 2);
  EXPECT_EQ(robot_info("--help").status, 0);
}

}  // namespace robot_info_test
}  // namespace repel::test
