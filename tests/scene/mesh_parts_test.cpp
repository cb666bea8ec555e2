// SPDX-License-Identifier: BSD-3-Clause
// Meshes in a scene, and the files with their convex parts.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include <repel/scene/part_list.hpp>
#include <repel/scene/scene.hpp>

#include "end_to_end/folder.hpp"
#include "scene/yaml_text.hpp"

namespace repel::scene {
namespace mesh_parts_test {

const std::vector<Vec3> wedge{{0, 0, 0}, {0.1, 0, 0}, {0, 0.2, 0}, {0, 0, 1.0 / 3.0}};
const std::vector<Vec3> other{{1, 0, 0}, {1.1, 0, 0}, {1, 0.2, 0}, {1, 0, 0.3}};

/// A folder with a mesh, a list of its parts and a scene with both.
class MeshParts : public ::testing::Test {
 protected:
  MeshParts() {
    (void)folder_.with("bin.stl", "the bytes of a mesh");
    (void)folder_.with("puma.urdf", test::text_of("robots/puma560.urdf"));
    list_ = {"bin.stl",      checksum_of_file(folder_ / "bin.stl"),
             {1, 1, 1},      1e-9,
             2e-3,           5e-3,
             {wedge, other}, {7, {{{0.1, 1.0 / 3.0, -0.2}, 4e-3}, {{0, 0, 0.3}, 1e-3}}}};
  }

  void write(const std::string& name) const {
    std::ofstream file(folder_ / name);
    write_part_list(list_, file);
  }

  [[nodiscard]] Scene parsed(const std::string& keys) const {
    const std::string text =
        "robot: {urdf: puma.urdf, start: 0 45 180 0 45 0 deg}\n"
        "tool:\n"
        "  - {name: rod, shape: sphere, radius: 20 mm}\n"
        "obstacles:\n"
        "  - {name: bin, shape: mesh, file: bin.stl, position: 1 2 3 m" +
        keys + "}\n";
    return parse(text, folder_ / "scene.yaml");
  }

  [[nodiscard]] std::string complaint(const std::string& keys = "") const {
    try {
      (void)parsed(keys);
    } catch (const SetupError& error) {
      return error.what();
    }
    return "accepted";
  }

  test::Folder folder_;
  PartList list_;
};

TEST_F(MeshParts, ReadBackAsTheyWereWritten) {
  write("list.yaml");
  const PartList read = read_part_list(folder_ / "list.yaml");
  EXPECT_EQ(read.mesh, list_.mesh);
  EXPECT_EQ(read.checksum, list_.checksum);
  EXPECT_EQ(read.uncovered, list_.uncovered);
  EXPECT_EQ(read.excess, list_.excess);
  EXPECT_EQ(read.seam, list_.seam);
  ASSERT_EQ(read.parts.size(), 2U);
  EXPECT_EQ(read.parts[0], wedge);  // to the bit, a third too
  EXPECT_EQ(read.parts[1], other);
  EXPECT_EQ(read.gaps.count, 7U);
  ASSERT_EQ(read.gaps.deepest.size(), 2U);
  EXPECT_EQ(read.gaps.deepest[0].p_M, list_.gaps.deepest[0].p_M);
  EXPECT_EQ(read.gaps.deepest[1].depth, 1e-3);
}

TEST_F(MeshParts, TellTheirFirstObstacleWhatIsNotCovered) {
  write("bin.stl.parts.yaml");
  const Scene scene = parsed("");
  EXPECT_EQ(scene.obstacles[0].shown.gaps.count, 7U);
  EXPECT_EQ(scene.obstacles[0].shown.gaps.deepest.at(0).p_M.z(), -0.2);
  EXPECT_EQ(scene.obstacles[1].shown.gaps.count, 0U);
  list_.gaps = {};
  write("bin.stl.parts.yaml");
  EXPECT_EQ(parsed("").obstacles[0].shown.gaps.count, 0U);
}

TEST_F(MeshParts, KnowWhatTheyAreSeveralOf) {
  write("bin.stl.parts.yaml");
  for (const Obstacle& each : parsed("").obstacles) EXPECT_EQ(each.shown.of, "bin");
  list_.parts.pop_back();
  write("bin.stl.parts.yaml");
  EXPECT_EQ(parsed("").obstacles.at(0).shown.of, "") << "the only one";
}

TEST_F(MeshParts, WithGapsThatCannotBeAreRefusedWithTheirLine) {
  const std::string parts = "\nparts:\n  - points: [0 0 0 m]\n";
  for (const char* wrong : {"gaps: [{at: 0 0 0 m, depth: -1 mm}]", "gaps: [{at: 0 0 0 m}]",
                            "gap_count: 1\ngaps: [{at: 0 0 0 m, depth: 1 mm}, "
                            "{at: 0 0 0 m, depth: 1 mm}]"}) {
    (void)folder_.with("bin.stl.parts.yaml", wrong + parts);
    EXPECT_NE(complaint().find("parts.yaml:1"), std::string::npos) << complaint();
  }
}

TEST_F(MeshParts, BesideTheMeshAreObstaclesWithItsPoseAndLaw) {
  write("bin.stl.parts.yaml");
  for (const char* keys : {"", ", parts: auto"}) {
    const Scene scene = parsed(keys);
    ASSERT_EQ(scene.obstacles.size(), 2U);
    EXPECT_EQ(scene.obstacles[0].name, "bin/1");
    EXPECT_EQ(scene.obstacles[1].name, "bin/2");
    EXPECT_EQ(scene.obstacles[1].kind, "hull");
    EXPECT_EQ(scene.obstacles[1].X_WP.translation(), Vec3(1, 2, 3));
    ASSERT_EQ(scene.part_lists.size(), 1U);
    EXPECT_EQ(scene.part_lists[0], folder_ / "bin.stl.parts.yaml");
  }
}

TEST_F(MeshParts, MayBeNamedAndMayBeATool) {
  write("few.yaml");
  EXPECT_EQ(parsed(", parts: few.yaml").obstacles.size(), 2U);
  const Scene scene = parse(
      "robot: {urdf: puma.urdf, start: 0 45 180 0 45 0 deg}\n"
      "tool:\n"
      "  - {name: hand, shape: mesh, file: bin.stl, parts: few.yaml}\n"
      "obstacles: []\n",
      folder_ / "scene.yaml");
  ASSERT_EQ(scene.tool.size(), 2U);
  EXPECT_EQ(scene.tool[1].name, "hand/2");
}

TEST_F(MeshParts, ThatAreMissingAreNamedWithTheLineThatMakesThem) {
  const std::string text = complaint();
  EXPECT_NE(text.find("scene.yaml:5"), std::string::npos) << text;
  EXPECT_NE(text.find("cover '" + folder_ / "bin.stl"), std::string::npos) << text;
}

TEST_F(MeshParts, OfAnotherVersionOfTheMeshAreRefused) {
  write("bin.stl.parts.yaml");
  (void)folder_.with("bin.stl", "other bytes");
  const std::string text = complaint();
  EXPECT_NE(text.find("another version"), std::string::npos) << text;
}

TEST_F(MeshParts, AreConvertedToTheScaleThatIsAskedFor) {
  std::vector<std::string> lists;
  EXPECT_TRUE(parts_beside(folder_ / "bin.stl", Vec3::Ones(), lists).empty());
  EXPECT_TRUE(lists.empty()) << "there is none yet";
  list_.scale = {0.001, 0.001, 0.001};
  write("bin.stl.parts.yaml");
  EXPECT_EQ(parts_beside(folder_ / "bin.stl", list_.scale, lists)[0], wedge) << "to the bit";
  const auto parts = parts_beside(folder_ / "bin.stl", {0.002, -0.001, 0.001}, lists);
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_NEAR(parts[1][0].x(), 2.0 * other[0].x(), 1e-12);
  EXPECT_NEAR(parts[1][2].y(), -other[2].y(), 1e-12);
  EXPECT_EQ(lists, std::vector<std::string>{folder_ / "bin.stl.parts.yaml"});
  const PartList list = list_beside(folder_ / "bin.stl", {0.002, -0.001, 0.001}, lists);
  EXPECT_EQ(list.gaps.count, 7U);
  EXPECT_LT((list.gaps.deepest[0].p_M - Vec3(0.2, -1.0 / 3.0, -0.2)).norm(), 1e-12);
  EXPECT_NEAR(list.gaps.deepest[0].depth, 8e-3, 1e-12) << "as if all was along x";
  EXPECT_NEAR(list.uncovered, 2e-9, 1e-18);
  EXPECT_NEAR(list.excess, 4e-3, 1e-12);
  EXPECT_FALSE(list.seam) << "not searched for in what is not a scaled copy";
  EXPECT_NEAR(*list_beside(folder_ / "bin.stl", {0.002, -0.002, 0.002}, lists).seam, 1e-2, 1e-12);
  EXPECT_THROW((void)parts_beside(folder_ / "bin.stl", {1, 0, 1}, lists), SetupError);
  list_.scale.x() = 0.0;
  write("bin.stl.parts.yaml");
  EXPECT_THROW((void)parts_beside(folder_ / "bin.stl", Vec3::Ones(), lists), SetupError);
}

TEST_F(MeshParts, OfAnotherVersionAndScaleAreMadeAnewWithThatScale) {
  list_.scale = {0.001, 0.001, 0.001};
  write("bin.stl.parts.yaml");
  (void)folder_.with("bin.stl", "other bytes");
  const std::string text = complaint();
  EXPECT_NE(text.find("--scale 0.001 0.001 0.001"), std::string::npos) << text;
}

TEST_F(MeshParts, ThatAreNoListAreRefusedWithTheirLine) {
  const auto with = [&](const std::string& text) {
    (void)folder_.with("bin.stl.parts.yaml", text);
    return complaint();
  };
  EXPECT_NE(with("parts:\n  - points: [1 2 3 kg]\n").find("parts.yaml:2"), std::string::npos);
  EXPECT_NE(with("parts: []\n").find("no part"), std::string::npos);
  EXPECT_NE(with("pieces: []\n").find("parts"), std::string::npos);
  EXPECT_NE(with("checksum: 00\nparts: []\n").find("another version"), std::string::npos);
}

TEST_F(MeshParts, TakeNoSizesOfOtherShapes) {
  write("bin.stl.parts.yaml");
  EXPECT_NE(complaint(", radius: 1 m").find("radius"), std::string::npos);
}

}  // namespace mesh_parts_test
}  // namespace repel::scene
