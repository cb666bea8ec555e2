// SPDX-License-Identifier: BSD-3-Clause
// The cameras of a scene, and the phases in which they are blind.
#include <gtest/gtest.h>

#include <repel/scene/scene.hpp>

#include "scene/yaml_text.hpp"

namespace repel::scene {
namespace cameras_test {

const std::string at = "position: 1 0 1 m, look_at: 0 0 0 m";
const std::string two = "cameras:\n  - {name: left, parts: 300, " + at +
                        "}\n"
                        "  - {name: right, rate: 60 Hz, " +
                        at + "}\n";

std::string phase(const std::string& blind) {
  return "script:\n  - {name: wait, device: spaceball, duration: 1 s, blind: " + blind + "}\n";
}

Scene scene_with(const std::string& text) {
  return testing::parsed(testing::base_scene + text);
}

std::string complaint(const std::string& text) {
  try {
    (void)scene_with(text);
  } catch (const SetupError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(CamerasOfAScene, AreOneOrSeveral) {
  EXPECT_TRUE(scene_with("").cameras.empty());
  const Scene one = scene_with("camera: {parts: 100, " + at + "}\n");
  ASSERT_EQ(one.cameras.size(), 1U);
  EXPECT_EQ(one.cameras[0].name, "");
  EXPECT_EQ(one.cameras[0].parts, 100);
  const Scene scene = scene_with(two);
  ASSERT_EQ(scene.cameras.size(), 2U);
  EXPECT_EQ(scene.cameras[0].name, "left");
  EXPECT_EQ(scene.cameras[0].parts, 300);
  EXPECT_EQ(scene.cameras[1].name, "right");
  EXPECT_EQ(scene.cameras[1].rate_hz, 60.0);
  EXPECT_EQ(scene.cameras[1].parts, 400);
}

TEST(CamerasOfAScene, AreBlindAllOrByName) {
  using Blind = std::vector<bool>;
  EXPECT_EQ(scene_with(two + phase("yes")).blind, std::vector<Blind>{Blind(2, true)});
  EXPECT_EQ(scene_with(two + phase("no")).blind, std::vector<Blind>{Blind{}});
  EXPECT_EQ(scene_with(two + phase("right")).blind, (std::vector<Blind>{{false, true}}));
  EXPECT_EQ(scene_with(two + phase("[left, right]")).blind, (std::vector<Blind>{{true, true}}));
  EXPECT_NE(complaint(two + phase("behind")).find("yes, no, or the name of a camera"),
            std::string::npos);
}

TEST(CamerasOfAScene, AreTurnedByAPointOrAQuaternion) {
  const auto pose = [](const std::string& turn) {
    return scene_with("camera: {position: 1.25 0.35 0.95 m, " + turn + "}\n").cameras[0].X_WC;
  };
  const Pose X = pose("look_at: 0.5 -0.1 0.15 m");
  EXPECT_TRUE(pose("orientation: -0.45088 -0.79634 0.35083 0.19864").isApprox(X, 1e-4));
  EXPECT_NE(complaint("camera: {" + at + ", orientation: 0 0 0 1}\n").find("one of the two"),
            std::string::npos);
  EXPECT_NE(complaint("camera: {position: 0 0 0 m, orientation: 0 0 1 1}\n").find("squares is 1"),
            std::string::npos);
}

TEST(CamerasOfAScene, MayHaveAMapOfAllThatTheyCanSee) {
  EXPECT_FALSE(scene_with(two).cameras[0].map);
  const Scene scene = scene_with(
      "camera: {position: 0 0 2 m, look_at: 0 0 0 m, farthest: 3 m, view: 90 deg, width: 400, "
      "height: 200, map: {cube: 10 cm, keeps: 5 s}}\n");
  const std::optional<MapChoice>& map = scene.cameras[0].map;
  ASSERT_TRUE(map);
  EXPECT_EQ(map->cube, 0.1);
  EXPECT_EQ(map->keeps, 5.0);
  // The top of the image is towards x.
  EXPECT_TRUE(map->low.isApprox(Vec3(-1.5, -3, -1), 1e-9)) << map->low.transpose();
  EXPECT_TRUE(map->high.isApprox(Vec3(1.5, 3, 2), 1e-9)) << map->high.transpose();
  const auto says = [](const std::string& more, const std::string& what) {
    const std::string text = "camera: {" + at + ", " + more + "}\n";
    EXPECT_NE(complaint(text).find(what), std::string::npos) << complaint(text);
  };
  says("map: {cube: 1 cm, keeps: 1 s}", "cubes; allowed: up to");
  says("map: {cube: 1 mm}", "cube");
  says("map: {size: 1 m}", "size");
  says("unseen: solid, map: {cube: 5 cm}", "allowed: 'free'");
}

TEST(CamerasOfAScene, AreRefusedWhereTheyMakeNoSense) {
  const auto says = [](const std::string& text, const std::string& what) {
    EXPECT_NE(complaint(text).find(what), std::string::npos) << complaint(text);
  };
  says(two + "camera: {" + at + "}\n", "one of the two");
  says(two + "spare: {count: 2}\n", "one of the two");
  says("cameras:\n  - {" + at + "}\n", "name");
  says("camera: {name: left, " + at + "}\n", "name");
  says("cameras:\n  - {name: yes, " + at + "}\n", "another name");
  says("cameras:\n  - {name: a, " + at + "}\n  - {name: a, " + at + "}\n", "a");
  says("cameras:\n  - {name: a, parts: 1500, " + at + "}\n  - {name: b, parts: 501, " + at + "}\n",
       "reserve 2001 parts; allowed: up to 2000");
  says("cameras: []\nhidden: [{name: ball, shape: sphere, radius: 1 m}]\n", "'hidden' without");
}

}  // namespace cameras_test
}  // namespace repel::scene
