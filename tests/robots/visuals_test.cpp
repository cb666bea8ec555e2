// SPDX-License-Identifier: BSD-3-Clause
// What a robot looks like: <visual> elements, which are never a reason to refuse it.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include <repel/base/setup_error.hpp>
#include <repel/reduction/separation.hpp>
#include <repel/robots/parts.hpp>
#include <repel/robots/urdf.hpp>
#include <repel/robots/visuals.hpp>
#include <repel/world/kinematics.hpp>

#include "arms.hpp"
#include "end_to_end/folder.hpp"

namespace repel {
namespace visuals_test {

using test::Folder;

const std::string head = "<robot name='r'>\n";
const std::string joint =
    "<joint name='j' type='continuous'><parent link='base'/><child link='arm'/>"
    "<origin xyz='0 0 1'/></joint>\n";

std::string link(const std::string& name, const std::string& content = "") {
  return "<link name='" + name + "'>" + content + "</link>\n";
}
std::string visual(const std::string& geometry, const std::string& more = "") {
  return "<visual>" + more + "<geometry>" + geometry + "</geometry></visual>";
}
std::string collision(const std::string& geometry) {
  return "<collision name='c'><geometry>" + geometry + "</geometry></collision>";
}

RobotVisuals visuals_of(const std::string& content) {
  const std::string urdf = head + content + joint + "</robot>";
  return parse_visuals(urdf, parse_arm(urdf));
}

/// Extent of a mesh [m].
Vec3 size_of(const TriangleMesh& mesh) {
  Vec3 low = mesh.vertices.front();
  Vec3 high = low;
  for (const Vec3& p : mesh.vertices) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return high - low;
}

TEST(Visuals, AreEachGeometryInItsPlace) {
  const struct {
    const char* geometry;
    Vec3 size;
  } cases[] = {{"<box size='0.1 0.2 0.3'/>", {0.1, 0.2, 0.3}},
               {"<sphere radius='0.5'/>", {1.0, 1.0, 1.0}},
               {"<cylinder radius='0.5' length='3'/>", {1.0, 1.0, 3.0}},
               {"<capsule radius='0.5' length='3'/>", {1.0, 1.0, 4.0}}};
  for (const auto& expected : cases) {
    const RobotVisuals read = visuals_of(
        link("base") + link("arm", visual(expected.geometry,
                                          "<origin xyz='1 2 3' rpy='0 0 1.5707963267948966'/>")));
    EXPECT_TRUE(read.warnings.empty());
    ASSERT_EQ(read.all.size(), 1U) << expected.geometry;
    const RobotVisual& only = read.all[0];
    EXPECT_EQ(only.in_link, "arm");
    EXPECT_EQ(only.link, 0);
    EXPECT_EQ(only.collision, "");
    EXPECT_FALSE(only.color);
    EXPECT_LT((only.X_LV.translation() - Vec3(1, 2, 3)).norm(), 1e-12);
    EXPECT_LT((only.X_LV.linear() * Vec3::UnitX() - Vec3::UnitY()).norm(), 1e-12);
    EXPECT_LT((size_of(only.mesh) - expected.size).norm(), 0.02) << expected.geometry;
    EXPECT_FALSE(only.mesh.triangles.empty());
  }
}

TEST(Visuals, HaveTheColourOfTheirMaterial) {
  const std::string box = "<box size='1 1 1'/>";
  const RobotVisuals read = visuals_of(
      "<material name='blue'><color rgba='0 0 1 1'/></material>\n" +
      link("base",
           visual(box, "<material name='own'><color rgba='0.25 0.5 0.75 0.5'/></material>") +
               visual(box, "<material name='blue'/>") + visual(box, "<material name='nowhere'/>")) +
      link("arm", visual(box, "<material name='own'/>") +
                      visual(box, "<material name='bad'><color rgba='1 1 nan 1'/></material>")));
  using Color = std::array<double, 4>;
  ASSERT_EQ(read.all.size(), 5U);
  EXPECT_EQ(read.all[0].color, (Color{0.25, 0.5, 0.75, 0.5}));
  EXPECT_EQ(read.all[1].color, (Color{0, 0, 1, 1})) << "of the file";
  EXPECT_FALSE(read.all[2].color);
  EXPECT_EQ(read.all[3].color, (Color{0.25, 0.5, 0.75, 0.5})) << "of another link";
  EXPECT_FALSE(read.all[4].color);
}

TEST(Visuals, BehindFixedJointsGoWithTheirParents) {
  const std::string box = visual("<box size='1 1 1'/>");
  const std::string fixed =
      "<joint name='f' type='fixed'><parent link='base'/>"
      "<child link='column'/><origin xyz='0 0 0.5'/></joint>"
      "<joint name='g' type='fixed'><parent link='arm'/>"
      "<child link='flange'/><origin xyz='0.25 0 0'/></joint>";
  const RobotVisuals read = visuals_of(link("base", box) + link("column", box) + link("arm", box) +
                                       link("flange", box) + fixed);
  ASSERT_EQ(read.all.size(), 4U);
  const auto of = [&](const std::string& name) {
    return *std::find_if(read.all.begin(), read.all.end(),
                         [&](const RobotVisual& v) { return v.in_link == name; });
  };
  EXPECT_EQ(of("base").link, -1);
  EXPECT_EQ(of("column").link, -1);
  EXPECT_EQ(of("column").X_LV.translation(), Vec3(0, 0, 0.5));
  EXPECT_EQ(of("arm").link, 0);
  EXPECT_EQ(of("flange").link, 0);
  EXPECT_EQ(of("flange").X_LV.translation(), Vec3(0.25, 0, 0));
}

TEST(Visuals, AreTheCollisionPartsOfALinkWithoutAny) {
  const RobotVisuals read =
      visuals_of(link("base", collision("<sphere radius='0.5'/>")) +
                 link("arm", collision("<sphere radius='2'/>") + visual("<box size='1 1 1'/>")));
  ASSERT_EQ(read.all.size(), 2U);
  EXPECT_EQ(read.all[0].in_link, "base");
  EXPECT_EQ(read.all[0].link, -1);
  EXPECT_EQ(read.all[0].collision, "c");
  EXPECT_NEAR(size_of(read.all[0].mesh).z(), 1.0, 1e-9);
  EXPECT_EQ(read.all[1].collision, "") << "its visual";
}

TEST(Visuals, ThatCannotBeReadAreWarningsWithALine) {
  const char* const bad[] = {"<box size='1 1'/>",
                             "<box size='1 1 inf'/>",
                             "<sphere radius='-1'/>",
                             "<cylinder radius='1'/>",
                             "<cone radius='1'/>",
                             "",
                             "<mesh filename='none.stl'/>",
                             "<mesh/>",
                             "<mesh filename='a' scale='x'/>",
                             "<mesh filename='package://nobody/a.dae'/>"};
  for (const std::string geometry : bad) {
    const RobotVisuals read = visuals_of(
        link("base") + link("arm", visual(geometry) + collision("<sphere radius='0.5'/>")));
    ASSERT_EQ(read.warnings.size(), 1U) << geometry;
    EXPECT_EQ(read.warnings[0].rfind("urdf:3: ", 0), 0U) << read.warnings[0];
    ASSERT_EQ(read.all.size(), 1U) << geometry;
    EXPECT_EQ(read.all[0].collision, "c") << "what is left to show";
  }
  const std::string pose = "<origin xyz='0 0 1e99'/>";
  EXPECT_EQ(
      visuals_of(link("base") + link("arm", visual("<sphere radius='1'/>", pose))).warnings.size(),
      1U);
  const std::string twice = "<material name='m'/><material name='m'/>";
  EXPECT_TRUE(visuals_of(twice + link("base") + link("arm")).all.empty());
}

TEST(Visuals, OfAFileThatDoesNotExistAreRefused) {
  EXPECT_THROW((void)load_visuals("none.urdf", Robot{}), SetupError);
}

/// A ball of 4 n^2 triangles or a little less.
std::string ball(int n) {
  std::string text;
  for (int i = 0; i <= n; ++i) {
    for (int k = 0; k < 2 * n; ++k) {
      const double a = std::numbers::pi * i / n;
      const double b = std::numbers::pi * k / n;
      text += "v " + std::to_string(std::sin(a) * std::cos(b)) + " " +
              std::to_string(std::sin(a) * std::sin(b)) + " " + std::to_string(std::cos(a)) + "\n";
    }
  }
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < 2 * n; ++k) {
      const auto at = [&](int ring, int step) {
        return std::to_string(1 + ring * 2 * n + step % (2 * n));
      };
      text += "f " + at(i, k) + " " + at(i + 1, k) + " " + at(i + 1, k + 1) + "\n";
      text += "f " + at(i, k) + " " + at(i + 1, k + 1) + " " + at(i, k + 1) + "\n";
    }
  }
  return text;
}

RobotVisuals visuals_in(const Folder& folder, const std::string& content) {
  const std::string path = folder.with("r.urdf", head + content + joint + "</robot>");
  return load_visuals(path, load_arm(path));
}

TEST(Visuals, OfMeshesAreTheirTrianglesScaled) {
  if (!reads_meshes()) GTEST_SKIP() << "built without assimp";
  const Folder folder;
  (void)folder.with("a.obj", "v 0 0 0\nv 2 0 0\nv 0 3 0\nv 0 0 4\nf 1 2 3\nf 1 2 4\n");
  const RobotVisuals read =
      visuals_in(folder, link("base") + link("arm", visual("<mesh filename='a.obj' "
                                                           "scale='0.5 -1 0.25'/>")));
  ASSERT_EQ(read.all.size(), 1U);
  EXPECT_TRUE(read.warnings.empty());
  EXPECT_EQ(read.all[0].mesh.triangles.size(), 2U) << "as it is, and no hull";
  EXPECT_EQ(size_of(read.all[0].mesh), Vec3(1, 3, 1));
}

TEST(Visuals, OfLargeMeshesAreSimplifiedWithAWord) {
  if (!reads_meshes()) GTEST_SKIP() << "built without assimp";
  const Folder folder;
  (void)folder.with("ball.obj", ball(500));  // a million
  (void)folder.with("small.obj", ball(10));
  const RobotVisuals read =
      visuals_in(folder, link("base", visual("<mesh filename='ball.obj'/>")) +
                             link("arm", visual("<mesh filename='ball.obj' scale='2 2 2'/>") +
                                             visual("<mesh filename='small.obj'/>")));
  ASSERT_EQ(read.all.size(), 3U);
  ASSERT_EQ(read.warnings.size(), 3U);
  for (const std::size_t of_mesh : {0U, 1U}) {
    for (const char* const word : {"ball.obj' is shown by ", " of 1000000 triangles"}) {
      EXPECT_NE(read.warnings[of_mesh].find(word), std::string::npos) << read.warnings[of_mesh];
    }
  }
  EXPECT_NE(read.warnings[2].find(std::to_string(most_visual_triangles)), std::string::npos);
  std::size_t triangles = 0;
  for (const RobotVisual& each : read.all) triangles += each.mesh.triangles.size();
  EXPECT_LE(triangles, most_visual_triangles);
  EXPECT_GT(triangles, most_visual_triangles / 4) << "no coarser than it must be";
  EXPECT_LT((size_of(read.all[0].mesh) - Vec3(2, 2, 2)).norm(), 0.1);
  for (const RobotVisual& each : read.all) {
    for (const auto& triangle : each.mesh.triangles) {
      for (const int vertex : triangle) {
        EXPECT_LT(static_cast<std::size_t>(vertex), each.mesh.vertices.size());
      }
    }
  }
}

TEST(Visuals, OfHostileMeshFilesAreLeftOut) {
  if (!reads_meshes()) GTEST_SKIP() << "built without assimp";
  const std::string texts[] = {"", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
                               "v 0 0 0\nf 1 2 99999999\n", std::string(1000, '\xff'), "v 1 2 3\n"};
  for (const std::string& text : texts) {
    const Folder folder;
    (void)folder.with("bad.obj", text);
    const RobotVisuals read =
        visuals_in(folder, link("base") + link("arm", visual("<mesh filename='bad.obj'/>")));
    EXPECT_TRUE(read.all.empty()) << text.substr(0, 40);
    EXPECT_EQ(read.warnings.size(), 1U);
  }
}

// The reader of PLY does not look whether a face names vertices that there are.
TEST(Visuals, OfAMeshWhoseFacesNameVerticesThatItHasNotAreLeftOut) {
  if (!reads_meshes()) GTEST_SKIP() << "built without assimp";
  const std::string ply = test::text_of("tests/fuzz/seeds/triangle_of_none.ply");
  for (const char* const vertex : {"3", "1000000", "2147483647", "4294967295", "-1"}) {
    const Folder folder;
    std::string text = ply;
    (void)folder.with("a.ply", text.replace(text.find("1000000"), 7, vertex));
    const std::string mesh = "<mesh filename='a.ply'/>";
    const RobotVisuals read = visuals_in(folder, link("base") + link("arm", visual(mesh)));
    EXPECT_TRUE(read.all.empty()) << vertex;
    ASSERT_EQ(read.warnings.size(), 1U) << vertex;
    EXPECT_NE(read.warnings[0].find("a.ply"), std::string::npos) << read.warnings[0];
  }
}

/// A pose of the standard set; the other one has 180 degrees less in joint 2 and more in joint 3.
std::array<double, 6> pose_of(const std::string& file) {
  const double turn = file == test::puma_files[1] ? std::numbers::pi : 0.0;
  return {0.3, 0.8 - turn, -2.5 + turn, 0.4, -0.7, 0.2};
}

/// The points of what an arm looks like, in the world [m].
std::vector<Vec3> points_of(const RobotVisuals& visuals, const Kinematics& kinematics) {
  std::vector<Vec3> points;
  for (const RobotVisual& each : visuals.all) {
    const Pose X_WL = each.link < 0 ? Pose::Identity() : kinematics.X_WL(each.link);
    for (const Vec3& p : each.mesh.vertices) points.push_back(X_WL * each.X_LV * p);
  }
  return points;
}

TEST(Visuals, OfThePumaAreCloseToWhatCollides) {
  if (!reads_meshes()) GTEST_SKIP() << "built without assimp";
  for (const std::string& file : test::puma_files) {
    const Robot robot = load_arm(file);
    RobotVisuals read = load_visuals(file, robot);
    EXPECT_TRUE(read.warnings.empty());
    std::size_t triangles = 0;
    for (const RobotVisual& each : read.all) {
      EXPECT_EQ(each.collision, "") << each.in_link;
      EXPECT_TRUE(each.color) << each.in_link;
      triangles += each.mesh.triangles.size();
    }
    EXPECT_LT(triangles, 15'000U);
    // The foot flares out, and nothing of it is a part of the world.
    std::erase_if(read.all, [](const RobotVisual& each) { return each.link < 0; });
    Kinematics kinematics(robot.arm);
    kinematics.update(pose_of(file));
    const Shape point = Shape::sphere(0.0);
    for (const Vec3& p : points_of(read, kinematics)) {
      double nearest = std::numeric_limits<double>::infinity();
      for (const RobotPart& part : robot.parts) {
        const Pose X_WL = part.link < 0 ? Pose::Identity() : kinematics.X_WL(part.link);
        Pose X_WP = Pose::Identity();
        X_WP.translation() = p;
        const Pose X = X_WL * part.X_LP;
        nearest =
            std::min(nearest, separation(point, X_WP, shape_of(part, {.levels = 1}), X).distance);
      }
      ASSERT_LT(nearest, 0.006) << file << ": " << p.transpose();
    }
  }
}

TEST(Visuals, OfBothPumaFilesAreInTheSamePlaces) {
  if (!reads_meshes()) GTEST_SKIP() << "built without assimp";
  std::vector<std::vector<Vec3>> points;
  for (const std::string& file : test::puma_files) {
    const Robot robot = load_arm(file);
    Kinematics kinematics(robot.arm);
    kinematics.update(pose_of(file));
    points.push_back(points_of(load_visuals(file, robot), kinematics));
  }
  ASSERT_EQ(points[0].size(), points[1].size());
  for (std::size_t i = 0; i < points[0].size(); ++i) {
    ASSERT_LT((points[0][i] - points[1][i]).norm(), 0.002) << "their forearms differ by 1.3 mm";
  }
}

TEST(Visuals, OfTheLongReachArmAreItsGantryInItsColour) {
  const std::string path = "robots/long_reach.urdf";
  const RobotVisuals read = load_visuals(path, load_arm(path));
  EXPECT_EQ(read.warnings.empty(), reads_meshes());
  int beams = 0;
  for (const RobotVisual& each : read.all) {
    if (each.in_link != "gantry") continue;
    ++beams;
    EXPECT_EQ(each.link, -1);
    EXPECT_EQ(each.collision, "");
    EXPECT_TRUE(each.color);
  }
  EXPECT_EQ(beams, 4);
}

}  // namespace visuals_test
}  // namespace repel
