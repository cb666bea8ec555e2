// SPDX-License-Identifier: BSD-3-Clause
#include <repel/percepts/perceived_parts.hpp>

#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "percepts/seen.hpp"

namespace repel::percepts {
namespace perceived_parts_test {

constexpr double dt = 1.0 / 400.0;  // [s]

/// A tool and a camera that looks along the x axis of the world.
struct Stage {
  explicit Stage(int reserved = 400) {
    camera.width = 160, camera.height = 120;
    camera.fx = camera.fy = 140.0, camera.cx = 79.5, camera.cy = 59.5;
    X_WC.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    tool = world.add_body("tool");
    world.join(tool, tool);
    finger = world.add_part(tool, "finger", Shape::sphere(0.02, {.levels = 1}));
    for (int i = 0; i < reserved; ++i) {
      const PartId part = world.reserve("seen", Shape::sphere(0.01, {.levels = 1}), 1.0);
      (void)world.add_pair(finger, part, {.range = 0.03, .surface_force = 30.0});
    }
    coprocessor.emplace(world, CoprocessorOptions{});
    changes.emplace(world, 2048);
    division.emplace(camera, CellOptions{.most = 150});
    parts.emplace(*changes);
  }
  PerceptCounts see(const std::vector<float>& image, double time) {
    return parts->see(division->divide(image), *division, X_WC, time);
  }
  /// The forces on the tool at a place, after a while.
  Vec3 force_at(const Vec3& p_WT) {
    Vec3 force(0, 0, 0);
    for (int k = 0; k < 60; ++k) {
      changes->apply(world, *coprocessor, 4096);
      world.advance(dt);
      EXPECT_TRUE(world.place(tool, Pose(Eigen::Translation3d(p_WT)), {}));
      world.carry();
      force = coprocessor->exchange().on_body[static_cast<std::size_t>(tool.index)].force;
    }
    return force;
  }
  static Capacities limits() {
    Capacities limits;
    limits.loose = 1000;
    return limits;
  }
  World world{limits()};
  BodyId tool;
  PartId finger;
  DepthCamera camera;
  Pose X_WC = Pose::Identity();
  std::optional<Coprocessor> coprocessor;
  std::optional<WorldChanges> changes;
  std::optional<DepthCells> division;
  std::optional<PerceivedParts> parts;
};

// A wall 1.5 m before the camera, and a ball before the wall.
const test::Plane wall{{0, 0, 1}, 1.5};
const test::Ball ball{{0, 0, 1.0}, 0.2};

TEST(PerceivedParts, PushWhatComesNearTheSeen) {
  Stage stage;
  const auto image = test::depths(stage.camera, {ball}, {wall});
  const PerceptCounts counts = stage.see(image, 0.0);
  EXPECT_EQ(counts.added, counts.cells);
  EXPECT_EQ(counts.left_out, 0);
  EXPECT_LT(stage.force_at({0.76, 0, 0}).x(), -5.0) << "the ball begins at 0.8 m";
  EXPECT_LT(stage.force_at({1.46, 0.4, 0}).x(), -5.0) << "the wall";
  EXPECT_EQ(stage.force_at({1.2, 0.4, 0}).norm(), 0.0) << "nothing";
  EXPECT_EQ(stage.changes->counts().refused, 0);
}

TEST(PerceivedParts, StayAsTheyAreWhenNothingButNoiseChanges) {
  Stage stage;
  constexpr unsigned seed = 11;
  std::mt19937 random(seed);
  int kept = 0;
  int cells = 0;
  for (int i = 0; i < 10; ++i) {
    auto image = test::depths(stage.camera, {}, {wall, {{0, 0.9, 0.4}, 0.8}});
    test::spoil(image, 0.001, 0.02, random);
    const PerceptCounts counts = stage.see(image, i / 30.0);
    (void)stage.force_at({0, 0, 0});
    if (i == 0) continue;
    kept += counts.kept;
    cells += counts.cells;
  }
  EXPECT_GT(cells, 50);
  EXPECT_GT(kept, 0.8 * cells) << "seed " << seed;
}

TEST(PerceivedParts, GoWhenTheyAreSeenNoMore) {
  Stage stage;
  (void)stage.see(test::depths(stage.camera, {ball}, {wall}), 0.0);
  EXPECT_GT(stage.force_at({0.76, 0, 0}).norm(), 5.0);
  const PerceptCounts counts = stage.see(test::depths(stage.camera, {}, {wall}), 0.1);
  EXPECT_GT(counts.removed, 3);
  EXPECT_EQ(stage.force_at({0.76, 0, 0}).norm(), 0.0);
  EXPECT_EQ(static_cast<int>(stage.parts->size()), counts.cells);
  stage.parts->clear();
  EXPECT_EQ(stage.force_at({1.46, 0.4, 0}).norm(), 0.0);
}

TEST(PerceivedParts, StayForAWhileWhereTheyAreHidden) {
  Stage stage;
  (void)stage.see(test::depths(stage.camera, {ball}, {wall}), 0.0);
  const std::vector<float> nothing(stage.camera.pixels(), 0.0F);
  EXPECT_EQ(stage.see(nothing, 1.9).removed, 0);
  EXPECT_GT(stage.force_at({0.76, 0, 0}).norm(), 5.0);
  const PerceptCounts later = stage.see(nothing, 2.1);
  EXPECT_GT(later.removed, 0);
  EXPECT_EQ(later.hidden, 0);
  EXPECT_EQ(stage.force_at({0.76, 0, 0}).norm(), 0.0);
}

TEST(PerceivedParts, SayWhatTheyHadNoRoomFor) {
  Stage stage(10);
  const PerceptCounts counts = stage.see(test::depths(stage.camera, {ball}, {wall}), 0.0);
  EXPECT_EQ(counts.added, 10);
  EXPECT_EQ(counts.left_out, counts.cells - 10);
}

}  // namespace perceived_parts_test
}  // namespace repel::percepts
