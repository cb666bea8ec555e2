// SPDX-License-Identifier: BSD-3-Clause
// Robot descriptions that stand still.
#include <gtest/gtest.h>

#include <numbers>

#include <repel/base/setup_error.hpp>
#include <repel/robots/urdf.hpp>

#include "end_to_end/folder.hpp"

namespace repel {
namespace static_parts_test {

std::string joint(const std::string& name, const std::string& type, const std::string& parent,
                  const std::string& child, const std::string& more) {
  return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent +
         "'/><child link='" + child + "'/>" + more + "</joint>\n";
}

/// A table with a lamp on a fixed joint and a door that could turn.
std::string table() {
  const std::string box =
      "<collision><origin xyz='0 0 1'/><geometry><box size='2 4 6'/></geometry>"
      "</collision>";
  const std::string ball =
      "<collision name='bulb'><geometry><sphere radius='0.5'/></geometry>"
      "</collision>";
  return "<robot name='table'><link name='top'>" + box + "</link><link name='lamp'>" + ball +
         "</link><link name='door'>" + box + ball + "</link>\n" +
         joint("screw", "fixed", "top", "lamp",
               "<origin xyz='3 0 0' rpy='0 0 1.5707963267948966'/>") +
         joint("hinge", "revolute", "lamp", "door",
               "<origin xyz='1 0 0'/><axis xyz='0 0 1'/>"
               "<limit lower='0.5' upper='1' velocity='1' effort='1'/>") +
         "</robot>";
}

TEST(StaticParts, AreThoseOfAllLinksWithEveryJointAtZero) {
  const test::Folder folder;
  const std::vector<RobotPart> parts = load_parts(folder.with("table.urdf", table()));
  ASSERT_EQ(parts.size(), 4U);
  const char* const names[] = {"top_0", "bulb", "door_0", "bulb"};
  const char* const links[] = {"top", "lamp", "door", "door"};
  const Vec3 positions[] = {{0, 0, 1}, {3, 0, 0}, {3, 1, 1}, {3, 1, 0}};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(parts[i].name, names[i]);
    EXPECT_EQ(parts[i].in_link, links[i]);
    EXPECT_EQ(parts[i].link, -1);
    EXPECT_LT((parts[i].X_LP.translation() - positions[i]).norm(), 1e-12) << i;
  }
  EXPECT_LT((parts[2].X_LP.linear().col(0) - Vec3(0, 1, 0)).norm(), 1e-12) << "turned by the lamp";
}

TEST(StaticParts, NeedNoMovingJoint) {
  const test::Folder folder;
  const std::string urdf = folder.with(
      "box.urdf",
      "<robot name='b'><link name='base'><collision><geometry><box size='1 1 1'/></geometry>"
      "</collision></link></robot>");
  EXPECT_EQ(load_parts(urdf).size(), 1U);
  EXPECT_THROW((void)load_arm(urdf), SetupError);
}

TEST(StaticParts, ThatCannotBeTakenWholeAreRefused) {
  const test::Folder folder;
  EXPECT_THROW((void)load_parts(folder / "absent.urdf"), SetupError);
  std::string text = table();
  text.replace(text.find("<sphere"), 7, "<cone");
  EXPECT_THROW((void)load_parts(folder.with("cone.urdf", text)), SetupError);
}

}  // namespace static_parts_test
}  // namespace repel
