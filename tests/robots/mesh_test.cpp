// SPDX-License-Identifier: BSD-3-Clause
// Collision meshes: their search paths and their conversion.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <repel/base/setup_error.hpp>
#include <repel/robots/urdf.hpp>

#include "end_to_end/folder.hpp"

namespace repel {
namespace mesh_test {

using test::Folder;
namespace fs = std::filesystem;

/// A tetrahedron with a fifth vertex inside it, as triangles.
constexpr const char* obj =
    "v 0 0 0\nv 2 0 0\nv 0 3 0\nv 0 0 4\nv 0.1 0.1 0.1\n"
    "f 1 2 3\nf 1 2 4\nf 2 3 4\nf 1 3 4\nf 1 2 5\n";

std::string urdf_with(const std::string& mesh) {
  return "<robot name='r'><link name='base'/><link name='arm'>\n"
         "<collision><origin xyz='0 0 7'/><geometry>" +
         mesh +
         "</geometry></collision></link>\n<joint name='j' type='continuous'><parent link='base'/>"
         "<child link='arm'/></joint></robot>\n";
}

Robot load(const Folder& folder, const std::string& mesh, const UrdfOptions& options = {}) {
  fs::create_directories(folder / "robot/urdf");
  return load_arm(folder.with("robot/urdf/r.urdf", urdf_with(mesh)), options);
}

/// The error message of load().
std::string complaint(const Folder& folder, const std::string& mesh,
                      const UrdfOptions& options = {}) {
  try {
    (void)load(folder, mesh, options);
  } catch (const SetupError& error) {
    EXPECT_EQ(error.line(), 2);
    return error.what();
  }
  return "accepted";
}

void put(const Folder& folder, const std::string& path, const std::string& text) {
  fs::create_directories(fs::path(folder / path).parent_path());
  (void)folder.with(path, text);
}

TEST(Mesh, BecomesTheCornersOfItsScaledHull) {
  if (!reads_meshes()) GTEST_SKIP() << "built without assimp";
  const Folder folder;
  put(folder, "robot/urdf/a.obj", obj);
  const Robot robot = load(folder, "<mesh filename='a.obj' scale='0.5 -1 0.25'/>");
  ASSERT_EQ(robot.parts.size(), 1U);
  const RobotPart& part = robot.parts[0];
  EXPECT_EQ(part.kind, PartKind::hull);
  EXPECT_EQ(part.in_link, "arm");
  EXPECT_EQ(part.X_LP.translation(), Vec3(0, 0, 7));
  ASSERT_EQ(part.points.size(), 4U) << "the corner inside stays out";
  for (const Vec3& corner : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, -3, 0), Vec3(0, 0, 1)}) {
    EXPECT_EQ(std::count(part.points.begin(), part.points.end(), corner), 1) << corner;
  }
}

TEST(Mesh, BecomesTheConvexPartsThatAreFoundForIt) {
  const Folder folder;
  put(folder, "robot/urdf/a.obj", obj);
  const std::vector<Vec3> wedge{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const std::vector<Vec3> other{{1, 0, 0}, {2, 0, 0}, {1, 1, 0}, {1, 0, 1}};
  int asked = 0;
  UrdfOptions options;
  options.convex_parts = [&](const std::string& path, const Vec3& scale) {
    ++asked;
    EXPECT_EQ(fs::path(path).filename(), "a.obj");
    EXPECT_EQ(scale, Vec3(0.5, -1, 0.25));
    return std::vector{wedge, other};
  };
  const std::string mesh = "<mesh filename='a.obj' scale='0.5 -1 0.25'/>";
  const std::string twice =
      mesh + "</geometry></collision><collision name='claw'><geometry>" + mesh;
  const Robot robot = load(folder, twice, options);
  EXPECT_EQ(asked, 1) << "each mesh once per scale";
  ASSERT_EQ(robot.parts.size(), 4U);
  const char* const names[] = {"arm_0/1", "arm_0/2", "claw/1", "claw/2"};
  for (std::size_t i = 0; i < 4; ++i) {
    const RobotPart& part = robot.parts[i];
    EXPECT_EQ(part.name, names[i]);
    EXPECT_EQ(part.in_link, "arm");
    EXPECT_EQ(part.kind, PartKind::hull);
    EXPECT_EQ(part.points, i % 2 == 0 ? wedge : other);
    EXPECT_TRUE(part.is_of_cover);
  }
  EXPECT_EQ(robot.parts[1].X_LP.translation(), Vec3(0, 0, 7));
}

TEST(Mesh, WhoseConvexPartsAreNoHullsIsRefused) {
  const Folder folder;
  put(folder, "robot/urdf/a.obj", obj);
  const auto with = [&](const std::vector<Vec3>& part) {
    UrdfOptions options;
    options.convex_parts = [&](const std::string&, const Vec3&) {
      return std::vector<std::vector<Vec3>>{part};
    };
    return complaint(folder, "<mesh filename='a.obj'/>", options);
  };
  EXPECT_NE(with({}).find("hull of 0 corners"), std::string::npos);
  EXPECT_NE(with({{0, 0, std::nan("")}}).find("not finite"), std::string::npos);
  EXPECT_NE(with(std::vector<Vec3>(10'001, Vec3::Zero())).find("allowed: 1 to 10000"),
            std::string::npos);
}

/// A COLLADA triangle in centimetres with Y up.
constexpr const char* dae =
    "<?xml version='1.0'?><COLLADA xmlns='http://www.collada.org/2005/11/COLLADASchema' "
    "version='1.4.1'><asset><unit name='cm' meter='0.01'/><up_axis>Y_UP</up_axis></asset>"
    "<library_geometries><geometry id='g'><mesh><source id='p'><float_array id='a' count='9'>"
    "0 0 0 100 0 0 0 200 0</float_array><technique_common><accessor source='#a' count='3' "
    "stride='3'><param name='X' type='float'/><param name='Y' type='float'/><param name='Z' "
    "type='float'/></accessor></technique_common></source><vertices id='v'><input "
    "semantic='POSITION' source='#p'/></vertices><triangles count='1'><input semantic='VERTEX' "
    "source='#v' offset='0'/><p>0 1 2</p></triangles></mesh></geometry></library_geometries>"
    "<library_visual_scenes><visual_scene id='s'><node id='n'><instance_geometry url='#g'/>"
    "</node></visual_scene></library_visual_scenes><scene><instance_visual_scene url='#s'/>"
    "</scene></COLLADA>";

TEST(Mesh, OfColladaKeepsItsUnitAndNotItsUpDirection) {
  if (!reads_meshes()) GTEST_SKIP() << "built without assimp";
  const Folder folder;
  put(folder, "robot/urdf/a.dae", dae);
  const Robot robot = load(folder, "<mesh filename='a.dae'/>");
  const std::vector<Vec3>& points = robot.parts[0].points;
  ASSERT_EQ(points.size(), 3U) << "flat: all of its points";
  const Vec3 largest = points[0].cwiseMax(points[1]).cwiseMax(points[2]);
  EXPECT_LT((largest - Vec3(1, 2, 0)).norm(), 1e-6) << largest;
}

TEST(Mesh, OfAPackageIsFoundWhereverItMayBe) {
  if (!reads_meshes()) GTEST_SKIP() << "built without assimp";
  const std::string mesh = "<mesh filename='package://the_arm/meshes/a.obj'/>";
  const std::string manifest = "<package><name>the_arm</name></package>";
  {
    const Folder folder;  // the package beside that of the file
    put(folder, "the_arm/meshes/a.obj", obj);
    EXPECT_EQ(load(folder, mesh).parts.size(), 1U);
  }
  {
    const Folder folder;  // the file is in the package, whose folder has another name
    put(folder, "robot/package.xml", manifest);
    put(folder, "robot/meshes/a.obj", obj);
    EXPECT_EQ(load(folder, mesh).parts.size(), 1U);
  }
  const Folder folder;
  put(folder, "else/where/share/the_arm/meshes/a.obj", obj);
  put(folder, "renamed/meshes/a.obj", obj);
  for (const char* path : {"else", "else/where/share", "else/where/share/the_arm", "renamed"}) {
    UrdfOptions options;
    options.package_paths = {folder / "nowhere", folder / path};
    EXPECT_EQ(load(folder, mesh, options).parts.size(), 1U) << path;
  }
  const std::string refused = complaint(folder, mesh, {.package_paths = {folder / "nowhere"}});
  for (const std::string& words :
       {std::string("link 'arm'"), std::string("package://the_arm/meshes/a.obj"),
        folder / "nowhere", std::string("not found")}) {
    EXPECT_NE(refused.find(words), std::string::npos) << refused;
  }
}

TEST(Mesh, ThatCannotBeReadIsRefusedWithItsLinkAndTheReason) {
  const Folder folder;
  put(folder, "robot/urdf/empty.stl", "solid\nfacet ha\n");
  put(folder, "robot/urdf/notes.txt", "not a mesh\n");
  const auto expect_words = [&](const std::string& file, const std::string& words) {
    const std::string refused = complaint(folder, "<mesh filename='" + file + "'/>");
    EXPECT_NE(refused.find("link 'arm': mesh '"), std::string::npos) << refused;
    EXPECT_NE(refused.find(words), std::string::npos) << refused;
  };
  expect_words("no.stl", "'no.stl' is not a file");
  expect_words("http://host/a.stl", "package://NAME/PATH");
  const std::string without = "apt-get install libassimp-dev";
  expect_words("empty.stl", reads_meshes() ? "holds no corner" : without);
  expect_words("notes.txt", reads_meshes() ? "cannot be read" : without);
}

}  // namespace mesh_test
}  // namespace repel
