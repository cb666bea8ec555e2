// SPDX-License-Identifier: BSD-3-Clause
// Models and worlds from SDF files, as parts that stand still.
#include <repel/robots/sdf.hpp>

#include <gtest/gtest.h>

#include <sys/stat.h>

#include <filesystem>
#include <numbers>

#include <repel/base/setup_error.hpp>
#include <repel/robots/parts.hpp>
#include <repel/robots/urdf.hpp>

#include "end_to_end/folder.hpp"

namespace repel {
namespace sdf_test {

using test::Folder;

/// A table with a post that is placed relative to it; `more` is in the model.
std::string table(const std::string& more = "") {
  return "<model name='cell'><pose>1 0 0 0 0 1.5707963267948966</pose>\n"
         "<link name='table'><pose>0 0 1 0 0 0</pose>\n"
         "<collision name='plate'><pose>0 0 0.1 0 0 0</pose><geometry><box><size>0.6 0.8 0.05"
         "</size></box></geometry></collision></link>\n"
         "<link name='side'><pose relative_to='table'>0 0.3 0 0 0 0</pose>\n"
         "<collision name='post'><geometry><cylinder><radius>0.1</radius><length>1</length>"
         "</cylinder></geometry></collision>\n"
         "<collision name='ball'><geometry><sphere><radius>0.2</radius></sphere></geometry>"
         "</collision>\n"
         "<collision name='pill'><geometry><capsule><radius>0.1</radius><length>0.4</length>"
         "</capsule></geometry></collision>\n"
         "<collision name='egg'><geometry><ellipsoid><radii>0.1 0.2 0.3</radii></ellipsoid>"
         "</geometry></collision></link>\n" +
         more + "</model>";
}

std::string file_of(const Folder& folder, const std::string& content) {
  return folder.with("cell.sdf", "<?xml version='1.0'?><sdf version='1.9'>" + content + "</sdf>\n");
}

std::string complaint(const std::string& path) {
  try {
    (void)load_sdf_parts(path);
  } catch (const SetupError& error) {
    return error.what();
  }
  return "accepted";
}

bool says(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

class Sdf : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!reads_sdf()) GTEST_SKIP() << "built without libsdformat";
  }

  Folder folder_;
};

TEST_F(Sdf, HasTheShapesOfAModelWhereItsFramesPutThem) {
  const std::vector<RobotPart> parts = load_sdf_parts(file_of(folder_, table()));
  ASSERT_EQ(parts.size(), 5U);
  EXPECT_EQ(parts[0].name, "plate");
  EXPECT_EQ(parts[0].in_link, "cell::table");
  EXPECT_EQ(parts[0].link, -1);
  EXPECT_EQ(parts[0].kind, PartKind::box);
  EXPECT_LT((parts[0].size - Vec3(0.3, 0.4, 0.025)).norm(), 1e-12);
  EXPECT_LT((parts[0].X_LP.translation() - Vec3(1, 0, 1.1)).norm(), 1e-12);
  EXPECT_LT((parts[0].X_LP.linear() * Vec3::UnitX() - Vec3::UnitY()).norm(), 1e-12);
  EXPECT_EQ(parts[1].in_link, "cell::side");
  EXPECT_EQ(parts[1].kind, PartKind::cylinder);
  EXPECT_LT((parts[1].size - Vec3(0.1, 0.5, 0)).norm(), 1e-12);
  EXPECT_LT((parts[1].X_LP.translation() - Vec3(0.7, 0, 1)).norm(), 1e-12)
      << "relative to the table, in the turned model";
  EXPECT_EQ(parts[2].kind, PartKind::sphere);
  EXPECT_EQ(parts[2].size.x(), 0.2);
  EXPECT_EQ(parts[3].kind, PartKind::capsule);
  EXPECT_LT((parts[3].size - Vec3(0.1, 0.2, 0)).norm(), 1e-12);
  EXPECT_EQ(parts[4].kind, PartKind::ellipsoid);
  EXPECT_EQ(parts[4].size, Vec3(0.1, 0.2, 0.3));
  EXPECT_EQ(shape_of(parts[4]).reach(), 0.3);
}

TEST_F(Sdf, HasAllModelsOfAWorldAlsoNestedAndIncludedOnes) {
  std::filesystem::create_directories(folder_ / "stool");
  (void)folder_.with("stool/model.config",
                     "<model><name>stool</name><version>1</version>"
                     "<sdf version='1.9'>model.sdf</sdf></model>");
  (void)folder_.with("stool/model.sdf",
                     "<sdf version='1.9'><model name='stool'><link name='seat'>"
                     "<collision name='c'><geometry><sphere><radius>0.1</radius></sphere>"
                     "</geometry></collision></link></model></sdf>");
  const std::string nested =
      "<model name='inner'><pose>0 0 2 0 0 0</pose><link name='l'><collision name='c'><geometry>"
      "<sphere><radius>0.3</radius></sphere></geometry></collision></link></model>";
  const std::string path =
      file_of(folder_, "<world name='w'>" + table(nested) +
                           "<include><uri>model://stool</uri><name>left</name>"
                           "<pose relative_to='cell'>0 1 0 0 0 0</pose></include></world>");
  const std::vector<RobotPart> parts = load_sdf_parts(path);
  ASSERT_EQ(parts.size(), 7U);
  EXPECT_EQ(parts[5].in_link, "cell::inner::l");
  EXPECT_LT((parts[5].X_LP.translation() - Vec3(1, 0, 2)).norm(), 1e-12);
  EXPECT_EQ(parts[6].in_link, "left::seat");
  EXPECT_LT((parts[6].X_LP.translation() - Vec3(0, 0, 0)).norm(), 1e-12);
}

TEST_F(Sdf, GivesMeshesTheirConvexParts) {
  (void)folder_.with("a.stl", "not read");
  const std::string path =
      file_of(folder_,
              "<model name='m'><link name='l'><collision name='c'><geometry><mesh><uri>a.stl</uri>"
              "<scale>2 3 4</scale></mesh></geometry></collision></link></model>");
  UrdfOptions options;
  options.convex_parts = [&](const std::string& mesh, const Vec3& scale) {
    EXPECT_EQ(std::filesystem::path(mesh).filename(), "a.stl");
    EXPECT_EQ(scale, Vec3(2, 3, 4));
    const std::vector<Vec3> hull{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    return std::vector{hull, hull};
  };
  const std::vector<RobotPart> parts = load_sdf_parts(path, options);
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts[0].name, "c/1");
  EXPECT_EQ(parts[1].name, "c/2");
  EXPECT_TRUE(parts[1].is_of_cover);
  EXPECT_EQ(parts[1].points.size(), 4U);
}

TEST_F(Sdf, WhatCannotBeAPartIsRefusedWithItsLine) {
  const auto with = [&](const std::string& geometry) {
    return complaint(file_of(folder_, table("<link name='l'><collision name='odd'><geometry>" +
                                            geometry + "</geometry></collision></link>")));
  };
  const std::string plane = with("<plane><normal>0 0 1</normal><size>1 1</size></plane>");
  EXPECT_TRUE(says(plane, "cell.sdf:9: collision 'odd': a plane has no end")) << plane;
  const std::string odd = with(
      "<polyline><point>0 0</point><point>1 0</point><point>0 1</point>"
      "<height>1</height></polyline>");
  EXPECT_TRUE(says(odd, "cell.sdf:9: collision 'odd': allowed: a box")) << odd;
  const std::string number = with("<sphere><radius>wide</radius></sphere>");
  EXPECT_TRUE(says(number, "cell.sdf:9: ")) << number;
  EXPECT_TRUE(says(number, "radius")) << number;
  const std::string mesh = with("<mesh><uri>none.stl</uri></mesh>");
  EXPECT_TRUE(says(mesh, "cell.sdf:9: ") && says(mesh, "none.stl")) << mesh;
  const std::string part = with("<mesh><uri>a.stl</uri><submesh><name>leg</name></submesh></mesh>");
  EXPECT_TRUE(says(part, "cell.sdf:9: ") && says(part, "submesh, 'leg'")) << part;
}

TEST_F(Sdf, FilesThatAreNoneAreRefused) {
  EXPECT_TRUE(says(complaint(file_of(folder_, "<model")), "cell.sdf:1: "));
  const std::string urdf = complaint(folder_.with("r.sdf", "<robot name='r'/>"));
  EXPECT_TRUE(says(urdf, "r.sdf:1: the file begins with <robot>; allowed: <sdf>")) << urdf;
  const std::string frame = complaint(file_of(
      folder_, "<model name='m'><link name='l'><pose relative_to='nowhere'/></link></model>"));
  EXPECT_TRUE(says(frame, "cell.sdf") && says(frame, "nowhere")) << frame;
  EXPECT_TRUE(says(complaint(folder_ / "none.sdf"), "none.sdf"));
  const std::string worlds =
      complaint(file_of(folder_, "<world name='a'></world><world name='b'></world>"));
  EXPECT_TRUE(says(worlds, "2 worlds; allowed: 1")) << worlds;
}

TEST_F(Sdf, FilesWithoutAnElementAreRefused) {
  for (const char* const text : {"", "<!-- -->", "<?xml version='1.0'?>\n", "words"}) {
    const std::string why = complaint(folder_.with("empty.sdf", text));
    EXPECT_TRUE(says(why, "empty.sdf")) << text << ": " << why;
  }
}

// libsdformat would go on until all memory is taken.
TEST_F(Sdf, FilesThatIncludeThemselvesAreRefused) {
#ifdef REPEL_SANITIZED
  GTEST_SKIP() << "a sanitizer may reserve the address space";
#endif
  const std::string path = folder_ / "cell.sdf";
  const std::string why = complaint(
      file_of(folder_, "<model name='m'><include><uri>" + path + "</uri></include></model>"));
  EXPECT_TRUE(says(why, "cell.sdf: the file, with all that it includes, ")) << why;
}

TEST_F(Sdf, IncludedPipesAndDevicesAreNotOpened) {
  const std::string pipe = folder_ / "pipe.sdf";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  std::filesystem::create_symlink("/dev/zero", folder_ / "zero.sdf");
  for (const char* const name : {"pipe.sdf", "zero.sdf"}) {
    const std::string why =
        complaint(file_of(folder_, "<world name='w'><include><uri>" + std::string(name) +
                                       "</uri></include></world>"));
    EXPECT_TRUE(says(why, "cell.sdf") && says(why, name)) << why;
  }
}

TEST(WithoutSdformat, FilesAreRefusedWithTheLineThatInstallsIt) {
  if (reads_sdf()) GTEST_SKIP() << "built with libsdformat";
  EXPECT_TRUE(says(complaint("cell.sdf"), "apt-get install libsdformat-dev"));
}

}  // namespace sdf_test
}  // namespace repel
