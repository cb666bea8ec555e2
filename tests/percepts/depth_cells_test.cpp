// SPDX-License-Identifier: BSD-3-Clause
#include <repel/percepts/depth_cells.hpp>

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include <repel/reduction/separation.hpp>
#include <repel/reduction/shape.hpp>

#include "percepts/seen.hpp"
#include "support/draws.hpp"

namespace repel::percepts {
namespace depth_cells_test {

using families::draws;
using test::depths;
using test::spoil;

/// Every measured point lies in a cell, up to rounding, and no cell begins much before what is seen
/// in it. Returns how many points there were.
int expect_contained(const std::vector<float>& image, std::span<const Cell> cells,
                     const DepthCells& division, const std::string& where) {
  SCOPED_TRACE(where);
  const DepthCamera& camera = division.camera();
  std::vector<Shape> hulls;
  for (const Cell& cell : cells) hulls.push_back(Shape::hull(cell.corners(camera), {.levels = 1}));
  const Shape point = Shape::sphere(0.0, {.levels = 1});
  int points = 0;
  for (int v = 0; v < camera.height; v += 3) {
    for (int u = 0; u < camera.width; u += 3) {
      const float z = image[camera.at(u, v)];
      if (!camera.measures(z)) continue;
      ++points;
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i < cells.size(); ++i) {
        const Cell& c = cells[i];
        if (u < c.u || u >= c.u + c.width || v < c.v || v >= c.v + c.height) continue;
        Pose X = Pose::Identity();
        X.translation() = static_cast<double>(z) * camera.ray(u, v);
        least = std::min(least, separation(point, X, hulls[i], Pose::Identity(), {}).distance);
      }
      EXPECT_LE(least, 1e-6) << "pixel " << u << ", " << v << ", depth " << z;
    }
  }
  return points;
}

TEST(DepthCells, ContainAllThatWasSeen) {
  constexpr unsigned seed = 30;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  DepthCamera camera;
  camera.width = 160, camera.height = 120;
  camera.fx = camera.fy = 140.0, camera.cx = 79.5, camera.cy = 59.5;
  DepthCells division(camera, {.most = 400});
  int points = 0;
  std::size_t most = 0;
  for (int i = 0; i < draws(40); ++i) {
    std::vector<test::Ball> balls;
    for (int k = 0; k < 3; ++k) {
      balls.push_back({{0.5 * any(random), 0.4 * any(random), 1.2 + 0.6 * any(random)},
                       0.12 + 0.1 * any(random)});
    }
    auto image = depths(camera, balls, {{{0.2 * any(random), 0.8, 0.5}, 0.8}, {{0, 0, 1}, 3.0}});
    spoil(image, i % 2 == 0 ? 0.0 : 0.003, i % 4 < 2 ? 0.0 : 0.1, random);
    const auto cells = division.divide(image);
    points += expect_contained(image, cells, division,
                               "image " + std::to_string(i) + ", seed " + std::to_string(seed));
    EXPECT_EQ(division.report().too_large, 0) << cells.size() << " cells";
    EXPECT_LE(division.report().tolerance, 0.04);
    most = std::max(most, cells.size());
  }
  EXPECT_GT(points, draws(40) * 1500);
  EXPECT_GT(most, 50U);
  EXPECT_LE(most, 400U);
}

TEST(DepthCells, OfAFloorAreFewHoweverItIsInclined) {
  const DepthCamera camera;
  DepthCells division(camera);
  const auto image = depths(camera, {}, {{{0.1, 0.9, 0.3}, 0.7}});
  const auto cells = division.divide(image);
  EXPECT_GT(division.report().measured, 20000);
  // All but a few, where the floor ends at the range of the camera.
  int large = 0;
  for (const Cell& cell : cells) {
    if (cell.width <= 8) continue;
    ++large;
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_LT(cell.back[i] - cell.front[i], 0.05 + 2e-3) << "as thick as asked, and no more";
    }
  }
  EXPECT_LE(large, 60);
  EXPECT_LE(cells.size(), 150U);
  EXPECT_EQ(division.report().tolerance, division.options().tolerance);
}

TEST(DepthCells, LeaveOpenWhatIsBetweenFrontAndBack) {
  const DepthCamera camera;
  DepthCells division(camera, {.most = 600});
  // A ball 1 m before a wall: between them, nothing.
  const auto image = depths(camera, {{{0, 0, 1.0}, 0.2}}, {{{0, 0, 1}, 2.0}});
  int deep = 0;
  for (const Cell& cell : division.divide(image)) {
    deep += cell.back[0] - cell.front[0] > 0.3F ? 1 : 0;
  }
  EXPECT_EQ(deep, 0);
}

TEST(DepthCells, AreFewEnoughWhateverIsSeen) {
  constexpr unsigned seed = 5;
  std::mt19937 random(seed);
  const DepthCamera camera;
  DepthCells division(camera, {.most = 60, .room = 10.0});
  std::uniform_real_distribution<float> any(-1.0F, 8.0F);
  std::vector<float> image(camera.pixels());
  for (float& z : image) z = any(random);
  image[5] = std::numeric_limits<float>::quiet_NaN();
  image[6] = std::numeric_limits<float>::infinity();
  const auto cells = division.divide(image);
  EXPECT_LE(cells.size(), 60U);
  EXPECT_GT(division.report().tolerance, division.options().tolerance);
  (void)expect_contained(image, cells, division, "noise, seed " + std::to_string(seed));
  EXPECT_TRUE(division.divide(std::span<const float>()).empty()) << "no image";
  EXPECT_EQ(division.report().measured, 0);
}

TEST(DepthCells, RefuseNumbersOutOfRange) {
  DepthCamera bad;
  bad.fx = 0.0;
  EXPECT_THROW(DepthCells{bad}, SetupError);
  const DepthCamera camera;
  EXPECT_THROW((DepthCells{camera, {.most = 10}}), SetupError) << "fewer than its blocks";
  EXPECT_THROW((DepthCells{camera, {.largest = 60, .smallest = 8}}), SetupError);
  EXPECT_THROW((DepthCells{camera, {.tolerance = 0.0}}), SetupError);
  EXPECT_THROW((DepthCells{camera, {.thickness = -1.0}}), SetupError);
}

}  // namespace depth_cells_test
}  // namespace repel::percepts
