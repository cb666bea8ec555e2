// SPDX-License-Identifier: BSD-3-Clause
// The program that covers meshes, as run by a user.
#include "end_to_end/program.hpp"

#include "cover/meshes.hpp"

#ifdef REPEL_COVER_OCTOMAP
#include <octomap/OcTree.h>
#endif

namespace repel::test {
namespace cover_program_test {

using nlohmann::json;

Ending cover(const std::string& arguments) {
  return run_program(REPEL_COVER, arguments);
}

/// A mesh as an OBJ file.
std::string obj_of(const TriangleMesh& mesh) {
  std::ostringstream text;
  text.precision(17);
  for (const Vec3& p : mesh.vertices) text << "v " << p.x() << " " << p.y() << " " << p.z() << "\n";
  for (const auto& t : mesh.triangles) {
    text << "f " << t[0] + 1 << " " << t[1] + 1 << " " << t[2] + 1 << "\n";
  }
  return text.str();
}

TEST(CoverProgram, WritesPartsThatAScenePutsIntoItsWorld) {
  const Folder folder;
  const std::string mesh = folder.with("bin.obj", obj_of(Bin().mesh()));
  const Ending ending =
      cover(quoted(mesh) + " --parts 16 --error 1mm --overlap 5mm --json " + quoted(folder / "j"));
  ASSERT_EQ(ending.status, 0) << ending;
  EXPECT_TRUE(ending.says("uncovered   nothing")) << ending;
  const json report = json::parse(text_of(folder / "j"));
  EXPECT_GE(report.at("parts").size(), 5U);
  EXPECT_EQ(report.at("parts")[0][0].size(), 3U);
  EXPECT_LE(report.at("uncovered_m"), 1e-6);
  EXPECT_LE(report.at("excess_m"), 1.1e-3);
  EXPECT_GE(report.at("seam_m"), 1e-3);
  EXPECT_TRUE(report.at("uncovered").empty());
  EXPECT_NE(text_of(mesh + ".parts.yaml").find("mesh: 'bin.obj'"), std::string::npos);
}

TEST(CoverProgram, AnOpenMeshIsCoveredAndSaidToBeOpen) {
  const Folder folder;
  TriangleMesh open = box_mesh({0.1, 0.1, 0.1});
  open.triangles.pop_back();
  const std::string mesh = folder.with("open.obj", obj_of(open));
  const Ending ending = cover(quoted(mesh) + " -o " + quoted(folder / "p.yaml"));
  EXPECT_EQ(ending.status, 0) << ending;
  EXPECT_TRUE(ending.says("the surface is open, 3 edges have no opposite")) << ending;
  EXPECT_TRUE(ending.says("excess is more than")) << ending;
}

TEST(CoverProgram, KeepsWhereTheSurfaceIsInNoPartBesideTheParts) {
  const Folder folder;
  const std::string mesh = folder.with("box.obj", obj_of(box_mesh({0.2, 0.1, 0.1})));
  const std::string list = folder / "p.yaml";
  const std::string arguments =
      quoted(mesh) + " -o " + quoted(list) + " --engine coacd --json " + quoted(folder / "j");
  const auto run = [&](const std::string& more) {
    return run_program("env",
                       "REPEL_COACD=" REPEL_HALF_COVER " " REPEL_COVER " " + arguments + more);
  };
  EXPECT_EQ(run("").status, 1);
  const Ending ending = run(" --allow-gaps");
  ASSERT_EQ(ending.status, 0) << ending;
  const json report = json::parse(text_of(folder / "j"));
  EXPECT_NEAR(report.at("uncovered_m"), 0.09, 0.011) << "half of the box is in no part";
  const std::string text = text_of(list);
  const std::size_t count = report.at("uncovered").size();
  ASSERT_GT(count, 0U);
  EXPECT_NE(text.find("gap_count: " + std::to_string(count) + "\n"), std::string::npos) << text;
  const std::size_t first = text.find("- {at: ");
  ASSERT_NE(first, std::string::npos) << text;
  const double x = std::stod(text.substr(first + 7));
  EXPECT_GT(x, 0.1) << "in the half that is not covered";
  EXPECT_LT(x, 0.2001);
  const std::size_t depth = text.find("depth: ");
  EXPECT_NEAR(std::stod(text.substr(depth + 7)), report.at("uncovered_m"), 1e-6)
      << "the deepest comes first";
  ASSERT_EQ(cover(quoted(mesh) + " -o " + quoted(list)).status, 0);
  EXPECT_EQ(text_of(list).find("gap"), std::string::npos) << "nothing is uncovered";
}

TEST(CoverProgram, RefusesWhatIsNoMeshWithItsName) {
  const Folder folder;
  const std::string mesh = folder.with("notes.stl", "these are no triangles");
  const Ending ending = cover(quoted(mesh));
  EXPECT_EQ(ending.status, 1);
  EXPECT_TRUE(ending.says("notes.stl")) << ending;
  EXPECT_EQ(text_of(mesh + ".parts.yaml"), "");
  EXPECT_EQ(cover(quoted(folder / "none.stl")).status, 1);
}

TEST(CoverProgram, RefusesLengthsAndFactorsOutOfRange) {
  const Folder folder;
  const std::string mesh = quoted(folder.with("box.obj", obj_of(box_mesh({1, 1, 1}))));
  for (const char* wrong : {"--error 0", "--error 2km", "--overlap -1mm", "--parts 0",
                            "--engine knife", "--scale nan"}) {
    EXPECT_EQ(cover(mesh + " " + wrong).status, 2) << wrong;
  }
  EXPECT_EQ(cover(mesh + " --scale 0").status, 1);
  const Ending ending = cover("--help");
  EXPECT_EQ(ending.status, 0);
  EXPECT_TRUE(ending.says("--overlap")) << ending;
}

#ifdef REPEL_COVER_OCTOMAP
TEST(CoverProgram, MakesBoxesOfAMap) {
  // A room of 1 m with a shelf in it, of which one corner has not been seen.
  octomap::OcTree tree(0.05);
  const auto middle = [](int cube) { return 0.05 * cube + 0.025; };
  for (int z = 0; z < 20; ++z) {
    for (int y = 0; y < 20; ++y) {
      for (int x = 0; x < 20; ++x) {
        if (x >= 16 && y >= 16) continue;
        const bool is_solid = z == 0 || (z == 8 && y < 6) || x == 0;
        (void)tree.updateNode(
            octomap::point3d(static_cast<float>(middle(x)), static_cast<float>(middle(y)),
                             static_cast<float>(middle(z))),
            is_solid);
      }
    }
  }
  tree.prune();
  const Folder folder;
  const std::string map = folder / "room.bt";
  ASSERT_TRUE(tree.writeBinary(map));
  const auto boxes = [&](const std::string& options, double cube) {
    const Ending ending = cover(quoted(map) + " " + options + " --json " + quoted(folder / "j"));
    EXPECT_EQ(ending.status, 0) << ending;
    const json report = json::parse(text_of(folder / "j"));
    EXPECT_NEAR(report.at("excess_m"), std::sqrt(3.0) * (cube - 0.05), 1e-9);
    return report.at("parts").size();
  };
  EXPECT_EQ(boxes("", 0.05), 4U) << "the floor on two sides of the corner, a wall, the shelf";
  EXPECT_EQ(boxes("--unseen solid", 0.05), 4U) << "the corner is solid to the ceiling";
  EXPECT_GE(boxes("--cube 10cm", 0.1), 3U);
  EXPECT_NE(text_of(map + ".parts.yaml").find("mesh: 'room.bt'"), std::string::npos);
  EXPECT_EQ(cover(quoted(map) + " --scale 2").status, 1);
  const Ending refused = cover(quoted(map) + " --parts 1");
  EXPECT_EQ(refused.status, 1);
  EXPECT_TRUE(refused.says("needs 4 boxes")) << refused;
  const Ending no_map = cover(quoted(folder.with("no.bt", "this is no map")));
  EXPECT_EQ(no_map.status, 1);
  EXPECT_TRUE(no_map.says("no.bt")) << no_map;
}
#endif

}  // namespace cover_program_test
}  // namespace repel::test
