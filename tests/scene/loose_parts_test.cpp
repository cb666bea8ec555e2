// SPDX-License-Identifier: BSD-3-Clause
// Parts of a scene that can come, be gripped and go, and the steps of scripts that change them.
#include <gtest/gtest.h>

#include <repel/scene/scene.hpp>

#include "scene/yaml_text.hpp"

namespace repel::scene {
namespace loose_parts_test {

using What = PartStep::What;

Scene parsed(const std::string& loose, const std::string& script) {
  const std::string text =
      "robot: {urdf: ../robots/puma560.urdf, start: 0 45 180 0 45 0 deg}\n"
      "tool:\n"
      "  - {name: rod, shape: sphere, radius: 20 mm}\n"
      "laws:\n"
      "  soft: {range: 7 mm}\n"
      "obstacles: []\n"
      "loose:\n" +
      loose + "script:\n" + script;
  return testing::parsed(text);
}

std::string complaint(const std::string& loose, const std::string& script) {
  try {
    (void)parsed(loose, script);
  } catch (const SetupError& error) {
    return error.what();
  }
  return "accepted";
}

const std::string two =
    "  - {name: block, shape: box, size: 1 2 3 cm, position: 0.5 0 0.2 m, law: soft}\n"
    "  - {name: can, shape: sphere, radius: 2 cm, at_start: no}\n";
const std::string wait = "  - {name: wait, device: spaceball, duration: 1 s";

TEST(LooseOfAScene, AreReadWithTheStepsOfTheScript) {
  const Scene scene = parsed(two, wait + "}\n" +
                                      "  - {name: take, device: spaceball, duration: 1 s, "
                                      "spawn: can, grip: [block, can], over: 50 ms}\n"
                                      "  - {name: put, device: torque_arm, duration: 1 s, "
                                      "direction: 1 0 0, lever: 0 rad/s, release: block}\n");
  ASSERT_EQ(scene.loose.size(), 2U);
  EXPECT_EQ(scene.loose[0].name, "block");
  EXPECT_EQ(scene.loose[0].law.range, 7e-3);
  EXPECT_EQ(scene.loose[0].X_WP.translation(), Vec3(0.5, 0, 0.2));
  EXPECT_TRUE(scene.loose[0].at_start);
  EXPECT_FALSE(scene.loose[1].at_start);
  ASSERT_EQ(scene.steps.size(), 4U);
  const auto is = [&](std::size_t i, What what, std::size_t phase, std::size_t part, double over) {
    const PartStep& step = scene.steps[i];
    EXPECT_TRUE(step.what == what && step.phase == phase && step.part == part && step.over == over)
        << "step " << i;
  };
  is(0, What::spawn, 1, 1, 0.05);
  is(1, What::grip, 1, 0, 0.05);
  is(2, What::grip, 1, 1, 0.05);
  is(3, What::release, 2, 0, 0.2);
}

TEST(LooseOfAScene, AreRefusedWithWhatIsAllowed) {
  EXPECT_NE(complaint(two, wait + ", grip: bottle}\n").find("the name of a part under 'loose'"),
            std::string::npos);
  EXPECT_NE(complaint(two, wait + ", over: 100 s}\n").find("60"), std::string::npos);
  EXPECT_NE(complaint(two + two, wait + "}\n").find("a name no other entry has"),
            std::string::npos);
  EXPECT_NE(complaint("  - {name: a, shape: sphere, radius: 1 cm, at_start: maybe}\n", wait + "}\n")
                .find("yes"),
            std::string::npos);
  EXPECT_NE(complaint("  - {name: a, shape: sphere, radius: 1 cm, motion: {}}\n", wait + "}\n")
                .find("motion"),
            std::string::npos)
      << "no key of such parts";
}

TEST(SpareOfAScene, IsReadAndRefused) {
  const std::string text = testing::base_scene;
  const Scene scene = testing::parsed(text + "spare: {count: 3, room: 20 cm}\n");
  EXPECT_EQ(scene.spare.count, 3);
  EXPECT_EQ(scene.spare.room, 0.2);
  EXPECT_EQ(testing::parsed(text).spare.count, 0);
  EXPECT_THROW((void)testing::parsed(text + "spare: {count: 51}\n"), SetupError);
  EXPECT_THROW((void)testing::parsed(text + "spare: {room: 1 m}\n"), SetupError);
}

}  // namespace loose_parts_test
}  // namespace repel::scene
