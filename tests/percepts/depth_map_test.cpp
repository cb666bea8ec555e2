// SPDX-License-Identifier: BSD-3-Clause
#include <repel/octrees/depth_map.hpp>

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "percepts/seen.hpp"
#include "support/draws.hpp"

namespace repel::octrees {
namespace depth_map_test {

using families::draws;
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

using Cube = std::array<int, 3>;

/// The cubes of its region that a map knows, occupied or free.
std::set<Cube> known_cubes(const DepthMap& map) {
  const cover::CubeRange range = cubes_in(map.options().region, map.options().cube);
  const std::vector<std::uint8_t> free = grid_of(map.tree(), range, true).solid;
  const cover::OccupancyGrid occupied = grid_of(map.tree(), range, false);
  std::set<Cube> known;
  for (std::size_t i = 0; i < free.size(); ++i) {
    Cube at = occupied.cube(i);
    for (std::size_t k = 0; k < 3; ++k) at[k] += range.low[k];
    if (free[i] == 0 || occupied.solid[i] != 0) known.insert(at);
  }
  return known;
}

// The map goes along rays itself, which must not end early, nor leave the region.
TEST(DepthMap, KnowsTheCubesThatOctoMapFindsOnARay) {
  constexpr unsigned seed = 46;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> coordinate(-2.0, 2.0);
  std::uniform_real_distribution<double> depth(0.2, 3.0);
  const DepthMapOptions options{.cube = 0.03, .region = {{-1.0, -1.2, -0.7}, {0.8, 1.1, 1.3}}};
  const cover::CubeRange range = cubes_in(options.region, options.cube);
  const auto point = [](const Vec3& p) {
    return octomap::point3d(static_cast<float>(p.x()), static_cast<float>(p.y()),
                            static_cast<float>(p.z()));
  };
  constexpr int rays = draws(200);
  int cubes = 0;
  int misses = 0;
  for (int i = 0; i < rays; ++i) {
    Stage stage;
    const auto drawn = [&] {
      return Vec3(coordinate(random), coordinate(random), coordinate(random));
    };
    // Some of them begin in the region; some go along a plane of the axes, or along an axis.
    stage.X_WC = Eigen::Translation3d(0.6 * drawn()) *
                 Eigen::AngleAxisd(i % 5 == 0 ? 0.0 : coordinate(random), drawn().normalized());
    stage.camera.cx = 64.0;
    stage.camera.cy = i % 10 == 0 ? 64.0 : 61.3;
    std::vector<float> image(stage.camera.pixels());
    const float z = image[stage.camera.at(64, 64)] = static_cast<float>(depth(random));
    DepthMap map = stage.map(options);
    (void)map.insert(image, stage.X_WC, 0.0);
    std::set<Cube> expected;
    const auto expect = [&](const octomap::OcTreeKey& key) {
      const Cube at{key[0] - 32768, key[1] - 32768, key[2] - 32768};
      bool is_inside = true;
      for (std::size_t k = 0; k < 3; ++k) {
        is_inside = is_inside && at[k] >= range.low[k] && at[k] <= range.high[k];
      }
      if (is_inside) expected.insert(at);
    };
    const octomap::point3d end = point(stage.X_WC * stage.point(64, 64, z));
    octomap::KeyRay ray;
    ASSERT_TRUE(map.tree().computeRayKeys(point(stage.X_WC.translation()), end, ray));
    for (const octomap::OcTreeKey& key : ray) expect(key);
    expect(map.tree().coordToKey(end));
    ASSERT_EQ(known_cubes(map), expected) << "seed " << seed << ", ray " << i;
    cubes += static_cast<int>(expected.size());
    misses += expected.empty() ? 1 : 0;
  }
  EXPECT_GT(cubes, 10 * rays);
  EXPECT_GT(misses, rays / 20);
}

TEST(DepthMap, IsFreeWhereACubeIsWhollyBeforeASurface) {
  for (const double cube : {0.02, 0.05, 0.2}) {
    Stage stage;
    stage.camera.nearest = 0.01;
    const DepthMapOptions options{.cube = cube, .region = {{-1.2, -1.2, -1.8}, {1.2, 1.2, 0.4}}};
    DepthMap map = stage.map(options);
    (void)map.insert(seen::depths(stage.camera, {}, {wall}), stage.X_WC, 0.0);
    const cover::CubeRange range = cubes_in(options.region, cube);
    const cover::OccupancyGrid grid = grid_of(map.tree(), range, true);
    const Pose X_CW = stage.X_WC.inverse();
    int before = 0;
    for (std::size_t i = 0; i < grid.solid.size(); ++i) {
      const Cube at = grid.cube(i);
      const Vec3 low = grid.low + cube * Vec3(at[0], at[1], at[2]);
      bool is_before = true;
      for (int corner = 0; corner < 8; ++corner) {
        const Vec3 p = X_CW * (low + cube * Vec3(corner & 1, corner >> 1 & 1, corner >> 2));
        const double u = stage.camera.cx + stage.camera.fx * p.x() / p.z();
        const double v = stage.camera.cy + stage.camera.fy * p.y() / p.z();
        is_before = is_before && p.z() > 0.0 && wall.n.dot(p) < wall.offset - 1e-6 && u >= 0.0 &&
                    v >= 0.0 && u <= stage.camera.width - 1 && v <= stage.camera.height - 1;
      }
      if (!is_before) continue;
      ASSERT_EQ(grid.solid[i], 0) << low.transpose() << ", cubes of " << cube;
      ++before;
    }
    EXPECT_GT(before, 20) << "cubes of " << cube;
  }
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
