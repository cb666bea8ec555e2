// The program that prints the contents of a robot description, as run by a user.
#include "program.hpp"

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

TEST(RobotInfo, UsageErrorsEndWithTwo) {
  EXPECT_EQ(robot_info("").status, 2);
  EXPECT_EQ(robot_info("a.urdf --frobnicate").status, 2);
  EXPECT_EQ(robot_info("--help").status, 0);
}

}  // namespace robot_info_test
}  // namespace repel::test
