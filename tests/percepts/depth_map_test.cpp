// SPDX-License-Identifier: BSD-3-Clause
#include <repel/octrees/depth_map.hpp>

#include <gtest/gtest.h>

#include <random>

#include "percepts/seen.hpp"

namespace repel::octrees {
namespace depth_map_test {

using percepts::DepthCamera;
namespace seen = percepts::test;

/// A camera 1.4 m from the middle of the map, in a direction that is none of its axes.
struct Stage {
  Stage() {
    camera.width = 160, camera.height = 120;
    camera.fx = camera.fy = 140.0, camera.cx = 79.5, camera.cy = 59.5;
    X_WC.linear() = Eigen::AngleAxisd(0.3, Vec3(1, 2, 0.5).normalized()).toRotationMatrix();
    X_WC.translation() = X_WC.linear() * Vec3(0, 0, -1.4);
  }
  [[nodiscard]] DepthMap map(const DepthMapOptions& options = {}) const {
    return DepthMap(camera, options);
  }
  [[nodiscard]] bool is_occupied(const DepthMap& map, const Vec3& p_C) const {
    const Vec3 p = X_WC * p_C;
    const auto* const node = map.tree().search(p.x(), p.y(), p.z());
    return node != nullptr && map.tree().isNodeOccupied(node);
  }
  [[nodiscard]] Vec3 point(int u, int v, float z) const {
    return static_cast<double>(std::abs(z)) * camera.ray(u, v);
  }
  DepthCamera camera;
  Pose X_WC = Pose::Identity();
};

const seen::Plane wall{{0, 0.2, 1}, 1.6};
const seen::Ball ball{{0, 0, 1.1}, 0.2};

std::size_t occupied(const DepthMap& map) {
  std::size_t count = 0;
  for (auto leaf = map.tree().begin_leafs(); leaf != map.tree().end_leafs(); ++leaf) {
    if (map.tree().isNodeOccupied(*leaf)) {
      count += std::size_t{1} << (3U * (map.tree().getTreeDepth() - leaf.getDepth()));
    }
  }
  return count;
}

TEST(DepthMap, IsOccupiedWhereSomethingWasMeasuredAndFreeBefore) {
  constexpr unsigned seed = 41;
  std::mt19937 random(seed);
  Stage stage;
  DepthMap map = stage.map();
  auto image = seen::depths(stage.camera, {ball}, {wall});
  seen::spoil(image, 0.002, 0.1, random);
  const int hits = map.insert(image, stage.X_WC, 0.0);
  EXPECT_GT(hits, 300);
  EXPECT_EQ(occupied(map), static_cast<std::size_t>(hits));
  int measured = 0;
  for (int v = 0; v < stage.camera.height; ++v) {
    for (int u = 0; u < stage.camera.width; ++u) {
      const float z = image[stage.camera.at(u, v)];
      if (!stage.camera.measures(z)) continue;
      ASSERT_TRUE(stage.is_occupied(map, stage.point(u, v, z)))
          << u << " " << v << ", seed " << seed;
      ASSERT_FALSE(stage.is_occupied(map, 0.3 * stage.point(u, v, z)));
      ++measured;
    }
  }
  EXPECT_GT(measured, 10000);
}

TEST(DepthMap, IsFreeAgainAfterSoManyImagesThatSeeThroughIt) {
  for (const int frees : {1, 2, 5}) {
    Stage stage;
    DepthMap map = stage.map({.frees = frees});
    const auto with = seen::depths(stage.camera, {ball}, {wall});
    const auto without = seen::depths(stage.camera, {}, {wall});
    DepthMap bare = stage.map({.frees = frees});
    (void)bare.insert(without, stage.X_WC, 0.0);
    double time = 0.0;
    for (int i = 0; i < 4; ++i) (void)map.insert(with, stage.X_WC, time += 0.1);
    const std::size_t before = occupied(map);
    for (int i = 0; i < frees - 1; ++i) (void)map.insert(without, stage.X_WC, time += 0.1);
    const Vec3 front = stage.point(80, 60, with[stage.camera.at(80, 60)]);
    EXPECT_TRUE(stage.is_occupied(map, front)) << frees;
    EXPECT_GE(occupied(map), before) << "and the wall behind it";
    (void)map.insert(without, stage.X_WC, time += 0.1);
    EXPECT_FALSE(stage.is_occupied(map, front));
    EXPECT_EQ(occupied(map), occupied(bare)) << "all of the ball";
    (void)map.insert(with, stage.X_WC, time += 0.1);
    EXPECT_TRUE(stage.is_occupied(map, front)) << "in the first image that shows it";
  }
}

TEST(DepthMap, KeepsWhatTheRobotHides) {
  Stage stage;
  DepthMap map = stage.map({.keeps = 1.0});
  const auto with = seen::depths(stage.camera, {ball}, {wall});
  (void)map.insert(with, stage.X_WC, 0.0);
  const std::size_t before = occupied(map);
  // The robot stands before all of it: behind it nothing is known.
  auto robot = seen::depths(stage.camera, {}, {{{0, 0, 1}, 0.6}});
  for (float& z : robot) z = -z;
  for (int i = 1; i < 30; ++i) (void)map.insert(robot, stage.X_WC, 0.1 * i);
  EXPECT_EQ(occupied(map), before);
  // Within its margin everything is taken for the robot: that goes at last, what it hides not.
  auto near = with;
  for (int v = 40; v < 80; ++v) {
    for (int u = 60; u < 100; ++u) near[stage.camera.at(u, v)] *= -1.0F;
  }
  const Vec3 front = stage.point(80, 60, with[stage.camera.at(80, 60)]);
  DepthMap other = stage.map({.keeps = 1.0});
  (void)other.insert(with, stage.X_WC, 0.0);
  (void)other.insert(near, stage.X_WC, 0.9);
  EXPECT_TRUE(stage.is_occupied(other, front));
  (void)other.insert(near, stage.X_WC, 1.1);
  EXPECT_FALSE(stage.is_occupied(other, front));
}

TEST(DepthMap, WithASlackIsNotChangedByNoise) {
  constexpr unsigned seed = 45;
  constexpr double slack = 0.01;
  std::array<int, 2> changes{};
  for (const bool has_slack : {false, true}) {
    std::mt19937 random(seed);
    Stage stage;
    DepthMap map = stage.map({.slack = has_slack ? slack : 0.0});
    const auto clean = seen::depths(stage.camera, {ball}, {wall});
    const cover::CubeRange region = cubes_in(map.options().region, map.options().cube);
    std::vector<std::uint8_t> last;
    for (int i = 0; i < 40; ++i) {
      auto image = clean;
      seen::spoil(image, 0.001, 0.1, random);
      (void)map.insert(image, stage.X_WC, i / 30.0);
      for (std::size_t k = 0; k < image.size() && i == 39; k += 7) {
        if (!stage.camera.measures(image[k])) continue;
        const Vec3 p = stage.X_WC *
                       stage.point(static_cast<int>(k) % 160, static_cast<int>(k) / 160, image[k]);
        bool is_near = false;
        for (int side = 0; side < 27; ++side) {
          const Vec3 q = p + 1.001 * slack * Vec3(side % 3 - 1, side / 3 % 3 - 1, side / 9 - 1);
          const auto* const node = map.tree().search(q.x(), q.y(), q.z());
          is_near = is_near || (node != nullptr && map.tree().isNodeOccupied(node));
        }
        ASSERT_TRUE(is_near) << "seed " << seed;
      }
      const std::vector<std::uint8_t> now = grid_of(map.tree(), region, false).solid;
      for (std::size_t k = 0; k < last.size() && i >= 10; ++k) {
        changes[has_slack ? 1 : 0] += now[k] != last[k] ? 1 : 0;
      }
      last = now;
    }
  }
  EXPECT_GT(changes[0], 50) << "the noise should cross faces of cubes, seed " << seed;
  EXPECT_LE(changes[1], changes[0] / 20) << "seed " << seed;
}

TEST(DepthMap, EndsWithItsRegion) {
  Stage stage;
  const DepthMapOptions options{.region = {{-0.3, -0.3, -0.4}, {0.3, 0.3, 0.3}}};
  DepthMap map = stage.map(options);
  EXPECT_GT(map.insert(seen::depths(stage.camera, {ball}, {wall}), stage.X_WC, 0.0), 20);
  const cover::CubeRange known = known_range(map.tree());
  const cover::CubeRange region = cubes_in(options.region, options.cube);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_GE(known.low[k], region.low[k]);
    EXPECT_LE(known.high[k], region.high[k]);
  }
  EXPECT_EQ(map.insert(std::vector<float>(7), stage.X_WC, 0.1), 0) << "no whole image";
}

TEST(DepthMap, RefusesWhatIsOutOfRange) {
  const Stage stage;
  EXPECT_THROW((void)stage.map({.cube = 0.0}), SetupError);
  EXPECT_THROW((void)stage.map({.cube = 1e-3}), SetupError) << "too many cubes";
  EXPECT_THROW((void)stage.map({.frees = 0}), SetupError);
  EXPECT_THROW((void)stage.map({.slack = 0.02}), SetupError) << "more than a quarter of a cube";
  EXPECT_THROW((void)stage.map({.keeps = -1.0}), SetupError);
}

}  // namespace depth_map_test
}  // namespace repel::octrees
