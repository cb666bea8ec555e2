// SPDX-License-Identifier: BSD-3-Clause
#include <repel/octrees/grid.hpp>

#include <gtest/gtest.h>

#include <cstdio>
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

}  // namespace grid_test
}  // namespace repel::octrees
