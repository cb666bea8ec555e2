// SPDX-License-Identifier: BSD-3-Clause
// The pairs of links for which a semantic description disables collisions.
#include <gtest/gtest.h>

#include <repel/base/setup_error.hpp>
#include <repel/robots/urdf.hpp>

#include "end_to_end/folder.hpp"

namespace repel {
namespace srdf_test {

const test::Folder& folder() {
  static const test::Folder one;
  return one;
}

std::vector<DisabledCollision> load(const std::string& content) {
  const Robot puma = load_arm("robots/puma560.urdf");
  return load_disabled_collisions(folder().with("r.srdf", content), puma);
}

TEST(Srdf, ReadsTheDisabledPairsInTheirOrder) {
  const auto pairs = load(
      "<robot name='puma560'>\n<group name='arm'/>\n"
      "<disable_collisions link1='link_1' link2='link_2' reason='Adjacent'/>\n"
      "<disable_collisions link1='link_4' link2='link_2'/></robot>");
  ASSERT_EQ(pairs.size(), 2U);
  EXPECT_EQ(pairs[0].first, "link_1");
  EXPECT_EQ(pairs[0].second, "link_2");
  EXPECT_EQ(pairs[0].reason, "Adjacent");
  EXPECT_EQ(pairs[1].first, "link_4");
  EXPECT_EQ(pairs[1].reason, "");
}

TEST(Srdf, RefusesALinkTheRobotDoesNotHave) {
  try {
    (void)load("<robot name='r'>\n<disable_collisions link1='link_1' link2='tail'/></robot>");
    FAIL() << "accepted";
  } catch (const SetupError& error) {
    EXPECT_EQ(error.line(), 2);
    EXPECT_NE(std::string(error.what()).find("link2 of <disable_collisions> is 'tail'"),
              std::string::npos)
        << error.what();
  }
  EXPECT_THROW((void)load("<robot name='r'><disable_collisions link1='link_1'/></robot>"),
               SetupError);
  EXPECT_THROW((void)load("<robot"), SetupError);
}

}  // namespace srdf_test
}  // namespace repel
