// SPDX-License-Identifier: BSD-3-Clause
// A robot description whose collision parts are obstacles.
#include <algorithm>
#include <fstream>

#include <repel/robots/mjcf.hpp>
#include <repel/robots/sdf.hpp>
#include <repel/runs/arms/contact.hpp>
#include <repel/runs/setup/describe.hpp>
#include <repel/scene/scene.hpp>

#include "end_to_end/hook.hpp"
#include "end_to_end/teleop.hpp"

namespace repel::test {
namespace static_model_test {

/// A table under the tool, with a hook on a fixed joint beside it, as one description.
std::string scene_of(const Folder& folder) {
  (void)folder.with("hook.stl", hook_stl());
  (void)folder.with("hook.stl.parts.yaml", hook_list());
  (void)folder.with("cell.urdf",
                    "<robot name='cell'><link name='table'><collision name='plate'><geometry>"
                    "<box size='0.6 0.8 0.05'/></geometry></collision></link><link name='side'>"
                    "<collision><geometry><mesh filename='hook.stl'/></geometry></collision></link>"
                    "<joint name='j' type='fixed'><parent link='table'/><child link='side'/>"
                    "<origin xyz='0 0.3 0.02'/></joint></robot>");
  return folder.with(
      "scene.yaml",
      robot_text() +
          "laws:\n  default: {range: 20 mm, surface_force: 40 N, damping: 1 N s/m}\n"
          "obstacles:\n"
          "  - {name: cell, shape: urdf, file: cell.urdf, position: 0.6 -0.15 0.425 m}\n" +
          push_text());
}

TEST(StaticModel, BecomesObstaclesOfItsLinksAndCovers) {
  const Folder folder;
  const scene::Scene scene = scene::load(scene_of(folder));
  const runs::DescribedScene described = runs::describe(scene, 400.0);
  const CellDescription& cell = described.cell;
  ASSERT_EQ(cell.obstacles.size(), 3U);
  EXPECT_EQ(cell.obstacles[0].name, "cell/table/plate");
  EXPECT_EQ(cell.obstacles[1].name, "cell/side/side_0/1");
  EXPECT_EQ(cell.obstacles[2].name, "cell/side/side_0/2");
  EXPECT_EQ(cell.obstacles[0].law.range, 0.02);
  EXPECT_LT((cell.obstacles[2].X_WP.translation() - Vec3(0.6, 0.15, 0.445)).norm(), 1e-12);
  const auto* const shown = &described.shown.at(cell.arms[0].parts.size());
  EXPECT_EQ(shown[0].of, "") << "the only one of its link";
  EXPECT_EQ(shown[1].of, "cell/side");
  EXPECT_EQ(shown[2].of, "cell/side");
}

TEST(StaticModel, PushesAsTheSamePartsInTheSceneWouldAlsoInContact) {
  const Folder folder;
  const std::string plain = folder.with("plain.yaml", robot_text() + table_text() + push_text());
  const auto run = [&](const std::string& scene, const std::string& more) {
    const Ending ending =
        teleop(quoted(scene) + " --fast --seconds 2 --report " + quoted(folder / "r.json") + more);
    EXPECT_EQ(ending.status, 0) << ending;
    return report_of(folder / "r.json").at("obstacles")[0];
  };
  const auto table = run(plain, "");
  const auto model = run(scene_of(folder), "");
  EXPECT_EQ(model.at("name"), "cell/table/plate");
  EXPECT_GT(model.at("peak_force_n"), 10.0);
  EXPECT_EQ(model.at("peak_force_n"), table.at("peak_force_n"));
  EXPECT_EQ(run(folder / "scene.yaml", " --contact").at("name"), "cell/table/plate");
}

TEST(StaticModel, IsRecordedAndAnotherOneIsRefused) {
  const Folder folder;
  const std::string recording = folder / "run.mcap";
  const Ending ending =
      teleop(quoted(scene_of(folder)) + " --fast --seconds 1 --log " + quoted(recording));
  ASSERT_EQ(ending.status, 0) << ending;
  const auto replay = [&] { return teleop("replay " + quoted(recording)); };
  const Ending same = replay();
  EXPECT_EQ(same.status, 0) << same;
  EXPECT_TRUE(same.says("cell/table/plate")) << same;
  std::ofstream(folder / "hook.stl.parts.yaml", std::ios::app) << "      - 0 0 0.1 m\n";
  const Ending parts = replay();
  EXPECT_EQ(parts.status, 1) << parts;
  EXPECT_TRUE(parts.says("hook.stl.parts.yaml")) << parts;
  (void)folder.with("hook.stl.parts.yaml", hook_list());
  std::ofstream(folder / "cell.urdf", std::ios::app) << "<!-- changed -->\n";
  const Ending other = replay();
  EXPECT_EQ(other.status, 1) << other;
  EXPECT_TRUE(other.says("cell.urdf")) << other;
}

TEST(StaticModel, OfAnSdfFilePushesAsTheSceneWouldAndIsRecorded) {
  if (!reads_sdf()) GTEST_SKIP() << "built without libsdformat";
  const Folder folder;
  (void)scene_of(folder);
  const std::string file = folder.with(
      "cell.sdf",
      "<sdf version='1.9'><model name='m'><link name='table'><collision name='plate'><geometry>"
      "<box><size>0.6 0.8 0.05</size></box></geometry></collision></link>"
      "<link name='side'><pose relative_to='table'>0 0.3 0.02 0 0 0</pose><collision name='hook'>"
      "<geometry><mesh><uri>hook.stl</uri></mesh></geometry></collision></link></model></sdf>");
  std::string text = text_of(folder / "scene.yaml");
  text.replace(text.find("shape: urdf, file: cell.urdf"), 28, "shape: sdf, file: cell.sdf");
  const std::string scene = folder.with("sdf.yaml", text);
  const auto cell = runs::describe(scene::load(scene), 400.0).cell;
  const auto other = runs::describe(scene::load(folder / "scene.yaml"), 400.0).cell;
  ASSERT_EQ(cell.obstacles.size(), 3U);
  EXPECT_EQ(cell.obstacles[0].name, "cell/m::table/plate");
  EXPECT_EQ(cell.obstacles[2].name, "cell/m::side/hook/2");
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(cell.obstacles[i].X_WP.isApprox(other.obstacles[i].X_WP, 1e-12)) << i;
  }
  const std::string recording = folder / "run.mcap";
  const Ending ending = teleop(quoted(scene) + " --fast --seconds 1 --log " + quoted(recording));
  ASSERT_EQ(ending.status, 0) << ending;
  EXPECT_EQ(teleop("replay " + quoted(recording)).status, 0);
  std::ofstream(file, std::ios::app) << "<!-- changed -->\n";
  const Ending changed = teleop("replay " + quoted(recording));
  EXPECT_EQ(changed.status, 1) << changed;
  EXPECT_TRUE(changed.says("cell.sdf")) << changed;
}

TEST(StaticModel, OfAnMjcfFilePushesAsTheSceneWould) {
  if (!reads_mjcf()) GTEST_SKIP() << "built without MuJoCo";
  const Folder folder;
  (void)scene_of(folder);
  (void)folder.with("cell.xml",
                    "<mujoco><worldbody><body name='table'>"
                    "<geom name='plate' type='box' size='0.3 0.4 0.025'/></body>"
                    "<geom name='post' type='sphere' size='0.1' pos='0 0 5'/>"
                    "</worldbody></mujoco>");
  const auto peak_in = [&](const std::string& with) -> double {
    std::string text = text_of(folder / "scene.yaml");
    text.replace(text.find("shape: urdf, file: cell.urdf"), 28, with);
    const Ending ending = teleop(quoted(folder.with("mjcf.yaml", text)) +
                                 " --fast --seconds 2 --report " + quoted(folder / "r.json"));
    EXPECT_EQ(ending.status, 0) << ending;
    const nlohmann::json report = report_of(folder / "r.json");
    for (const nlohmann::json& obstacle : report.at("obstacles")) {
      if (obstacle.at("name") == "cell/table/plate") return obstacle.at("peak_force_n");
    }
    return 0.0;
  };
  const double peak = peak_in("shape: mjcf, file: cell.xml");
  EXPECT_GT(peak, 10.0);
  EXPECT_EQ(peak, peak_in("shape: urdf, file: cell.urdf"));
}

TEST(StaticModel, WithoutACollisionPartIsRefused) {
  const Folder folder;
  const std::string scene = scene_of(folder);
  (void)folder.with("cell.urdf", "<robot name='cell'><link name='table'/></robot>");
  const Ending ending = teleop(quoted(scene) + " --fast --seconds 1");
  EXPECT_EQ(ending.status, 1) << ending;
  EXPECT_TRUE(ending.says("'cell' has no collision part")) << ending;
}

}  // namespace static_model_test
}  // namespace repel::test
