// SPDX-License-Identifier: BSD-3-Clause
// Links of a robot whose meshes have convex parts.
#include <algorithm>
#include <fstream>

#include <repel/robots/parts.hpp>
#include <repel/runs/arms/contact.hpp>
#include <repel/runs/setup/describe.hpp>
#include <repel/scene/part_list.hpp>
#include <repel/scene/scene.hpp>

#include "end_to_end/hook.hpp"
#include "end_to_end/teleop.hpp"

namespace repel::test {
namespace link_cover_test {

/// A scene in which the walls act on all links of the Puma with a hook.
std::string scene_of(const Folder& folder, const std::string& keys = "",
                     const std::string& scale = "1 1 1") {
  return folder.with("scene.yaml",
                     robot_text(with_hook(folder, scale), keys) + table_text() + push_text());
}

/// The parts of the hook in the cell of a scene.
std::vector<ArmPart> hook_parts(const std::string& scene) {
  runs::DescribedScene described = runs::describe(scene::load(scene), 400.0);
  std::vector<ArmPart> parts = described.cell.arms[0].parts;
  std::erase_if(parts, [](const ArmPart& part) { return !part.name.starts_with("hook"); });
  return parts;
}

TEST(LinkCover, IsTheListBesideTheMeshUnlessTheSceneSaysNo) {
  const Folder folder;
  (void)folder.with("hook.stl.parts.yaml", hook_list());
  const auto parts = hook_parts(scene_of(folder));
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts[0].name, "hook/1");
  EXPECT_EQ(parts[1].name, "hook/2");
  EXPECT_EQ(parts[0].link, 5);
  EXPECT_EQ(parts[1].link, 5);
  if (!reads_meshes()) return;
  const auto whole = hook_parts(scene_of(folder, "  links: [link_6]\n  covers: no\n"));
  ASSERT_EQ(whole.size(), 1U);
  EXPECT_EQ(whole[0].name, "hook");
}

TEST(LinkCover, TellsWhichPartOfTheWorldHasTheGapsOfItsMesh) {
  const Folder folder;
  (void)folder.with("hook.stl.parts.yaml",
                    hook_list("gap_count: 3\ngaps: [{at: 0 0 0.06 m, depth: 2 mm}]\n"));
  const auto described = runs::describe(scene::load(scene_of(folder, "", "2 2 2")), 400.0);
  std::size_t part = 0;
  for (const ArmPart& each : described.cell.arms[0].parts) {
    const scene::Gaps& gaps = described.shown.at(part++).gaps;
    EXPECT_EQ(gaps.count, each.name == "hook/1" ? 3U : 0U) << each.name;
    if (gaps.count == 0) continue;
    EXPECT_LT((gaps.deepest.at(0).p_M - Vec3(0, 0, 0.12)).norm(), 1e-12);
    EXPECT_NEAR(gaps.deepest[0].depth, 4e-3, 1e-12);
  }
  EXPECT_EQ(described.shown.size(), part + described.cell.obstacles.size());
}

TEST(LinkCover, HasTheScaleOfTheMeshInTheRobotFile) {
  const Folder folder;
  for (const double made_for : {1.0, 0.5}) {
    (void)folder.with("hook.stl.parts.yaml", hook_list("", made_for));
    const auto scene = scene::load(scene_of(folder, "", "2 1 -3"));
    const Robot robot = std::move(runs::describe(scene, 400.0).robots[0]);
    Vec3 low = Vec3::Zero();
    Vec3 high = Vec3::Zero();
    std::size_t corners = 0;
    for (const RobotPart& part : robot.parts) {
      if (!part.is_of_cover) continue;
      corners += part.points.size();
      for (const Vec3& p : part.points) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
      }
    }
    EXPECT_EQ(corners, 16U);
    EXPECT_LT((high - Vec3(0.08, 0.005, 0.0)).norm(), 1e-12) << high.transpose();
    EXPECT_LT((low - Vec3(0.0, -0.005, -0.18)).norm(), 1e-12) << low.transpose();
  }
}

TEST(LinkCover, StandsInContactWithItsParts) {
  const Folder folder;
  (void)folder.with("hook.stl.parts.yaml", hook_list());
  const scene::Scene scene = scene::load(scene_of(folder));
  const auto parts = runs::contact_parts(scene, scene, runs::describe(scene, 400.0).robots[0]);
  EXPECT_EQ(std::count_if(parts.begin(), parts.end(),
                          [](const ContactPart& part) { return part.name.starts_with("hook/"); }),
            2);
}

TEST(LinkCover, OfAnotherVersionOfTheMeshIsRefusedWithTheLineThatMakesItAnew) {
  const Folder folder;
  const std::string scene = scene_of(folder);
  (void)folder.with("hook.stl.parts.yaml",
                    hook_list("checksum: " + scene::checksum_of_file(folder / "hook.stl") + "\n"));
  EXPECT_EQ(hook_parts(scene).size(), 2U);
  (void)folder.with("hook.stl.parts.yaml", hook_list("checksum: 00\n", 0.5));
  const Ending ending = teleop(quoted(scene) + " --fast --seconds 1");
  EXPECT_EQ(ending.status, 1) << ending;
  EXPECT_TRUE(ending.says("arm.urdf:")) << ending;
  EXPECT_TRUE(ending.says("of another version of the mesh")) << ending;
  EXPECT_TRUE(ending.says("cover '" + folder / "hook.stl")) << ending;
  EXPECT_TRUE(ending.says("--scale 0.5 0.5 0.5")) << ending;
}

TEST(LinkCover, IsRecordedAndAnotherOneIsRefused) {
  const Folder folder;
  const std::string list = folder.with("hook.stl.parts.yaml", hook_list());
  const std::string recording = folder / "run.mcap";
  const Ending ending =
      teleop(quoted(scene_of(folder)) + " --fast --seconds 1 --log " + quoted(recording));
  ASSERT_EQ(ending.status, 0) << ending;
  const auto replay = [&] { return teleop("replay " + quoted(recording)); };
  const Ending same = replay();
  EXPECT_EQ(same.status, 0) << same;
  std::ofstream(list, std::ios::app) << "      - 0 0 0.1 m\n";
  const Ending other = replay();
  EXPECT_EQ(other.status, 1) << other;
  EXPECT_TRUE(other.says("hook.stl.parts.yaml")) << other;
  EXPECT_TRUE(other.says("not as it was recorded")) << other;
  fs::remove(list);
  if (!reads_meshes()) return;
  const Ending none = replay();
  EXPECT_EQ(none.status, 1) << none;
  EXPECT_TRUE(none.says("no list of parts any more")) << none;
}

TEST(LinkCover, ThatCameAfterTheRecordingIsRefused) {
  if (!reads_meshes()) GTEST_SKIP() << "built without assimp";
  const Folder folder;
  const std::string recording = folder / "run.mcap";
  const Ending ending =
      teleop(quoted(scene_of(folder)) + " --fast --seconds 1 --log " + quoted(recording));
  ASSERT_EQ(ending.status, 0) << ending;
  (void)folder.with("hook.stl.parts.yaml", hook_list());
  const Ending late = teleop("replay " + quoted(recording));
  EXPECT_EQ(late.status, 1) << late;
  EXPECT_TRUE(late.says("was not there when")) << late;
}

}  // namespace link_cover_test
}  // namespace repel::test
