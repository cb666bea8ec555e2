// SPDX-License-Identifier: BSD-3-Clause
// Meshes and descriptions that would exhaust memory or time are refused with their size and the
// limit.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>

#include <repel/base/setup_error.hpp>
#include <repel/common/input_limits.hpp>
#include <repel/robots/read_mesh.hpp>
#include <repel/robots/urdf.hpp>

#include "end_to_end/folder.hpp"

namespace repel {
namespace mesh_limits_test {

using test::Folder;

std::string repeated(const std::string& text, std::size_t count) {
  std::string result;
  for (std::size_t i = 0; i < count; ++i) result += text;
  return result;
}

std::string robot_with(const std::string& in_link) {
  return "<robot name='r'><link name='base'/><link name='arm'>\n" + in_link +
         "</link>\n<joint name='j' type='continuous'><parent link='base'/>"
         "<child link='arm'/></joint></robot>\n";
}

std::string with_mesh(const std::string& attributes) {
  return "<collision><geometry><mesh " + attributes + "/></geometry></collision>\n";
}

void expect_refused(const Folder& folder, const std::string& in_link, const std::string& words) {
  try {
    (void)load_arm(folder.with("r.urdf", robot_with(in_link)));
    ADD_FAILURE() << "accepted";
  } catch (const SetupError& error) {
    EXPECT_GT(error.line(), 0);
    EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
  }
}

/// A binary STL file of facets with the corners corner(0), corner(1), ...
template <class Corner>
std::string stl_of(std::uint32_t facets, const Corner& corner) {
  std::string text(84 + std::size_t{50} * facets, '\0');
  std::memcpy(&text[80], &facets, sizeof facets);
  for (std::uint32_t i = 0; i < 3 * facets; ++i) {
    const std::array<float, 3> p = corner(i);
    std::memcpy(&text[96 + 50 * std::size_t{i / 3} + 12 * std::size_t{i % 3}], p.data(), sizeof p);
  }
  return text;
}

/// Reads it as a mesh by itself; the complaint, if it is refused.
std::string complaint_about(const std::string& path) {
  try {
    (void)read_mesh(path);
  } catch (const SetupError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(MeshLimits, AnStlFileOfAMillionTrianglesCountsEachVertexOnce) {
  if (!reads_meshes()) GTEST_SKIP() << "built without assimp";
  const Folder folder;
  constexpr std::uint32_t facets = 1'000'000;
  constexpr std::uint32_t row = 1000;
  const auto corner = [](std::uint32_t i) {
    const std::uint32_t place = i / 3 + (i % 3 == 1 ? 1 : 0) + (i % 3 == 2 ? row : 0);
    return std::array<float, 3>{static_cast<float>(place % row), static_cast<float>(place / row),
                                i % 2 == 0 ? 0.0F : -0.0F};
  };
  const TriangleMesh mesh = read_mesh(folder.with("a.stl", stl_of(facets, corner)));
  EXPECT_EQ(mesh.triangles.size(), facets);
  EXPECT_EQ(mesh.vertices.size(), facets + row);
  for (const int i : mesh.triangles.back()) {
    EXPECT_GE(mesh.vertices.at(static_cast<std::size_t>(i)).y(), 998.0);
  }
}

TEST(MeshLimits, AMeshOfTooManyDifferentVerticesIsRefused) {
  if (!reads_meshes()) GTEST_SKIP() << "built without assimp";
  const Folder folder;
  const auto corner = [](std::uint32_t i) {
    return std::array<float, 3>{static_cast<float>(i % 2000), static_cast<float>(i / 2000), 0.0F};
  };
  const std::string why = complaint_about(folder.with("a.stl", stl_of(666'668, corner)));
  EXPECT_NE(why.find("more than 2000000 different vertices; allowed: up to"), std::string::npos)
      << why;
}

TEST(MeshLimits, AMeshOfTooManyTrianglesIsRefused) {
  if (!reads_meshes()) GTEST_SKIP() << "built without assimp";
  const Folder folder;
  const auto corner = [](std::uint32_t i) {
    return std::array<float, 3>{static_cast<float>(i % 3), static_cast<float>(i % 2), 0.0F};
  };
  const std::string why = complaint_about(folder.with("a.stl", stl_of(4'000'001, corner)));
  EXPECT_NE(why.find("more than 4000000 triangles; allowed: up to"), std::string::npos) << why;
}

// assimp 5.2.5 loops for ever searching for the end of this header; found by fuzzing.
TEST(MeshLimits, APlyFileWhoseHeaderDoesNotEndIsRefused) {
  if (!reads_meshes()) GTEST_SKIP() << "built without assimp";
  const Folder folder;
  (void)folder.with("a.ply", test::text_of("tests/fuzz/seeds/endless.ply"));
  expect_refused(folder, with_mesh("filename='a.ply'"), "link 'arm': mesh '");
}

TEST(MeshLimits, AMeshOfTooManyBytesIsRefusedUnread) {
  if (!reads_meshes()) GTEST_SKIP() << "built without assimp";
  const Folder folder;
  std::filesystem::resize_file(folder.with("a.stl", "solid\n"), input_limits.mesh_bytes + 1);
  expect_refused(folder, with_mesh("filename='a.stl'"),
                 "268435457 bytes; allowed: up to 268435456");
}

TEST(MeshLimits, OneMeshIsReadOnceAndTooManyAreRefused) {
  if (!reads_meshes()) GTEST_SKIP() << "built without assimp";
  const Folder folder;
  std::string sphere;  // of 2500 corners
  for (int i = 0; i < 2500; ++i) {
    const double z = (i - 1249.5) / 1250.0;
    const double r = std::sqrt(1.0 - z * z);
    sphere += "v " + std::to_string(r * std::cos(2.4 * i)) + " " +
              std::to_string(r * std::sin(2.4 * i)) + " " + std::to_string(z) + "\n";
  }
  for (int i = 1; i <= 2500; i += 2) sphere += "f 1 " + std::to_string(i) + " 2500\n";
  for (int i = 2; i <= 2500; i += 2) sphere += "f 2 " + std::to_string(i) + " 2499\n";
  (void)folder.with("a.obj", sphere);
  const std::string mesh = with_mesh("filename='a.obj'");
  EXPECT_EQ(load_arm(folder.with("r.urdf", robot_with(repeated(mesh, 5)))).parts.size(), 5U);
  expect_refused(folder, repeated(mesh, 60), "corners; allowed: up to 100000 in all");
}

TEST(MeshLimits, ANameThatIsTooLongForAPathIsRefused) {
  const Folder folder;
  expect_refused(folder, with_mesh("filename='package://" + std::string(3000, 'n') + "/a.stl'"),
                 "is not found");
  expect_refused(folder, with_mesh("filename='" + std::string(4000, 'n') + "'"), "is not a file");
}

TEST(MeshLimits, TextsAttributesAndCollisionsOfADescriptionAreLimited) {
  const Folder folder;
  expect_refused(folder, "<collision name='" + std::string(5000, 'n') + "'/>",
                 "'name' has 5000 bytes; allowed: up to 4096");
  std::string many = "<collision";
  for (int i = 0; i < 65; ++i) many += " a" + std::to_string(i) + "='1'";
  expect_refused(folder, many + "/>", "more than 64 attributes of one element");
  expect_refused(folder, repeated("<collision/>", 10'001), "more than 10000 collisions");
  expect_refused(folder, repeated("<x/>", 500'000), "more than 500000 elements");
}

}  // namespace mesh_limits_test
}  // namespace repel
