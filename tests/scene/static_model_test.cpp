// SPDX-License-Identifier: BSD-3-Clause
// Robot descriptions among the obstacles of a scene.
#include <gtest/gtest.h>

#include <repel/scene/scene.hpp>

#include "end_to_end/folder.hpp"
#include "scene/yaml_text.hpp"

namespace repel::scene {
namespace static_model_test {

/// A scene whose obstacles are a ball and what `entry` says.
Scene parsed(const test::Folder& folder, const std::string& entry) {
  (void)folder.with("puma.urdf", test::text_of("robots/puma560.urdf"));
  (void)folder.with("cell.urdf", "not read here");
  return parse(
      "robot: {urdf: puma.urdf, start: 0 45 180 0 45 0 deg}\n"
      "tool:\n"
      "  - {name: rod, shape: sphere, radius: 20 mm}\n"
      "laws: {soft: {range: 30 mm}}\n"
      "obstacles:\n"
      "  - {name: ball, shape: sphere, radius: 20 mm}\n"
      "  - {" +
          entry + "}\n",
      folder / "scene.yaml");
}

std::string complaint(const std::string& entry) {
  const test::Folder folder;
  try {
    (void)parsed(folder, entry);
  } catch (const SetupError& error) {
    EXPECT_EQ(error.line(), 7) << error.what();
    return error.what();
  }
  return "accepted";
}

TEST(StaticModel, HasFilePoseLawAndPackages) {
  const test::Folder folder;
  const Scene scene = parsed(folder,
                             "name: cell, shape: urdf, file: cell.urdf, position: 1 2 3 m, "
                             "law: soft, packages: ., covers: no");
  EXPECT_EQ(scene.obstacles.size(), 1U);
  ASSERT_EQ(scene.models.size(), 1U);
  const scene::StaticModel& model = scene.models[0];
  EXPECT_EQ(model.name, "cell");
  EXPECT_EQ(model.file, folder / "cell.urdf");
  EXPECT_EQ(model.X_WM.translation(), Vec3(1, 2, 3));
  EXPECT_EQ(model.law.range, 0.03);
  EXPECT_EQ(model.packages.size(), 1U);
  EXPECT_FALSE(model.covers);
  EXPECT_EQ(model.format, scene::ModelFormat::urdf);
  const test::Folder other;
  EXPECT_TRUE(parsed(other, "name: cell, shape: urdf, file: cell.urdf").models[0].covers);
  (void)other.with("cell.sdf", "not read here");
  const Scene sdf = parsed(other, "name: cell, shape: sdf, file: cell.sdf, law: soft");
  ASSERT_EQ(sdf.models.size(), 1U);
  EXPECT_EQ(sdf.models[0].format, scene::ModelFormat::sdf);
  EXPECT_EQ(sdf.models[0].file, other / "cell.sdf");
  EXPECT_EQ(sdf.models[0].law.range, 0.03);
}

TEST(StaticModel, WithWhatItCannotHaveIsRefusedWithItsLine) {
  const std::string cell = "name: cell, shape: urdf, file: cell.urdf";
  EXPECT_NE(complaint(cell + ", radius: 1 m").find("radius"), std::string::npos);
  EXPECT_NE(complaint(cell + ", motion: {along: 1 0 0 m, duration: 1 s}").find("motion"),
            std::string::npos);
  EXPECT_NE(complaint("name: cell, shape: urdf, file: no.urdf").find("no.urdf"), std::string::npos);
  EXPECT_NE(complaint("name: ball, shape: urdf, file: cell.urdf").find("ball"), std::string::npos);
  EXPECT_NE(complaint("name: cell, shape: mjcf, file: cell.urdf, covers: no").find("covers"),
            std::string::npos);
  EXPECT_NE(complaint("name: cell, shape: cloud").find("urdf"), std::string::npos);
}

TEST(StaticModel, IsNoTool) {
  const test::Folder folder;
  (void)folder.with("puma.urdf", test::text_of("robots/puma560.urdf"));
  EXPECT_THROW((void)parse("robot: {urdf: puma.urdf, start: 0 45 180 0 45 0 deg}\n"
                           "tool: [{name: hand, shape: urdf, file: puma.urdf}]\n"
                           "obstacles: []\n",
                           folder / "scene.yaml"),
               SetupError);
}

}  // namespace static_model_test
}  // namespace repel::scene
