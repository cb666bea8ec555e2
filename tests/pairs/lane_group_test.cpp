// SPDX-License-Identifier: BSD-3-Clause
#include <repel/pairs/lane_group.hpp>

#include <gtest/gtest.h>

#include <string>

#include "pairs/near_pairs.hpp"

namespace repel::detail {
namespace lane_group_test {

constexpr unsigned seed = 2207;

bool has(unsigned bits, int k) {
  return (bits >> k & 1U) != 0U;
}

/// Compares the result of lane k of a group with the single evaluation of its pair. Counts the
/// comparisons.
struct Sample {
  int inside = 0, outside = 0, refused = 0, disputed = 0, pushed = 0;

  void expect_alone(const test::NearPairs& scene, PairId id, const LaneGroup& group, int k) {
    const World& world = scene.world;
    const Pair& pair = world.pair(id);
    const Level& A = world.part(pair.a).shape.level(0);
    const Level& B = world.part(pair.b).shape.level(0);
    const Pose X_WA = test::pose_of(world, pair.a);
    Gap gap;
    const bool holds = confirm_nearest({A.core, X_WA, B.core, test::pose_of(world, pair.b)},
                                       scene.warm[static_cast<std::size_t>(id.index)], {},
                                       std::numeric_limits<double>::infinity(), gap);
    const Separation one = apart(gap, A.depth, B.depth, X_WA);
    if (holds != has(group.proven(), k)) {
      ++disputed;
    } else if (!holds) {
      ++refused;
      EXPECT_EQ(group.force().at(k), Vec3::Zero());
      EXPECT_EQ(group.torque().at(k), Vec3::Zero());
    } else {
      expect_answer(one, group.answer(k).last);
      expect_force(world, pair, one, group, k);
    }
  }

 private:
  static void expect_answer(const Separation& one, const Separation& lane) {
    EXPECT_NEAR(lane.distance, one.distance, 1e-12);
    EXPECT_LE(lane.lower, one.upper);
    EXPECT_GE(lane.upper, one.lower);
    EXPECT_LE((lane.p_WA - one.p_WA).norm(), 1e-12);
    EXPECT_LE((lane.p_WB - one.p_WB).norm(), 1e-12);
    EXPECT_LE((lane.extraction_W - one.extraction_W).norm(), 1e-12);
  }
  void expect_force(const World& world, const Pair& pair, const Separation& one,
                    const LaneGroup& group, int k) {
    const Wrench on_a = test::force_now(world, pair);
    const Vec3& f = on_a.force;
    // A patch turns with the normals divided by its tilt.
    EXPECT_LE((group.force().at(k) - f).norm(), 1e-6);
    EXPECT_LE((group.torque().at(k) - on_a.torque).norm(), 1e-6);
    EXPECT_EQ(has(group.in_range(), k), one.lower < pair.law.range);
    EXPECT_EQ(group.answer(k).in_range, has(group.in_range(), k));
    if (!has(group.in_range(), k)) {
      EXPECT_EQ(group.force().at(k), Vec3::Zero());
    }
    (has(group.in_range(), k) ? inside : outside) += 1;
    pushed += f.norm() > 1.0 ? 1 : 0;
  }
};

TEST(LaneGroup, GivesEachPairTheAnswerAndTheForceItHasAlone) {
  Sample sample;
  int mixed = 0;
  for (unsigned run = 0; run < 300; ++run) {
    SCOPED_TRACE("seed " + std::to_string(seed + run));
    test::NearPairs scene(3, seed + run);
    const bool same_two = run % 3 != 0;
    const BodyId other = run % 3 == 1 ? World::fixed : scene.bodies[2];
    for (int k = 0; k < lane_count; ++k) {
      (void)(same_two ? scene.add(scene.bodies[1], other) : scene.add());
    }
    PartPoses poses(scene.world);
    LaneGroup group;
    for (int k = 0; k < lane_count; ++k) scene.set(group, k, {k}, poses);
    for (int tick = 0; tick < 8; ++tick) {
      scene.move(0.001, tick < 6 ? 0.002 : 0.2);
      poses.begin_tick();
      group.evaluate(scene.world.motion(), poses);
      ASSERT_TRUE(group.fresh());
      for (int k = 0; k < lane_count; ++k) sample.expect_alone(scene, {k}, group, k);
      if (HasFailure()) return;
    }
    mixed += group.same_bodies() ? 0 : 1;
  }
  EXPECT_GT(sample.inside, 1000);
  EXPECT_GT(sample.outside, 500);
  EXPECT_GT(sample.refused, 200);
  EXPECT_GT(sample.pushed, 500);
  EXPECT_GT(mixed, 50);
  EXPECT_LE(sample.disputed, 4);  // decided by rounding
}

void expect_same_bits(const LaneGroup& group, int k, const LaneGroup& alone) {
  ASSERT_EQ(has(group.proven(), k), has(alone.proven(), 0));
  ASSERT_EQ(has(group.in_range(), k), has(alone.in_range(), 0));
  ASSERT_EQ(group.force().at(k), alone.force().at(0));
  ASSERT_EQ(group.torque().at(k), alone.torque().at(0));
  if (!has(group.proven(), k)) return;
  const PairAnswer a = group.answer(k);
  const PairAnswer b = alone.answer(0);
  ASSERT_EQ(a.last.distance, b.last.distance);
  ASSERT_EQ(a.last.lower, b.last.lower);
  ASSERT_EQ(a.last.upper, b.last.upper);
  ASSERT_EQ(a.last.p_WA, b.last.p_WA);
  ASSERT_EQ(a.last.p_WB, b.last.p_WB);
  ASSERT_EQ(a.last.extraction_W, b.last.extraction_W);
  ASSERT_EQ(a.p_AQ_W, b.p_AQ_W);
  ASSERT_EQ(a.p_BA_W, b.p_BA_W);
  ASSERT_EQ(a.turn, b.turn);
  ASSERT_EQ(group.nearest(k), alone.nearest(0));
  ASSERT_EQ(group.peak(k), alone.peak(0));
}

// The force of a pair must not depend on its lane.
TEST(LaneGroup, LaneHasTheSameBitsWhateverTheOthersHold) {
  int proven = 0;
  for (unsigned run = 0; run < 300; ++run) {
    SCOPED_TRACE("seed " + std::to_string(seed + run));
    test::NearPairs scene(3, seed + run);
    // Groups of boxes and other shapes, of face and corner features, of fixed and moving bodies.
    for (int k = 0; k < lane_count; ++k) {
      if (k == 0) scene.add(scene.bodies[1], World::fixed, test::random_box);
      if (k > 0) scene.add();
    }
    PartPoses poses(scene.world);
    LaneGroup group;
    std::array<LaneGroup, lane_count> alone;
    for (int k = 0; k < lane_count; ++k) {
      scene.set(group, k, {k}, poses);
      for (int i = 0; i < lane_count; ++i) {
        scene.set(alone[static_cast<std::size_t>(k)], i, {k}, poses, i == 0);
      }
    }
    for (int tick = 0; tick < 8; ++tick) {
      scene.move(0.001, 0.01);
      poses.begin_tick();
      group.evaluate(scene.world.motion(), poses);
      for (int k = 0; k < lane_count; ++k) {
        LaneGroup& one = alone[static_cast<std::size_t>(k)];
        one.evaluate(scene.world.motion(), poses);
        expect_same_bits(group, k, one);
        if (HasFailure()) return;
        proven += has(group.proven(), k) ? 1 : 0;
      }
    }
  }
  EXPECT_GT(proven, 1000);
}

/// Two cubes, 5 mm apart along z: the upper one can move.
struct Cubes {
  test::NearPairs scene{1, seed};
  BodyId upper = scene.bodies[1];
  PartPoses poses = build();
  LaneGroup group;

  PartPoses build() {
    const Shape cube = Shape::box({0.1, 0.1, 0.1});
    scene.world.place(upper, at(0.205), {});
    const PartId a = scene.world.add_part(upper, "upper", cube);
    const PartId b = scene.world.add_part(World::fixed, "lower", cube);
    scene.world.add_pair(a, b, {.range = 0.02, .surface_force = 100.0, .damping = 0.0});
    scene.warm.emplace_back();
    find_feature();
    return PartPoses(scene.world);
  }
  /// Rotated slightly, so that one corner is nearest.
  static Pose at(double z) {
    Pose X = Pose::Identity();
    X.linear() = Eigen::AngleAxisd(0.01, Vec3(1.0, 0.5, 0.0).normalized()).toRotationMatrix();
    X.translation().z() = z;
    return X;
  }
  /// The present feature.
  void find_feature() {
    const Pair& pair = scene.world.pair({0});
    (void)separation(scene.world.part(pair.a).shape, test::pose_of(scene.world, pair.a),
                     scene.world.part(pair.b).shape, test::pose_of(scene.world, pair.b), {},
                     scene.warm[0] = {});
  }
  void place(const Pose& X) {
    ++scene.world.motion().tick;
    scene.world.place(upper, X, {});
    poses.begin_tick();
    group.evaluate(scene.world.motion(), poses);
  }
  void set_all(bool used) {
    for (int k = 0; k < lane_count; ++k) scene.set(group, k, {0}, poses, used);
  }
  [[nodiscard]] GroupExtremes extremes() const {
    GroupExtremes extremes;
    extremes.add(group);
    return extremes;
  }
};

constexpr unsigned all_lanes = (1U << lane_count) - 1U;

TEST(LaneGroup, PairOutOfRangeIsProvenAndDoesNotPush) {
  Cubes cubes;
  cubes.set_all(true);
  cubes.place(Cubes::at(0.206));
  EXPECT_EQ(cubes.group.in_range(), all_lanes);
  const double peak = cubes.extremes().peak_force();
  const double nearest = cubes.extremes().nearest();
  EXPECT_GT(peak, 1.0);
  cubes.place(Cubes::at(0.3));
  EXPECT_EQ(cubes.group.proven(), all_lanes);
  EXPECT_EQ(cubes.group.in_range(), 0U);
  EXPECT_EQ(cubes.extremes().peak_force(), 0.0);
  EXPECT_NEAR(cubes.extremes().nearest(), nearest + 0.094, 1e-12);
  EXPECT_EQ(cubes.group.nearest(0), nearest);
  EXPECT_EQ(cubes.group.peak(0), peak);
}

TEST(LaneGroup, FeatureThatNoLongerHoldsIsNotProvenUntilItIsRenewed) {
  Cubes cubes;
  cubes.set_all(true);
  Pose X = Cubes::at(0.206);
  X.linear() = X.linear().transpose().eval();  // it tilts to the other side
  cubes.place(X);
  EXPECT_EQ(cubes.group.used(), all_lanes);
  EXPECT_EQ(cubes.group.proven(), 0U);
  EXPECT_EQ(cubes.extremes().peak_force(), 0.0);
  EXPECT_EQ(cubes.extremes().nearest(), std::numeric_limits<double>::infinity());
  cubes.find_feature();
  const World& world = cubes.scene.world;
  cubes.group.set_feature(world, 0, world.pair({0}), {.warm = cubes.scene.warm[0]});
  cubes.place(X);
  EXPECT_EQ(cubes.group.proven(), 1U);
  EXPECT_GT(cubes.group.force().at(0).z(), 1.0);
}

TEST(LaneGroup, LaneWithoutAPairNeverPushes) {
  Cubes cubes;
  cubes.set_all(false);
  cubes.place(Cubes::at(0.206));
  EXPECT_EQ(cubes.group.used(), 0U);
  EXPECT_EQ(cubes.group.proven(), 0U);
  EXPECT_EQ(cubes.extremes().peak_force(), 0.0);
  cubes.set_all(true);
  cubes.group.remove(1);
  cubes.place(Cubes::at(0.206));
  EXPECT_EQ(cubes.group.proven(), all_lanes & ~2U);
  EXPECT_GT(cubes.group.force().at(0).norm(), 1.0);
  EXPECT_EQ(cubes.group.force().at(1), Vec3::Zero());
  EXPECT_EQ(cubes.group.torque().at(1), Vec3::Zero());
  EXPECT_EQ(cubes.group.peak(1), 0.0);
}

TEST(LaneGroup, EvaluationEndsWhatWasStale) {
  Cubes cubes;
  cubes.set_all(true);
  cubes.place(Cubes::at(0.206));
  cubes.group.begin_tick();
  EXPECT_FALSE(cubes.group.fresh());
  cubes.group.set_stale(1);
  EXPECT_EQ(cubes.group.stale(), 2U);
  cubes.group.discard_answer(1);
  EXPECT_EQ(cubes.group.proven(), all_lanes & ~2U);
  cubes.place(Cubes::at(0.205));
  EXPECT_TRUE(cubes.group.fresh());
  EXPECT_EQ(cubes.group.stale(), 0U);
  EXPECT_EQ(cubes.group.proven(), all_lanes);
}

}  // namespace lane_group_test
}  // namespace repel::detail
