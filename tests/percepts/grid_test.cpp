// SPDX-License-Identifier: BSD-3-Clause
#include <repel/octrees/grid.hpp>

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <random>

#include <repel/base/setup_error.hpp>

namespace repel::octrees {
namespace grid_test {

octomap::OcTreeKey key_at(int x, int y, int z) {
  const auto key = [](int cube) { return static_cast<octomap::key_type>(cube + 32768); };
  return {key(x), key(y), key(z)};
}

TEST(Grid, IsWhatTheTreeSaysOfEveryCube) {
  constexpr unsigned seed = 40;
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> place(-9, 9);
  const cover::CubeRange range{{-7, -8, -5}, {6, 7, 8}};
  int occupied = 0;
  int unseen = 0;
  for (int draw = 0; draw < 10; ++draw) {
    octomap::OcTree tree(0.1);
    for (int block = 0; block < 30; ++block) {
      // Whole octants become one leaf, single cubes stay what they are.
      const int edge = block % 3 == 0 ? 4 : 1;
      const std::array<int, 3> at{place(random) / edge * edge, place(random) / edge * edge,
                                  place(random) / edge * edge};
      for (int i = 0; i < edge * edge * edge; ++i) {
        (void)tree.setNodeValue(
            key_at(at[0] + i % edge, at[1] + i / edge % edge, at[2] + i / (edge * edge)),
            block % 2 == 0 ? 2.0F : -2.0F);
      }
    }
    tree.prune();
    for (const bool is_unseen_solid : {false, true}) {
      const cover::OccupancyGrid grid = grid_of(tree, range, is_unseen_solid);
      EXPECT_EQ(grid.edge, 0.1);
      EXPECT_TRUE(grid.low.isApprox(Vec3(-0.7, -0.8, -0.5), 1e-12));
      for (int z = range.low[2]; z <= range.high[2]; ++z) {
        for (int y = range.low[1]; y <= range.high[1]; ++y) {
          for (int x = range.low[0]; x <= range.high[0]; ++x) {
            const octomap::OcTreeNode* const node = tree.search(key_at(x, y, z));
            const bool solid = node == nullptr ? is_unseen_solid : tree.isNodeOccupied(node);
            const std::size_t at = grid.place(x - range.low[0], y - range.low[1], z - range.low[2]);
            ASSERT_EQ(grid.solid[at] != 0, solid) << "seed " << seed << ", draw " << draw;
            occupied += node != nullptr && solid ? 1 : 0;
            unseen += node == nullptr ? 1 : 0;
          }
        }
      }
    }
  }
  EXPECT_GT(occupied, 500);
  EXPECT_GT(unseen, 500);
}

TEST(Grid, OfNothingIsEmpty) {
  const octomap::OcTree tree(0.1);
  const cover::OccupancyGrid grid = grid_of(tree, {{0, 0, 0}, {1, 1, 1}}, false);
  EXPECT_EQ(grid.solid, std::vector<std::uint8_t>(8, 0));
}

TEST(Grid, HasTheCubesOfARegion) {
  const cover::CubeRange range = cubes_in({{-0.25, 0.0, 0.1}, {0.05, 0.2, 0.35}}, 0.1);
  EXPECT_EQ(range, (cover::CubeRange{{-3, 0, 1}, {0, 1, 3}}));
  EXPECT_THROW((void)cubes_in({{0, 0, 0}, {-1, 1, 1}}, 0.1), SetupError);
  EXPECT_THROW((void)cubes_in({{0, 0, 0}, {5000, 1, 1}}, 0.1), SetupError);
  try {
    (void)cubes_in({{-2, -2, -2}, {2, 2, 2}}, 0.01);
    FAIL() << "not refused";
  } catch (const SetupError& error) {
    EXPECT_NE(std::string(error.what()).find("6.4e+07 cubes"), std::string::npos) << error.what();
  }
}

TEST(Grid, OfAFileIsThatOfItsTree) {
  octomap::OcTree tree(0.05);
  (void)tree.updateNode(key_at(3, -2, 5), true);
  (void)tree.updateNode(key_at(-1, 0, 2), false);
  EXPECT_EQ(known_range(tree), (cover::CubeRange{{-1, -2, 2}, {3, 0, 5}}));
  for (const char* ending : {".bt", ".ot"}) {
    const std::string path = testing::TempDir() + "repel_grid_test" + ending;
    ASSERT_TRUE(ending == std::string(".bt") ? tree.writeBinary(path) : tree.write(path));
    const auto again = read_tree(path);
    EXPECT_EQ(known_range(*again), known_range(tree));
    EXPECT_EQ(grid_of(*again, known_range(tree), false).solid,
              grid_of(tree, known_range(tree), false).solid);
    (void)std::remove(path.c_str());
    EXPECT_THROW((void)read_tree(path), SetupError);
  }
}

/// Of a file with this head and these bytes behind it, which are of a chain of nodes.
std::string refusal(const std::string& name, const std::string& bytes,
                    const std::string& res = "0.1") {
  const std::string path = testing::TempDir() + "repel_grid_test_" + name;
  const bool is_binary = path.ends_with(".bt");
  std::ofstream(path, std::ios::binary)
      << "# Octomap OcTree " << (is_binary ? "binary " : "") << "file\nid OcTree\nsize "
      << bytes.size() / 2 + 1 << "\nres " << res << "\ndata\n"
      << bytes;
  std::string why = "accepted";
  try {
    (void)read_tree(path);
  } catch (const SetupError& error) {
    why = error.what();
    EXPECT_NE(why.find("map '" + path + "'"), std::string::npos) << why;
  }
  (void)std::remove(path.c_str());
  return why;
}

std::string repeated(const std::string& node, int times) {
  std::string bytes;
  for (int i = 0; i < times; ++i) bytes += node;
  return bytes;
}

// A chain of nodes that each have the next for their first child.
TEST(Grid, OfATreeThatIsDeeperThanItsKeysIsRefused) {
  const std::string inner("\3\0", 2);
  const std::string leaf("\2\0", 2);
  EXPECT_EQ(refusal("16.bt", repeated(inner, 15) + leaf), "accepted");
  for (const int depth : {17, 1000, 100'000}) {
    const std::string why = refusal("deep.bt", repeated(inner, depth - 1) + leaf);
    EXPECT_NE(why, "accepted") << depth;
    if (depth <= 1000) {
      EXPECT_NE(why.find("deeper than 16 levels"), std::string::npos) << why;
    }
  }
  const std::string with_child("\0\0\0\0\1", 5);
  const std::string without("\0\0\0\0\0", 5);
  EXPECT_EQ(refusal("16.ot", repeated(with_child, 16) + without), "accepted");
  EXPECT_NE(refusal("17.ot", repeated(with_child, 17) + without), "accepted");
  EXPECT_NE(refusal("deep.ot", repeated(with_child, 100'000) + without), "accepted");
}

TEST(Grid, OfATreeThatNoMapCanBeIsRefused) {
  const std::string leaf("\2\0", 2);
  for (const char* const res : {"0", "-0.1", "nan", "1e300", "1e-300"}) {
    EXPECT_NE(refusal("res.bt", leaf, res), "accepted") << res;
  }
  EXPECT_NE(refusal("nan.ot", std::string("\0\0\xc0\x7f\0", 5)).find("not finite"),
            std::string::npos);
}

// OctoMap goes on with what happens to be in memory where a file ends.
TEST(Grid, OfAFileThatIsCutOffOrDamagedNeverCrashes) {
  constexpr unsigned seed = 18;
  std::mt19937 random(seed);
  octomap::OcTree tree(0.1);
  for (int i = 0; i < 60; ++i) {
    (void)tree.updateNode(
        key_at(static_cast<int>(random() % 40), 3, static_cast<int>(random() % 9)),
        random() % 2 == 0);
  }
  for (const char* ending : {".bt", ".ot"}) {
    const std::string path = testing::TempDir() + "repel_grid_damage" + ending;
    ASSERT_TRUE(ending == std::string(".bt") ? tree.writeBinary(path) : tree.write(path));
    std::ifstream stream(path, std::ios::binary);
    const std::string whole{std::istreambuf_iterator<char>(stream), {}};
    for (int i = 0; i < 20; ++i) {
      const bool is_cut_off = i % 2 == 0;
      std::string bytes = whole.substr(0, is_cut_off ? random() % whole.size() : whole.size());
      if (!is_cut_off) bytes[random() % bytes.size()] = static_cast<char>(random());
      std::ofstream(path, std::ios::binary) << bytes;
      try {
        const auto read = read_tree(path);
        EXPECT_FALSE(is_cut_off) << "seed " << seed << ", " << bytes.size() << " bytes";
        if (read->getNumLeafNodes() > 0) (void)known_range(*read);
      } catch (const SetupError& error) {
        EXPECT_NE(std::string(error.what()).find(path), std::string::npos) << "seed " << seed;
      }
    }
    (void)std::remove(path.c_str());
  }
}

}  // namespace grid_test
}  // namespace repel::octrees
