// SPDX-License-Identifier: BSD-3-Clause
#include <repel/cover/occupancy.hpp>

#include <gtest/gtest.h>

#include <random>

#include <repel/base/setup_error.hpp>

namespace repel::cover {
namespace occupancy_test {

OccupancyGrid empty(int x, int y, int z) {
  OccupancyGrid grid{{0.1, -0.2, 0.3}, 0.05, {x, y, z}, {}};
  grid.solid.assign(grid.place(0, 0, z), 0);
  return grid;
}

void fill(OccupancyGrid& grid, const std::array<int, 3>& low, const std::array<int, 3>& end) {
  for (int z = low[2]; z < end[2]; ++z) {
    for (int y = low[1]; y < end[1]; ++y) {
      for (int x = low[0]; x < end[0]; ++x) grid.solid[grid.place(x, y, z)] = 1;
    }
  }
}

/// In how many boxes the middle of each cube is.
std::vector<int> boxes_at(const OccupancyGrid& grid, const std::vector<std::vector<Vec3>>& boxes) {
  std::vector<int> counts(grid.solid.size(), 0);
  for (int z = 0; z < grid.size[2]; ++z) {
    for (int y = 0; y < grid.size[1]; ++y) {
      for (int x = 0; x < grid.size[0]; ++x) {
        const Vec3 p = grid.low + grid.edge * Vec3(x + 0.5, y + 0.5, z + 0.5);
        for (const auto& box : boxes) {
          const Vec3 low = box.front();
          const Vec3 high = box.back();
          if ((low.array() < p.array()).all() && (p.array() < high.array()).all()) {
            ++counts[grid.place(x, y, z)];
          }
        }
      }
    }
  }
  return counts;
}

TEST(Occupancy, OfAnAngleIsTwoBoxesThatReachIntoEachOther) {
  OccupancyGrid grid = empty(10, 10, 3);
  fill(grid, {0, 0, 0}, {2, 10, 3});
  fill(grid, {0, 0, 0}, {10, 2, 3});
  const auto boxes = boxes_of(grid, 10);
  ASSERT_EQ(boxes.size(), 2U);
  EXPECT_EQ(boxes_at(grid, boxes)[grid.place(1, 1, 1)], 2) << "where the legs meet";
}

TEST(Occupancy, OfAnythingIsCoveredAndNothingElseIs) {
  constexpr unsigned seed = 12;
  std::mt19937 random(seed);
  for (int draw = 0; draw < 20; ++draw) {
    OccupancyGrid grid = empty(9, 7, 8);
    for (int block = 0; block < 6; ++block) {
      std::array<int, 3> low{};
      std::array<int, 3> end{};
      for (std::size_t k = 0; k < 3; ++k) {
        low[k] = static_cast<int>(random()) & 3;
        end[k] = std::min(grid.size[k], low[k] + 1 + (static_cast<int>(random()) & 3));
      }
      fill(grid, low, end);
    }
    const auto boxes = boxes_of(grid, 1000);
    const auto counts = boxes_at(grid, boxes);
    for (std::size_t i = 0; i < counts.size(); ++i) {
      ASSERT_EQ(counts[i] > 0, grid.solid[i] != 0) << "seed " << seed << ", draw " << draw;
    }
  }
}

TEST(Occupancy, HasOnePlaceForEachCube) {
  const OccupancyGrid grid = empty(3, 4, 5);
  for (std::size_t i = 0; i < grid.solid.size(); ++i) {
    const std::array<int, 3> at = grid.cube(i);
    for (std::size_t k = 0; k < 3; ++k) ASSERT_LT(at[k], grid.size[k]);
    ASSERT_EQ(grid.place(at[0], at[1], at[2]), i);
  }
}

TEST(Occupancy, OfLargerCubesContainsTheSmallOnes) {
  OccupancyGrid grid = empty(5, 5, 5);
  fill(grid, {3, 3, 3}, {4, 4, 4});
  const OccupancyGrid coarse = coarser(grid, 2);
  EXPECT_EQ(coarse.size, (std::array<int, 3>{3, 3, 3}));
  EXPECT_EQ(coarse.solid[coarse.place(1, 1, 1)], 1);
  EXPECT_EQ(boxes_of(coarse, 1).size(), 1U);
  EXPECT_DOUBLE_EQ(coarse.edge, 0.1);
}

TEST(Occupancy, OfLargerCubesMayBeginBeforeTheSmallOnes) {
  OccupancyGrid grid = empty(5, 5, 5);
  fill(grid, {1, 2, 3}, {2, 3, 4});
  const OccupancyGrid coarse = coarser(grid, 4, {3, 0, 1});
  EXPECT_EQ(coarse.size, (std::array<int, 3>{2, 2, 2}));
  EXPECT_TRUE(coarse.low.isApprox(grid.low - Vec3(0.15, 0.0, 0.05), 1e-12));
  for (std::size_t i = 0; i < coarse.solid.size(); ++i) {
    EXPECT_EQ(coarse.solid[i], i == coarse.place(1, 0, 1) ? 1 : 0) << i;
  }
  EXPECT_THROW((void)coarser(grid, 2, {2, 0, 0}), SetupError);
}

TEST(Occupancy, OfABoxGrowsNoFartherThanItsReach) {
  OccupancyGrid grid = empty(20, 20, 20);
  fill(grid, {0, 0, 0}, {20, 20, 20});
  const CubeRange whole = grown_from(grid, {3, 4, 5});
  EXPECT_EQ(whole, (CubeRange{{0, 0, 0}, {19, 19, 19}}));
  const CubeRange part = grown_from(grid, {3, 4, 5}, 0.2);
  Vec3 size = Vec3::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    size[static_cast<int>(k)] = part.high[k] + 1 - part.low[k];
    EXPECT_LE(part.low[k], 3 + static_cast<int>(k));
    EXPECT_GE(part.high[k], 3 + static_cast<int>(k));
  }
  EXPECT_LE(0.5 * grid.edge * size.norm(), 0.2);
  EXPECT_GT(0.5 * grid.edge * size.norm(), 0.15);
  EXPECT_EQ(grown_from(grid, {3, 4, 5}, 0.01), (CubeRange{{3, 4, 5}, {3, 4, 5}}));
}

TEST(Occupancy, OfTooManyBoxesIsRefusedWithTheirNumber) {
  OccupancyGrid grid = empty(5, 1, 1);
  for (const int x : {0, 2, 4}) grid.solid[grid.place(x, 0, 0)] = 1;
  try {
    (void)boxes_of(grid, 2);
    FAIL() << "not refused";
  } catch (const SetupError& error) {
    EXPECT_NE(std::string(error.what()).find("needs 3 boxes"), std::string::npos) << error.what();
  }
}

}  // namespace occupancy_test
}  // namespace repel::cover
