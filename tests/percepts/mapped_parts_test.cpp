// SPDX-License-Identifier: BSD-3-Clause
#include <repel/octrees/mapped_parts.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <random>
#include <set>

#include <repel/reduction/separation.hpp>

#include "support/draws.hpp"

namespace repel::octrees {
namespace mapped_parts_test {

using families::draws;

constexpr double dt = 1.0 / 400.0;  // [s]
constexpr double cube = 0.05;       // [m]

using Cube = std::array<int, 3>;

/// A world that follows a tree, of which a list says what is in it.
struct Stage {
  explicit Stage(const MappedOptions& options, int reserved = 300) {
    tool = world.add_body("tool");
    world.join(tool, tool);
    finger = world.add_part(tool, "finger", Shape::sphere(0.02, {.levels = 1}));
    for (int i = 0; i < reserved; ++i) {
      const PartId part = world.reserve("seen", Shape::sphere(0.01, {.levels = 1}), 1.1);
      (void)world.add_pair(finger, part, {.range = 0.03, .surface_force = 30.0});
    }
    coprocessor.emplace(world, CoprocessorOptions{});
    changes.emplace(world, 2048);
    is_unseen_solid = options.is_unseen_solid;
    parts.emplace(cube, *changes, options);
  }

  // By value: `at` may be an element of `occupied`.
  void set(Cube at, bool is_occupied) {
    const auto key = [](int each) { return static_cast<octomap::key_type>(each + 32768); };
    (void)tree.setNodeValue(octomap::OcTreeKey(key(at[0]), key(at[1]), key(at[2])),
                            is_occupied ? 2.0F : -2.0F);
    if (is_occupied) {
      occupied.insert(at);
    } else {
      occupied.erase(at);
    }
    known.insert(at);
  }
  void set_block(const Cube& low, const Cube& size, bool is_occupied) {
    for (int i = 0; i < size[0] * size[1] * size[2]; ++i) {
      set({low[0] + i % size[0], low[1] + i / size[0] % size[1], low[2] + i / (size[0] * size[1])},
          is_occupied);
    }
  }
  /// Takes over the tree, and lets the changes come to an end.
  MapCounts see() {
    tree.prune();
    const MapCounts counts = parts->see(tree);
    for (int k = 0; k < 60; ++k) {
      changes->apply(world, *coprocessor, 4096);
      world.advance(dt);
      EXPECT_TRUE(world.place(tool, Pose(Eigen::Translation3d(9, 9, 9)), {}));
      world.carry();
      (void)coprocessor->exchange();
    }
    return counts;
  }
  /// How far a point [m] is outside of all parts of the world that are there; negative inside.
  [[nodiscard]] double outside(const Vec3& p) const {
    double least = 1e9;
    for (const auto& loose : world.loose()) {
      if (!world.is_there(loose.part)) continue;
      const Part& part = world.part(loose.part);
      const Pose& X = world.motion().bodies[static_cast<std::size_t>(part.body.index)].X_WB;
      least = std::min(least, separation(Shape::sphere(0.0, {.levels = 1}),
                                         Pose(Eigen::Translation3d(p)), part.shape, X, {})
                                  .distance);
    }
    return least;
  }
  /// Whether a cube `factor` times as large, with this point [m] in it, is solid.
  [[nodiscard]] bool is_solid(const Vec3& p, int factor, const cover::CubeRange& region) const {
    Cube first{};
    for (int axis = 0; axis < 3; ++axis) {
      first[static_cast<std::size_t>(axis)] =
          factor * static_cast<int>(std::floor(p[axis] / (factor * cube)));
    }
    for (int i = 0; i < factor * factor * factor; ++i) {
      const Cube at{first[0] + i % factor, first[1] + i / factor % factor,
                    first[2] + i / (factor * factor)};
      bool is_in_region = true;
      for (std::size_t k = 0; k < 3; ++k) {
        is_in_region = is_in_region && at[k] >= region.low[k] && at[k] <= region.high[k];
      }
      if (!is_in_region) continue;
      if (occupied.contains(at) || (is_unseen_solid && !known.contains(at))) return true;
    }
    return false;
  }
  static Capacities limits() {
    Capacities limits;
    limits.loose = 1000;
    return limits;
  }
  World world{limits()};
  BodyId tool;
  PartId finger;
  octomap::OcTree tree{cube};
  std::set<Cube> occupied, known;
  bool is_unseen_solid = false;
  std::optional<Coprocessor> coprocessor;
  std::optional<WorldChanges> changes;
  std::optional<MappedParts> parts;
};

/// 20 cubes along each axis, none of them at a multiple of many.
const Region region{{-0.55, -0.45, -0.25}, {0.45, 0.55, 0.75}};

Cube any_cube(std::mt19937& random, int size) {
  Cube at{};
  const cover::CubeRange range = cubes_in(region, cube);
  for (std::size_t k = 0; k < 3; ++k) {
    at[k] = std::uniform_int_distribution<int>(range.low[k], range.high[k] + 1 - size)(random);
  }
  return at;
}

/// Every corner and the centre of every occupied cube is in a part, and of random points exactly
/// those in solid cubes.
void check(const Stage& stage, const MapCounts& counts, std::mt19937& random) {
  const int factor = static_cast<int>(std::lround(counts.cube / cube));
  const cover::CubeRange range = cubes_in(region, cube);
  for (const Cube& at : stage.occupied) {
    const Vec3 low = cube * Vec3(at[0], at[1], at[2]);
    ASSERT_LE(stage.outside(low + Vec3::Constant(0.5 * cube)), -0.4 * cube);
    const int corner = static_cast<int>(random() % 8);
    const Vec3 p = low + cube * Vec3(corner & 1, (corner >> 1) & 1, (corner >> 2) & 1);
    ASSERT_LE(stage.outside(p), 1e-9);
  }
  int solid = 0;
  const int points = draws(300);
  for (int i = 0; i < points; ++i) {
    // Half of them near what is solid.
    const auto near = std::next(stage.occupied.begin(),
                                static_cast<std::ptrdiff_t>(random() % stage.occupied.size()));
    Vec3 p;
    for (int axis = 0; axis < 3; ++axis) {
      const double at = cube * (*near)[static_cast<std::size_t>(axis)];
      const double low = i % 2 == 0 ? region.low[axis] : std::max(region.low[axis], at - cube);
      const double high =
          i % 2 == 0 ? region.high[axis] : std::min(region.high[axis], at + 2.0 * cube);
      p[axis] = std::uniform_real_distribution<double>(low, high)(random);
      // Not on the face of a cube.
      const double in_cubes = p[axis] / cube;
      p[axis] += std::abs(in_cubes - std::round(in_cubes)) < 1e-3 ? 0.01 * cube : 0.0;
    }
    const bool is_solid = stage.is_solid(p, factor, range);
    ASSERT_EQ(stage.outside(p) < 0.0, is_solid) << p.transpose();
    solid += is_solid ? 1 : 0;
  }
  EXPECT_GT(solid, 0);
  EXPECT_LT(solid, points);
}

TEST(MappedParts, AreTheSolidCubesAndNothingElseHoweverTheTreeChanges) {
  constexpr unsigned seed = 42;
  std::mt19937 random(seed);
  std::int64_t kept = 0;
  std::int64_t boxes = 0;
  for (const bool is_unseen_solid : {false, true}) {
    SCOPED_TRACE("seed " + std::to_string(seed) + (is_unseen_solid ? ", unseen solid" : ""));
    Stage stage({.most = 150, .is_unseen_solid = is_unseen_solid, .region = region});
    if (is_unseen_solid) stage.set_block({-11, -9, -5}, {20, 20, 17}, false);
    for (int version = 0; version < draws(20); ++version) {
      for (int change = 0; change < 3; ++change) {
        const Cube size{1 + static_cast<int>(random() % 6), 1 + static_cast<int>(random() % 3),
                        1 + static_cast<int>(random() % 6)};
        stage.set_block(any_cube(random, 6), size, random() % 3 != 0);
      }
      if (stage.occupied.empty()) continue;
      const MapCounts counts = stage.see();
      EXPECT_EQ(counts.left_out, 0);
      EXPECT_EQ(counts.boxes, counts.kept + counts.added);
      EXPECT_EQ(static_cast<int>(stage.parts->size()), counts.boxes);
      check(stage, counts, random);
      const MapCounts again = stage.see();
      EXPECT_EQ(again.kept, counts.boxes);
      EXPECT_EQ(again.added + again.removed, 0) << "nothing has changed";
      kept += version > 0 ? counts.kept : 0;
      boxes += version > 0 ? counts.boxes : 0;
    }
    EXPECT_EQ(stage.changes->counts().refused, 0);
  }
  EXPECT_GT(kept, boxes / 3) << "few changes leave most of them as they are";
}

TEST(MappedParts, OfWhatDidNotChangeStay) {
  Stage stage({.region = region});
  stage.set_block({-11, -9, -5}, {20, 20, 1}, true);  // the floor
  stage.set_block({0, 0, -4}, {3, 3, 6}, true);
  const MapCounts first = stage.see();
  EXPECT_EQ(first.boxes, 2);
  stage.set_block({-8, 4, 3}, {2, 2, 2}, true);
  const MapCounts more = stage.see();
  EXPECT_EQ(more.kept, 2);
  EXPECT_EQ(more.added, 1);
  EXPECT_EQ(more.removed, 0);
  stage.set_block({-8, 4, 3}, {2, 2, 2}, false);
  const MapCounts less = stage.see();
  EXPECT_EQ(less.kept, 2);
  EXPECT_EQ(less.removed, 1);
  stage.parts->clear();
  EXPECT_EQ(stage.parts->size(), 0U);
}

TEST(MappedParts, AreCoarserWhereTheyWouldBeTooMany) {
  constexpr unsigned seed = 43;
  std::mt19937 random(seed);
  Stage stage({.most = 40, .region = region});
  for (int i = 0; i < 150; ++i) stage.set(any_cube(random, 1), true);
  const MapCounts counts = stage.see();
  EXPECT_GT(counts.cube, 1.9 * cube);
  EXPECT_LE(counts.boxes, 40);
  EXPECT_GT(counts.boxes, 5);
  EXPECT_EQ(counts.left_out, 0);
  check(stage, counts, random);
  const MapCounts again = stage.see();
  EXPECT_EQ(again.added + again.removed, 0);
  EXPECT_EQ(again.cube, counts.cube);
  while (stage.occupied.size() > 20) stage.set(*stage.occupied.begin(), false);
  const MapCounts fewer = stage.see();
  EXPECT_LT(fewer.cube, counts.cube) << "one step at a time";
  EXPECT_EQ(stage.see().left_out, 0);
  const MapCounts last = stage.see();
  EXPECT_EQ(last.cube, cube);
  check(stage, last, random);
}

TEST(MappedParts, SayWhatFoundNoPart) {
  constexpr unsigned seed = 44;
  std::mt19937 random(seed);
  const auto scattered = [&](Stage& stage) {
    for (int i = 0; i < 60; ++i) stage.set(any_cube(random, 1), true);
    return stage.see();
  };
  Stage short_of_parts({.region = region, .share = {.first = 3, .count = 10}});
  const MapCounts counts = scattered(short_of_parts);
  EXPECT_EQ(counts.added, 10);
  EXPECT_EQ(counts.left_out, counts.boxes - 10);
  // Larger cubes have no room.
  Stage without_room({.most = 12, .region = region, .room = 0.05});
  const MapCounts cut = scattered(without_room);
  EXPECT_EQ(cut.cube, cube);
  EXPECT_EQ(cut.added, 12);
  EXPECT_EQ(cut.left_out, cut.boxes - 12);
  const MapCounts again = without_room.see();
  EXPECT_EQ(again.kept, 12) << "always the same";
}

TEST(MappedParts, AreNoLargerThanTheirRoom) {
  Stage stage({.region = region, .room = 0.3});
  stage.set_block({-11, -9, -5}, {20, 20, 2}, true);
  (void)stage.see();
  EXPECT_GT(stage.parts->size(), 4U);
  for (const cover::CubeRange& box : stage.parts->boxes()) {
    Vec3 size;
    for (std::size_t k = 0; k < 3; ++k) {
      size[static_cast<int>(k)] = cube * (box.high[k] + 1 - box.low[k]);
    }
    EXPECT_LE(0.5 * size.norm(), 0.3);
  }
}

TEST(MappedParts, AreLargerByTheirSlack) {
  Stage stage({.region = region, .room = 0.3, .slack = 0.01});
  stage.set_block({-11, -9, -5}, {20, 20, 2}, true);
  (void)stage.see();
  EXPECT_NEAR(stage.outside({0.0, 0.0, -0.14}), 0.0, 1e-9);
  EXPECT_NEAR(stage.outside({0.0, 0.0, -0.26}), 0.0, 1e-9);
  for (const auto& loose : stage.world.loose()) {
    if (stage.world.is_there(loose.part)) {
      EXPECT_LE(stage.world.part(loose.part).shape.reach(), 0.3);
    }
  }
}

TEST(MappedParts, RefuseWhatIsOutOfRange) {
  Stage stage({.region = region});
  EXPECT_THROW((void)stage.parts->see(octomap::OcTree(0.1)), SetupError);
  EXPECT_THROW(MappedParts(0.05, *stage.changes, {.most = 0}), SetupError);
  EXPECT_THROW(MappedParts(0.05, *stage.changes, {.room = 0.04}), SetupError);
  EXPECT_THROW(MappedParts(0.001, *stage.changes, {}), SetupError) << "too many cubes";
}

}  // namespace mapped_parts_test
}  // namespace repel::octrees
