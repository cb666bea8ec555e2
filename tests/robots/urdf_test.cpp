// SPDX-License-Identifier: BSD-3-Clause
// What the loader reads, and above all what it refuses: nothing of a file may be ignored silently.
#include <gtest/gtest.h>

#include <algorithm>
#include <clocale>
#include <limits>
#include <locale>

#include <repel/base/setup_error.hpp>

#include "arms.hpp"

namespace repel {
namespace urdf_test {

constexpr const char* sphere =
    R"(<collision><geometry><sphere radius="0.1"/></geometry></collision>)";
constexpr const char* inertial =
    R"(<inertial><origin xyz="0.5 0 0"/><mass value="2"/>
       <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.2" iyz="0" izz="0.25"/></inertial>)";
constexpr const char* limit = R"(<limit lower="-1" upper="2" velocity="3" effort="4"/>)";

std::string link(const std::string& name, const std::string& content) {
  return "<link name='" + name + "'>" + content + "</link>\n";
}

std::string joint(const std::string& type, const std::string& parent, const std::string& child,
                  const std::string& content) {
  return "<joint name='" + parent + "_" + child + "' type='" + type + "'><parent link='" + parent +
         "'/><child link='" + child + "'/>" + content + "</joint>\n";
}

std::string robot(const std::string& content) {
  return "<robot name='test'>\n" + content + "</robot>\n";
}

/// A base on line 2 and one moving link on line 3, carried by a joint on line 4.
std::string one_joint(const std::string& link_content, const std::string& joint_content = limit,
                      const std::string& type = "revolute") {
  return robot(link("base", sphere) + link("arm", link_content) +
               joint(type, "base", "arm", "<axis xyz='0 0 2'/>" + joint_content));
}

std::string with_shape(const std::string& shape) {
  return one_joint(std::string(R"(<inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" )") +
                   R"(iyy="1" iyz="0" izz="1"/></inertial>)" + sphere + "\n<collision><geometry>" +
                   shape + "</geometry></collision>");
}

/// Expects an error message that contains all of `words` and gives `line`.
void expect_refused(const std::string& urdf, int line, const std::vector<std::string>& words,
                    const UrdfOptions& options = {}) {
  try {
    (void)parse_arm(urdf, options, "test.urdf");
    FAIL() << "accepted:\n" << urdf;
  } catch (const SetupError& error) {
    EXPECT_EQ(error.file(), "test.urdf");
    EXPECT_EQ(error.line(), line) << error.what();
    for (const std::string& word : words) {
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
  }
}

TEST(Urdf, ReadsJointAndLinkNumbers) {
  const auto text = one_joint(std::string(inertial) + sphere,
                              std::string(limit) + "<origin xyz='0 0 1' rpy='0 0 0.5'/>" +
                                  "<dynamics damping='0.5' friction='0.25'/>");
  const Robot read = parse_arm(text);
  ASSERT_EQ(read.arm.links.size(), 1u);
  const ArmLink& arm = read.arm.links[0];
  EXPECT_EQ(arm.name, "arm");
  EXPECT_EQ(arm.joint_name, "base_arm");
  EXPECT_EQ(arm.axis_J, Vec3::UnitZ());
  EXPECT_EQ(arm.X_PJ.translation(), Vec3(0, 0, 1));
  EXPECT_NEAR(Eigen::AngleAxisd(arm.X_PJ.linear()).angle(), 0.5, 1e-15);
  EXPECT_EQ(arm.p_LC, Vec3(0.5, 0, 0));
  EXPECT_EQ(arm.I_C_L, Mat3(Vec3(0.1, 0.2, 0.25).asDiagonal()));
  EXPECT_EQ(arm.lower, -1.0);
  EXPECT_EQ(arm.upper, 2.0);
  EXPECT_EQ(arm.velocity_limit, 3.0);
  EXPECT_EQ(arm.effort_limit, 4.0);
  EXPECT_EQ(arm.viscous_friction, 0.5);
  EXPECT_EQ(arm.coulomb_friction, 0.25);
}

TEST(Urdf, ReadsEveryKindOfPartWithHalfSizes) {
  const auto size = [](const std::string& shape) { return parse_arm(with_shape(shape)).parts[2]; };
  EXPECT_EQ(size("<box size='2 4 6'/>").size, Vec3(1, 2, 3));
  EXPECT_EQ(size("<sphere radius='2'/>").size, Vec3(2, 0, 0));
  EXPECT_EQ(size("<cylinder radius='2' length='6'/>").size, Vec3(2, 3, 0));
  EXPECT_EQ(size("<cylinder radius='2' length='6'/>").kind, PartKind::cylinder);
  EXPECT_EQ(size("<capsule radius='2' length='6'/>").size, Vec3(2, 3, 0));
  EXPECT_EQ(size("<capsule radius='2' length='6'/>").kind, PartKind::capsule);
  EXPECT_EQ(size("<box size='2 4 6'/>").name, "arm_1");
  EXPECT_EQ(size("<box size='2 4 6'/>").link, 0);
}

TEST(Urdf, RefusesAShapeThatUrdfdomWouldDrop) {
  expect_refused(with_shape("<cone radius='1' length='1'/>"), 4, {"link 'arm'", "<cone>", "box"});
  expect_refused(with_shape(""), 4, {"link 'arm'", "no shape"});
  expect_refused(with_shape("<sphere radius='1'/><sphere radius='2'/>"), 4,
                 {"link 'arm'", "more than one"});
}

TEST(Urdf, RefusesNumbersThatAreMissingMalformedNotFiniteOrOutOfRange) {
  expect_refused(with_shape("<box size='1 2'/>"), 4, {"link 'arm'", "size", "'1 2'", "3 numbers"});
  expect_refused(with_shape("<box size='1 2 x'/>"), 4, {"link 'arm'", "size", "'1 2 x'"});
  expect_refused(with_shape("<box size='1 2 nan'/>"), 4, {"link 'arm'", "size", "nan"});
  expect_refused(with_shape("<box size='1 2 1e999'/>"), 4, {"link 'arm'", "size", "1e999"});
  expect_refused(with_shape("<sphere radius='-1'/>"), 4, {"radius", "'-1'", "1e-06 to 10000 m"});
  expect_refused(with_shape("<sphere radius='1,5'/>"), 4, {"radius", "'1,5'"});
  expect_refused(with_shape("<sphere radius='inf'/>"), 4, {"radius", "'inf'"});
  expect_refused(with_shape("<cylinder radius='1'/>"), 4, {"length", "missing"});
  expect_refused(with_shape("<capsule radius='1' length='-2'/>"), 4, {"length", "'-2'"});
  expect_refused(one_joint(inertial, "<limit lower='0' upper='1' velocity='nan' effort='1'/>"), 5,
                 {"joint 'base_arm'", "velocity", "nan"});
}

TEST(Urdf, RefusesJointsASerialArmCannotHave) {
  expect_refused(one_joint(inertial, ""), 5, {"joint 'base_arm'", "<limit> is missing"});
  expect_refused(one_joint(inertial, "<limit lower='1' upper='1' velocity='1' effort='1'/>"), 5,
                 {"joint 'base_arm'", "lower below upper"});
  expect_refused(one_joint(inertial, "<limit velocity='1' effort='1'/>"), 5, {"lower below upper"});
  expect_refused(one_joint(inertial, limit, "spherical"), 5, {"'spherical'", "revolute"});
  const std::string planar_between =
      robot(link("base", "") + link("a", inertial) + link("b", inertial) + link("c", inertial) +
            joint("revolute", "base", "a", limit) + joint("planar", "a", "b", "") +
            joint("revolute", "b", "c", limit));
  expect_refused(planar_between, 10, {"joint 'a_b'", "'planar'", "revolute", "hold"});
  EXPECT_EQ(parse_arm(planar_between, {.hold = {"a_b"}}).arm.links.size(), 2U);
  expect_refused(one_joint(inertial, std::string(limit) + "<mimic joint='other'/>"), 5,
                 {"joint 'base_arm'", "mimics 'other'"});
}

TEST(Urdf, RefusesAnInertiaNoBodyHas) {
  expect_refused(one_joint("<inertial><mass value='1'/><inertia ixx='1' ixy='2' ixz='0' iyy='1' "
                           "iyz='0' izz='1'/></inertial>"),
                 3, {"link 'arm'", "principal moment of -0.99"});
}

// Manufacturers omit them; only a simulation needs them, and reports that itself.
TEST(Urdf, AMovingLinkMayBeWithoutInertia) {
  const Robot light = parse_arm(one_joint(sphere));
  EXPECT_EQ(light.arm.links[0].mass, 0.0);
  EXPECT_EQ(light.links[1].mass, 0.0);
}

// Regression: it was dropped if the mass is zero.
TEST(Urdf, InertiaCountsWithoutMass) {
  const Robot read = parse_arm(one_joint(
      "<inertial><origin xyz='1 0 0'/><mass value='0'/><inertia ixx='1' ixy='0' ixz='0' iyy='2' "
      "iyz='0' izz='2'/></inertial>"));
  EXPECT_EQ(read.arm.links[0].mass, 0.0);
  EXPECT_EQ(read.arm.links[0].I_C_L, Mat3(Vec3(1, 2, 2).asDiagonal()));
}

TEST(Urdf, RefusesTextThatIsNoRobot) {
  expect_refused("<robot name='a'>\n<link></robot>", 2, {"XML"});
  expect_refused("<sdf/>", 1, {"<robot>"});
  expect_refused(robot(link("base", sphere)), 2, {"no moving joint"});
  expect_refused(robot(link("a", "") + link("a", "")), 3, {"second link 'a'"});
  expect_refused(robot("<xacro:arm/>"), 2, {"xacro:arm", "plain URDF"});
  EXPECT_THROW((void)load_arm("there/is/no.urdf"), SetupError);
}

// urdfdom reports these on stderr only, or not at all.
TEST(Urdf, RefusesLinksThatAreNoTree) {
  const std::string base_and_arm = link("base", "") + link("arm", inertial);
  expect_refused(robot(base_and_arm + joint("revolute", "base", "hand", limit)), 5,
                 {"joint 'base_hand'", "link 'hand'", "not in the file"});
  expect_refused(robot(base_and_arm), 2, {"'arm'", "'base'", "one root"});
  expect_refused(robot(base_and_arm + link("c", "") + joint("fixed", "base", "arm", "") +
                       joint("fixed", "c", "arm", "")),
                 7, {"link 'arm'", "two joints"});
  expect_refused(robot(base_and_arm + link("c", "") + joint("fixed", "c", "arm", "") +
                       joint("fixed", "arm", "c", "")),
                 3, {"link 'arm'", "loop"});
}

TEST(Urdf, OneOfTwoMovingBranchesMustBeChosen) {
  const std::string two =
      robot(link("base", sphere) + link("left", inertial) + link("right", inertial) +
            joint("revolute", "base", "left", limit) + joint("prismatic", "base", "right", limit));
  expect_refused(two, 2, {"link 'base'", "2 branches of 1 moving", "--tip", "'left', 'right'"});
  expect_refused(two, 2, {"'middle'"}, {.tip = "middle"});
  for (const UrdfOptions& options :
       {UrdfOptions{.tip = "left"}, UrdfOptions{.hold = {"base_right"}}}) {
    const Robot held = parse_arm(two, options);
    ASSERT_EQ(held.arm.links.size(), 1u);
    EXPECT_EQ(held.arm.links[0].name, "left");
    ASSERT_EQ(held.held.size(), 1u);
    EXPECT_EQ(held.held[0].name, "base_right");
  }
}

TEST(Urdf, FixedJointsMergeMassCentreInertiaPartsAndTool) {
  const std::string at = "<origin xyz='0 0 1' rpy='0 0 1.5707963267948966'/>";
  const Robot merged = parse_arm(robot(
      link("base", sphere) + link("arm", inertial) + link("hand", std::string(inertial) + sphere) +
      joint("revolute", "base", "arm", limit) + joint("fixed", "arm", "hand", at)));
  ASSERT_EQ(merged.arm.links.size(), 1u);
  const ArmLink& arm = merged.arm.links[0];
  EXPECT_EQ(arm.mass, 4.0);
  EXPECT_LT((arm.p_LC - Vec3(0.25, 0.25, 0.5)).norm(), 1e-15);
  // Two equal masses of 2 kg, 0.5 m x 0.5 m x 1 m apart; the second turned by 90 degrees.
  Mat3 expected = Vec3(0.3, 0.3, 0.5).asDiagonal();
  const Vec3 half(0.25, -0.25, -0.5);
  expected += 4.0 * (half.squaredNorm() * Mat3::Identity() - half * half.transpose());
  EXPECT_LT((arm.I_C_L - expected).norm(), 1e-14);
  EXPECT_EQ(merged.arm.X_LT.translation(), Vec3(0, 0, 1));
  EXPECT_EQ(merged.parts.back().link, 0);
  EXPECT_EQ(merged.parts.back().X_LP.translation(), Vec3(0, 0, 1));
}

TEST(Urdf, TipsAreTheMovingEndsAndTheOnlyOneIsTheTool) {
  const std::string at = "<origin xyz='0 0 1'/>";
  const std::string links = link("camera", "") + link("base", sphere) + link("arm", inertial) +
                            link("flange", "") + link("tool", "");
  const std::string joints = joint("fixed", "arm", "flange", at) +
                             joint("fixed", "base", "camera", at) +
                             joint("revolute", "base", "arm", limit);
  const Robot one = parse_arm(robot(links + joints + joint("fixed", "flange", "tool", at)));
  EXPECT_EQ(one.tips, std::vector<std::string>{"tool"});
  EXPECT_EQ(one.arm.X_LT.translation(), Vec3(0, 0, 2));
  EXPECT_EQ(one.links.size(), 5U);
  const std::string two = robot(links + joints + joint("fixed", "arm", "tool", at));
  EXPECT_EQ(parse_arm(two).tips, (std::vector<std::string>{"flange", "tool"}));
  EXPECT_EQ(parse_arm(two).tool, "tool") << "by its name";
  EXPECT_EQ(parse_arm(two, {.tip = "flange"}).tool, "flange");
  const std::string three =
      robot(links + link("tcp", "") + joints + joint("fixed", "arm", "tool", at) +
            joint("fixed", "arm", "tcp", at));
  EXPECT_EQ(parse_arm(three).tool, "arm") << "neither is the only one";
  EXPECT_EQ(parse_arm(three).arm.X_LT.translation(), Vec3(0, 0, 0));
  EXPECT_EQ(parse_arm(three, {.tip = "tool"}).arm.X_LT.translation(), Vec3(0, 0, 1));
}

TEST(Urdf, ContinuousJointsHaveNoEnd) {
  const Robot wheel =
      parse_arm(one_joint(inertial, "<limit velocity='1' effort='1'/>", "continuous"));
  EXPECT_EQ(wheel.arm.links[0].lower, -std::numeric_limits<double>::infinity());
  EXPECT_EQ(wheel.arm.links[0].upper, std::numeric_limits<double>::infinity());
  EXPECT_EQ(wheel.arm.links[0].effort_limit, 1.0);
  const Robot free = parse_arm(one_joint(inertial, "", "continuous"));
  EXPECT_EQ(free.arm.links[0].effort_limit, std::numeric_limits<double>::infinity());
  EXPECT_EQ(free.arm.links[0].velocity_limit, std::numeric_limits<double>::infinity());
}

/// Writes 1.5 as 1,5.
class CommaDecimals : public std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

bool same_numbers(const Robot& a, const Robot& b) {
  return std::equal(a.arm.links.begin(), a.arm.links.end(), b.arm.links.begin(),
                    [](const ArmLink& l, const ArmLink& r) {
                      return l.X_PJ.matrix() == r.X_PJ.matrix() && l.I_C_L == r.I_C_L &&
                             l.p_LC == r.p_LC && l.upper == r.upper &&
                             l.rotor_inertia == r.rotor_inertia;
                    }) &&
         std::equal(a.parts.begin(), a.parts.end(), b.parts.begin(),
                    [](const RobotPart& l, const RobotPart& r) { return l.size == r.size; });
}

TEST(Urdf, NumbersDoNotDependOnTheCppLocale) {
  const Robot before = load_arm(test::puma_files[0]);
  const std::locale old = std::locale::global(std::locale(std::locale(), new CommaDecimals));
  const Robot after = load_arm(test::puma_files[0]);
  std::locale::global(old);
  EXPECT_TRUE(same_numbers(before, after));
}

TEST(Urdf, NumbersDoNotDependOnTheCLocale) {
  const Robot before = load_arm(test::puma_files[0]);
  const char* found = nullptr;
  for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "de_DE", "fr_FR.UTF-8"}) {
    if (!found) found = std::setlocale(LC_NUMERIC, name);
  }
  if (!found) GTEST_SKIP() << "no locale with a decimal comma is installed";
  const Robot after = load_arm(test::puma_files[0]);
  std::setlocale(LC_NUMERIC, "C");
  EXPECT_TRUE(same_numbers(before, after));
}

}  // namespace urdf_test
}  // namespace repel
